"""How large each effect of the catalogue is when it is hidden, and in which parameters.

Strength 1 is a size that a laboratory would meet and that matters there: in 2 s windows the nominal
model then errs two to ten times as much as a perfect one. (Exceptions are the deadband, 1.5 times,
and a tilted world, 1.1 times, whose sizes are the largest that anyone would overlook.) Mostly that
is one to a few of a parameter's own `scale`. Weaker strengths multiply `sizes`, never `fixed`.
"""

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

import numpy as np

from rovsim.core.rounding import rounded
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry, Value
from rovsim.dynamics.effects.base import Effect, Parameter
from rovsim.simulation.synthetic_tank.settings import SUITABLE_TANKS

Range = tuple[float, float]


@dataclass(frozen=True)
class Recipe:
    """How one effect is hidden.

    Attributes:
        choices: groups of parameters, one of which is drawn and changed.
        sizes: least and largest change at strength 1, in scales of each parameter.
        sign: of the change; 0: either.
        fixed: least and largest values of other parameters, which do not depend on strength.
        tank: settings that the effect needs to show.
        weak: whether a smaller effect is harder to see.
    """

    choices: tuple[tuple[str, ...], ...]
    sizes: Range
    sign: int = 0
    fixed: Mapping[str, Range] = field(default_factory=dict)
    tank: Mapping[str, Any] = field(default_factory=dict)
    weak: bool = True


TRANSLATION_AXES, HORIZONTAL_AXES = ("surge", "sway", "heave"), ("surge", "sway")
USUAL_SIZES = (1.0, 2.5)  # scales of a parameter
PLACE_RANGES: Mapping[str, Range] = {"x": (-0.2, 0.2), "y": (-0.2, 0.2), "z": (-0.15, 0.15)}
NARROW_TANK = {"tank": {"x": (0.0, 4.2), "y": (0.0, 3.2), "z": (0.0, 3.0)}}  # a walled test basin
SHALLOW_TANK = {"tank": {"x": (0.0, 10.0), "y": (0.0, 5.0), "z": (0.0, 2.0)}}


def _each(*names: str) -> tuple[tuple[str, ...], ...]:
    return tuple((name,) for name in names)


OWN_RECIPES: Mapping[str, Recipe] = {
    "net_buoyancy": Recipe(_each("force"), (0.75, 1.5)),
    "buoyancy_center": Recipe(_each("x", "y", "z"), (0.6, 1.8)),
    "payload": Recipe(_each("mass"), (0.6, 1.6), 1, PLACE_RANGES),
    "constant_wrench": Recipe(
        (*_each(*TRANSLATION_AXES, "pitch", "yaw"), HORIZONTAL_AXES), (0.6, 1.5)
    ),
    "linear_damping": Recipe((*_each(*TRANSLATION_AXES, "yaw"), HORIZONTAL_AXES), (0.8, 2.0), 1),
    "quadratic_damping": Recipe((*_each(*TRANSLATION_AXES), HORIZONTAL_AXES), (1.5, 3.0), 1),
    "cubic_damping": Recipe((*_each(*TRANSLATION_AXES), HORIZONTAL_AXES), (6.0, 12.0), 1),
    "dry_friction": Recipe((*_each(*TRANSLATION_AXES, "yaw"), HORIZONTAL_AXES), (2.0, 4.0), 1),
    "coupled_damping": Recipe(
        _each("yaw_from_sway", "pitch_from_surge", "roll_from_sway", "sway_from_yaw_quadratic")
        + _each("pitch_from_heave", "yaw_from_sway_quadratic", "pitch_from_surge_quadratic"),
        (2.0, 5.0),
    ),
    "added_mass": Recipe((*_each(*TRANSLATION_AXES, "yaw"), HORIZONTAL_AXES), (0.8, 2.0), 1),
    "added_mass_coupling": Recipe(_each("surge_pitch", "sway_roll", "sway_yaw"), (2.0, 4.0)),
    "lift": Recipe(_each("coefficient"), (1.5, 3.0), 1),
    "fluid_memory": Recipe(_each("coefficient"), (2.0, 5.0), 1, {"time_constant": (0.3, 1.5)}),
    "current": Recipe((("north", "east"), *_each("north", "east")), (0.7, 1.5)),
    "current_drift": Recipe(_each("rate"), (1.0, 2.5), 1),
    "tether_tension": Recipe(
        _each("stiffness"),
        (0.8, 1.5),
        1,
        {"slack_length": (0.3, 1.0), "anchor_x": (3, 7), "anchor_y": (1, 4), "anchor_z": (3, 3)},
    ),
    "tether_drag": Recipe(_each("coefficient"), (5.0, 10.0), 1),
    "wall_proximity": Recipe(_each("gain"), (3.0, 6.0), 1, tank=NARROW_TANK),
    "surface_proximity": Recipe(_each("gain"), (3.0, 6.0), 1, tank=SHALLOW_TANK),
    "thruster_lag": Recipe(_each("time_constant"), (1.0, 2.5), 1),
    "input_delay": Recipe(_each("delay"), (1.5, 4.0), 1),
    "clock_drift": Recipe(_each("rate"), (1.0, 3.0)),
    "thruster_deadband": Recipe(_each("width"), (1.5, 3.0), 1),  # ESCs stop at 0.06
    "force_curve": Recipe(_each("exponent"), (1.5, 3.0)),
    "thruster_gain": Recipe(_each("all", *(f"t{i}" for i in range(1, 9))), (1.5, 4.0), -1),
    "thrust_asymmetry": Recipe(_each("ratio"), (1.5, 3.0), -1),  # T200: 4.1 against 5.2 kgf
    "voltage_sag": Recipe(_each("fraction"), (1.5, 3.0), 1),
    "advance_loss": Recipe(_each("coefficient"), (1.5, 4.0), 1),
    "propeller_torque": Recipe(_each("ratio"), (1.0, 3.0)),
    "thruster_order": Recipe((("first", "second"),), (1.0, 1.0), weak=False),  # drawn by `_swapped`
    "pilot_gain": Recipe(
        _each("surge", "sway", "heave", "yaw"), (2.0, 5.0), tank=SUITABLE_TANKS["demands"]
    ),
    "fin_effectiveness": Recipe(_each("all"), (2.0, 5.0), -1, tank=SUITABLE_TANKS["surfaces"]),
    "waterplane_stiffness": Recipe(_each("roll"), (40.0, 80.0), tank=SUITABLE_TANKS["waterplane"]),
    "onboard_control": Recipe(
        (("bandwidth_yaw",), ("bandwidth_roll", "bandwidth_pitch", "bandwidth_yaw")),
        (1.5, 3.0),
        1,
        {"gain_yaw": (1.0, 1.8), "gain_roll": (0.5, 0.8), "gain_pitch": (0.5, 0.8)},
        SUITABLE_TANKS["demands"],
        weak=False,
    ),
    "pose_filter": Recipe(_each("cutoff"), (994.0, 997.0), -1),  # from 1000 Hz down to 3 to 6 Hz
    "marker_offset": Recipe(_each("x", "y", "z"), (1.0, 3.0)),
    "marker_misalignment": Recipe(_each("roll", "pitch", "yaw"), (1.5, 4.0)),
    "world_tilt": Recipe(_each("roll", "pitch"), (2.0, 4.0)),
}


