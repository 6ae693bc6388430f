"""What models are called, in files, tables and keys; those of users are called by their files."""

NOMINAL, ZERO_ACCELERATION = "nominal", "zero_acceleration"
BUILT_IN = (NOMINAL, ZERO_ACCELERATION)  # those that need no file
REFITTED = "refitted"  # the nominal one, its own parameters fitted to the train runs
EFFECTS = "effects"  # the nominal one, and all that a diagnosis selected
PROPOSED = "proposed_effect"  # the effect that a diagnosis proposes
NOISE_FLOOR = "noise_floor"  # what a perfect model would show


def name_learned(kind: str, control: str, base: str = NOMINAL) -> str:
    """A model with a residual of a kind, learned from runs of a control: [BASE+]KIND_CONTROL."""
    learned = f"{kind}_{control}"
    return learned if base == NOMINAL else f"{base}+{learned}"
