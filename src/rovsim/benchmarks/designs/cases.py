"""The cases: which there are, what each hides in the tank, and what it asks."""

from typing import Any

import numpy as np

from rovsim.application.settings import Settings
from rovsim.benchmarks.blind.case import Range, merged, random_of, seed_of
from rovsim.benchmarks.blind.recipes import RECIPES, drawn
from rovsim.core.rounding import rounded
from rovsim.design.settings import Question
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry, Value
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings

# The run before: too short, too rough and too little hidden to be sure of much. Frames get lost,
# and a design needs 10 s of it.
FLIGHT_SECONDS, HIDDEN_STRENGTH = 20.0, 0.4  # s, of the usual sizes
ROUGH_TANK = {"turbulence": {"force": 1.0, "moment": 0.04}}
EFFECT_PAIRS = (  # the first is hidden
    ("linear_damping", "quadratic_damping"), ("quadratic_damping", "linear_damping"),
    ("quadratic_damping", "cubic_damping"), ("cubic_damping", "quadratic_damping"),
    ("dry_friction", "linear_damping"), ("fluid_memory", "linear_damping"),
    ("lift", "coupled_damping"), ("thruster_lag", "input_delay"), ("input_delay", "thruster_lag"),
    ("thruster_lag", "added_mass"), ("added_mass", "thruster_gain"),
    ("thruster_gain", "quadratic_damping"), ("thruster_gain", "force_curve"),
    ("force_curve", "thruster_deadband"), ("thruster_deadband", "thruster_gain"),
    ("thrust_asymmetry", "thruster_gain"), ("advance_loss", "quadratic_damping"),
    ("net_buoyancy", "constant_wrench"), ("constant_wrench", "current"),
    ("buoyancy_center", "marker_misalignment"),
)  # fmt: skip
HIDDEN_PARAMETERS = (  # `effect.parameter`, which is hidden
    "linear_damping.surge", "linear_damping.yaw", "quadratic_damping.surge",
    "quadratic_damping.sway", "quadratic_damping.heave", "added_mass.surge", "added_mass.sway",
    "added_mass.yaw", "thruster_gain.all", "thruster_lag.time_constant", "input_delay.delay",
    "thrust_asymmetry.ratio", "force_curve.exponent", "advance_loss.coefficient",
    "propeller_torque.ratio", "buoyancy_center.z", "net_buoyancy.force",
    "coupled_damping.yaw_from_sway", "dry_friction.sway", "marker_offset.x",
)  # fmt: skip


def list_cases() -> list[str]:
    """All 40, pairs and values in turns, so that a part of them is a fair part."""
    pairs = [f"{a}+{b}" for a, b in EFFECT_PAIRS]
    return [case for pair in zip(pairs, HIDDEN_PARAMETERS, strict=True) for case in pair]


def hide(case: str, seeds: Range) -> TankSettings:
    """A tank with the effect of a case, of a size that its recipe draws."""
    name, _, parameter = case.partition("+")[0].partition(".")
    random = random_of(case, seeds)
    entry = drawn(
        name, HIDDEN_STRENGTH, random
    )  # of a value too: the size below is drawn after this
    if parameter:
        entry = _sized(name, parameter, random)
    case_tank: dict[str, Any] = {
        "name": "design",
        "seed": seed_of(case, seeds),
        "duration": FLIGHT_SECONDS,
        "effects": (entry,),
        "runs": (TankRun(id="a", control="6dof", split="train"),),
    }
    return TankSettings(**merged(ROUGH_TANK, RECIPES[name].tank, case_tank))


def _sized(name: str, parameter: str, random: np.random.Generator) -> EffectEntry:
    """An effect with one parameter, changed by a size that its recipe draws."""
    declared = next(p for p in built_in()[name].parameters if p.name == parameter)
    recipe = RECIPES[name]
    change = (recipe.sign or 1) * HIDDEN_STRENGTH * random.uniform(*recipe.sizes) * declared.scale
    neutral = declared.neutral_value
    value = Value(value=rounded(declared.combine(neutral, neutral + change), 4))
    return EffectEntry(effect=name, parameters={parameter: value})


def ask(case: str, settings: Settings) -> Question:
    """The question of a case."""
    between = tuple(case.split("+")) if "+" in case else ()
    return Question(
        seed=0,
        between=between,
        know=() if between else (case,),
        design=settings.design,
        signals=settings.signals,
        replay=settings.replay,
    )
