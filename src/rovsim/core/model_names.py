"""Names of models in files, tables and keys; a user's model is named after its file."""

NOMINAL, ZERO_ACCELERATION = "nominal", "zero_acceleration"
BUILT_IN = (NOMINAL, ZERO_ACCELERATION)  # those that need no file
REFITTED = "refitted"  # the nominal model with its own parameters fitted to the train runs
EFFECTS = "effects"  # the nominal model with all effects that a diagnosis selected
PROPOSED = "proposed_effect"  # the effect that a diagnosis proposes
NOISE_FLOOR = "noise_floor"  # the error that a perfect model would show


def name_learned(kind: str, control: str, base: str = NOMINAL) -> str:
    """Name a model with a learned residual: [BASE+]KIND_CONTROL.

    Args:
        kind: of the residual.
        control: of the runs that it was learned from (3dof, 6dof).
        base: name of the model to which it is added.
    """
    learned = f"{kind}_{control}"
    return learned if base == NOMINAL else f"{base}+{learned}"