def usual_recipe(effect: type[Effect]) -> Recipe:
    """How an effect is hidden that has no recipe of its own: a change in one of its parameters."""
    free = [p for p in effect.parameters if p.fitted and not p.discrete]
    grows = all(p.low >= p.neutral_value for p in free)
    shrinks = all(p.high <= p.neutral_value for p in free)
    tank = SUITABLE_TANKS.get(effect.requires, {})
    return Recipe(_each(*(p.name for p in free)), USUAL_SIZES, grows - shrinks, tank=tank)


NEW_EFFECTS = {name: cls for name, cls in built_in().items() if name not in OWN_RECIPES}
RECIPES = {**OWN_RECIPES, **{name: usual_recipe(cls) for name, cls in NEW_EFFECTS.items()}}


def drawn(name: str, strength: float, random: np.random.Generator) -> EffectEntry:
    """Draw an effect of the catalogue by its recipe.

    The random numbers are the same at every strength; only the size of the change differs.

    Args:
        name: id of the effect.
        strength: factor of the size.
        random: from which values are drawn.
    """
    if name == "thruster_order":
        return _swapped(random)
    return draw_by(RECIPES[name], built_in()[name], strength, random)


def draw_by(
    recipe: Recipe, effect: type[Effect], strength: float, random: np.random.Generator
) -> EffectEntry:
    """Draw an effect by a recipe, see `drawn`."""
    declared = {p.name: p for p in effect.parameters}
    group = recipe.choices[random.integers(len(recipe.choices))]
    values = {k: rounded(random.uniform(*r), 4) for k, r in recipe.fixed.items()}
    sign = recipe.sign or random.choice([-1, 1])
    for k in group:
        change = sign * float(random.uniform(*recipe.sizes))
        values[k] = _moved(declared[k], change, strength if recipe.weak else 1.0)
    values = {k: v for k, v in values.items() if _used(effect.id, k, group)}
    return EffectEntry(effect=effect.id, parameters={k: Value(value=v) for k, v in values.items()})


def draw_apart(
    families: Sequence[frozenset[str]], count: int, random: np.random.Generator
) -> list[str]:
    """Draw `count` effects, each of another family."""
    indices = random.choice(len(families), size=count, replace=False)
    return [str(random.choice(sorted(families[i]))) for i in indices]


def _swapped(random: np.random.Generator) -> EffectEntry:
    """Draw two swapped upright thrusters of the default vehicle, which a pilot can still hold."""
    first, second = sorted(random.choice([5.0, 6.0, 7.0, 8.0], size=2, replace=False).tolist())
    values = {"first": first, "second": second}
    return EffectEntry(
        effect="thruster_order", parameters={k: Value(value=v) for k, v in values.items()}
    )


def _moved(p: Parameter, scales: float, strength: float) -> float:
    """Change a parameter by a number of its scales, times the strength, within its range."""
    moved = p.combine(p.neutral_value, p.neutral_value + scales * p.scale, strength)
    return rounded(moved, 4)


def _used(name: str, parameter: str, chosen: tuple[str, ...]) -> bool:
    """Whether a parameter has a meaning: the gain of a loop has none on an axis without a loop."""
    if name != "onboard_control" or not parameter.startswith("gain_"):
        return True
    return parameter.replace("gain_", "bandwidth_") in chosen
