"""The suites: which cases there are, as data. No case depends on the other cases of its suite.

single     every effect at its standard strength
weak       the same at 0.5, 0.25 and 0.1 of it: where does it vanish?
strong     the same at 2 and 4 times: is it still named where first order does not reach?
noisy      camera noise three times as large
short      runs of 30 and 20 s
pair, triple   effects of different families, none of which imitates another by construction
many       four to eight of them
workshop   a vehicle file that is wrong everywhere, and up to two special effects (field.py)
camera     cameras with coloured noise or with smoothing software (field.py)
laboratory  a wrong file, such a camera, and three or five special effects (field.py)
deviation  every coefficient of damping and added mass 2 or 5 % off
none       nothing hidden
outside    physics that no effect of the catalogue describes, alone, beside an effect or with a
           vehicle file that is wrong everywhere
law        a smooth law outside the catalogue, for which an equation should be found
"""

from typing import Any, Iterator, Mapping, Sequence

import numpy as np

from rovsim.benchmarks.blind.case import Case, Range, Unlisted, merged, random_of, seed_of
from rovsim.benchmarks.blind.field import (
    CAMERAS,
    COEFFICIENTS,
    NOMINAL_EFFECTS,
    camera,
    laboratory,
    workshops,
    wrong_file,
)
from rovsim.benchmarks.blind.known_laws import LAWS, drawn_law
from rovsim.benchmarks.blind.outside import OUTSIDE_EFFECTS, drawn_outside
from rovsim.benchmarks.blind.recipes import RECIPES, draw_apart, drawn
from rovsim.benchmarks.blind.recordings import recordings
from rovsim.core.axes import AXES
from rovsim.core.rounding import rounded
from rovsim.dynamics.effect_entry import EffectEntry, Value
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle
from rovsim.simulation.synthetic_tank.settings import Camera

USUAL_CAMERA = Camera()
NOISY_TANK: Mapping[str, Any] = {
    "camera": {
        "position_noise": 3 * USUAL_CAMERA.position_noise,
        "attitude_noise": 3 * USUAL_CAMERA.attitude_noise,
    }
}
WEAK_STRENGTHS = (0.5, 0.25, 0.1)
STRONG_STRENGTHS = (2.0, 4.0)
SHORT_FLIGHTS_S = (30.0, 20.0)
COMBINATION_SIZES = (4, 5, 6, 7, 8)  # effects hidden at once
DEVIATION_SHARES = (0.02, 0.05)  # of each coefficient

# Effects of one family push much alike, so that two of them together have no single right answer.
# An effect that is not listed here is a family by itself, if it needs no other tank.
ALIKE: tuple[frozenset[str], ...] = (
    frozenset({"net_buoyancy", "payload", "constant_wrench", "buoyancy_center", "tether_tension",
               "world_tilt", "current", "current_drift"}),
    frozenset({"linear_damping", "quadratic_damping", "cubic_damping", "dry_friction", "lift",
               "fluid_memory", "tether_drag", "wall_proximity", "surface_proximity"}),
    frozenset({"coupled_damping"}),
    frozenset({"added_mass"}),
    frozenset({"added_mass_coupling", "marker_offset", "marker_misalignment"}),
    frozenset({"thruster_lag", "input_delay", "clock_drift", "pose_filter"}),
    frozenset({"thruster_deadband", "force_curve", "thruster_gain", "thrust_asymmetry",
               "voltage_sag", "advance_loss"}),
    frozenset({"propeller_torque"}),
    frozenset({"onboard_control"}),
)  # fmt: skip
# Never combined: they need another vehicle or log, or they hide what else is wrong.
NO_FAMILY = frozenset({"fin_effectiveness", "waterplane_stiffness", "pilot_gain", "thruster_order"})
FAMILIES = (
    *ALIKE,
    *(
        frozenset({name})
        for name in RECIPES
        if name not in frozenset.union(NO_FAMILY, *ALIKE) and not RECIPES[name].tank
    ),
)


def suite(name: str, seeds: Range) -> list[Case]:
    """List all cases of a suite."""
    return list(SUITES[name](seeds))


def quick(seeds: Range) -> Iterator[Case]:
    """Yield 49 cases: every effect once, and a few of the other kinds."""
    for name in RECIPES:
        yield hiding("single", (name,), 0, seeds)
    yield from (nothing(k, seeds) for k in range(3))
    yield from (outside(name, 0, seeds) for name in list(OUTSIDE_EFFECTS)[::3])
    yield from (combination(2, k, seeds) for k in range(2))
    yield combination(3, 0, seeds)
    yield deviation(0, seeds)


def standard(seeds: Range) -> Iterator[Case]:
    """Yield `quick`, and enough cases of the common kinds for rates to mean something."""
    yield from quick(seeds)
    for name in RECIPES:
        yield hiding("single", (name,), 1, seeds)
    yield from (combination(2, k, seeds) for k in range(2, 20))
    yield from (combination(3, k, seeds) for k in range(1, 10))
    yield from (nothing(k, seeds) for k in range(3, 24))
    yield from (outside(n, 0, seeds) for k, n in enumerate(OUTSIDE_EFFECTS) if k % 3)
    for name, recipe in RECIPES.items():
        if recipe.weak:
            yield hiding("weak", (name,), 0, seeds, 0.25)
    yield from workshops(0, seeds)
    yield from (combination(count, 0, seeds) for count in COMBINATION_SIZES)
    yield from (camera(kind, k, seeds) for kind in CAMERAS for k in range(4))


def full(seeds: Range) -> Iterator[Case]:
    """Yield all kinds except laboratories, laws, recordings and strong effects.

    The cases of `quick` and `standard` are among them.
    """
    for name, recipe in RECIPES.items():
        yield from (hiding("single", (name,), k, seeds) for k in range(6))
        if recipe.weak:
            for strength in WEAK_STRENGTHS:
                yield from (hiding("weak", (name,), k, seeds, strength) for k in range(4))
        yield hiding("noisy", (name,), 0, seeds, tank=NOISY_TANK)
        for seconds in SHORT_FLIGHTS_S:
            yield hiding(f"short {seconds:g} s", (name,), 0, seeds, tank={"duration": seconds})
    yield from (combination(2, k, seeds) for k in range(40))
    yield from (combination(3, k, seeds) for k in range(20))
    yield from (deviation(k, seeds) for k in range(20))
    yield from (nothing(k, seeds) for k in range(24))
    yield from (nothing(k, seeds, "none, noisy", NOISY_TANK) for k in range(6))
    for seconds in SHORT_FLIGHTS_S:
        yield from (
            nothing(k, seeds, f"none, {seconds:g} s", {"duration": seconds}) for k in range(5)
        )
    yield from (case for k in range(2) for case in workshops(k, seeds))
    yield from (combination(count, k, seeds) for count in COMBINATION_SIZES for k in range(4))
    yield from (camera(kind, k, seeds) for kind in CAMERAS for k in range(10))
    for name in OUTSIDE_EFFECTS:
        yield from (outside(name, k, seeds) for k in range(4))
        yield outside(name, 0, seeds, beside=True)


def hiding(
    kind: str,
    names: Sequence[str],
    k: int,
    seeds: Range,
    strength: float = 1.0,
    tank: Mapping[str, Any] | None = None,
) -> Case:
    """Make a case that hides these effects of the catalogue.

    The k-th case of an effect draws the same at every strength, so that only the strength differs.

    Args:
        kind: row of the table, without the strength.
        names: ids of the effects.
        k: number of the case.
        seeds: range that the seed is from.
        strength: factor of the sizes.
        tank: further settings of the tank.
    """
    label = kind if strength == 1.0 else f"{kind} {strength:g}"
    case_id = f"{label}/{'+'.join(names)}/{k}"
    random = random_of(f"{'+'.join(names)}/{k}", seeds)
    hidden = tuple(drawn(name, strength, random) for name in names)
    tanks = [RECIPES[name].tank for name in names]
    return Case(
        id=case_id,
        kind=label,
        seed=seed_of(case_id, seeds),
        hidden=hidden,
        strength=strength,
        tank=merged(*tanks, tank or {}),
    )


def combination(count: int, k: int, seeds: Range) -> Case:
    """Make a case that hides `count` effects of different families."""
    random = random_of(f"combination/{count}/{k}", seeds)
    names = draw_apart(FAMILIES, count, random)
    return hiding({2: "pair", 3: "triple"}.get(count, "many"), names, k, seeds)


def nothing(
    k: int, seeds: Range, kind: str = "none", tank: Mapping[str, Any] | None = None
) -> Case:
    """Make a case in which the nominal model is right."""
    case_id = f"{kind}/{k}"
    return Case(id=case_id, kind=kind, seed=seed_of(case_id, seeds), tank=dict(tank or {}))


def deviation(k: int, seeds: Range) -> Case:
    """Make a case in which every coefficient of the vehicle is a few per cent off.

    Damping and added mass are changes from the nominal model, so naming them is right where it can
    be seen, and `adequate` where it cannot. A mass that is off enters as the same added mass on all
    three translations. Only another name, or `unexplained`, is wrong.
    """
    case_id = f"deviation/{k}"
    random = random_of(case_id, seeds)
    share = DEVIATION_SHARES[k % len(DEVIATION_SHARES)]
    water = load_vehicle(default_vehicle()).hydrodynamics
    hidden = [_deviate(name, getattr(water, name), share, random) for name in COEFFICIENTS]
    return Case(
        id=case_id,
        kind="deviation",
        seed=seed_of(case_id, seeds),
        hidden=tuple(hidden),
        forgiven=COEFFICIENTS,
        strength=share,
    )


def _deviate(
    name: str, nominal: Sequence[float], share: float, random: np.random.Generator
) -> EffectEntry:
    changes = share * np.array(nominal) * random.choice([-1.0, 1.0], size=len(AXES))
    values = {a: Value(value=rounded(c, 4)) for a, c in zip(AXES, changes, strict=True) if c}
    return EffectEntry(effect=name, parameters=values)


def outside(name: str, k: int, seeds: Range, beside: bool = False) -> Case:
    """Make a case with physics outside the catalogue, alone or beside one of its effects."""
    kind = "outside, beside an effect" if beside else "outside"
    case_id = f"{kind}/{name}/{k}"
    random = random_of(case_id, seeds)
    unlisted = drawn_outside(name, 1.0, random)
    effect = str(random.choice(["quadratic_damping", "net_buoyancy", "thruster_lag"]))
    hidden = (drawn(effect, 1.0, random),) if beside else ()
    return Case(
        id=case_id,
        kind=kind,
        seed=seed_of(case_id, seeds),
        hidden=hidden,
        outside=(Unlisted(name=name, parameters=unlisted.given()),),
    )


def outside_wrong_file(name: str, seeds: Range) -> Case:
    """Make a case with a wrong vehicle file, and physics outside the catalogue or a law."""
    kind = "outside, wrong file"
    case_id = f"{kind}/{name}"
    random = random_of(case_id, seeds)
    draw = drawn_law(name, random) if name in LAWS else drawn_outside(name, 1.0, random)
    return Case(
        id=case_id,
        kind=kind,
        seed=seed_of(case_id, seeds),
        hidden=tuple(wrong_file(random)),
        outside=(Unlisted(name=name, parameters=draw.given()),),
        forgiven=NOMINAL_EFFECTS,
    )


LAWLESS_EFFECTS = ("tone", "kicks", "square_wave", "shedding", "ingress", "loose_ballast")
CASES_PER_LAW = 3


def equations(seeds: Range) -> Iterator[Case]:
    """Yield laws outside the catalogue, physics that follows no law of the state, and nothing."""
    for k in range(CASES_PER_LAW):
        yield from (law(name, k, seeds) for name in LAWS)
    yield from (outside(name, 0, seeds) for name in LAWLESS_EFFECTS)
    yield from (nothing(k, seeds) for k in range(4))


def laboratories(seeds: Range) -> Iterator[Case]:
    """Yield cases in which everything is a little wrong, and several effects or a law missing."""
    yield from (laboratory(FAMILIES, k, seeds) for k in range(12))
    yield from (outside_wrong_file(name, seeds) for name in {**OUTSIDE_EFFECTS, **LAWS})


def strong(seeds: Range) -> Iterator[Case]:
    """Yield every effect at several times the strength that a laboratory would usually meet."""
    for name, recipe in RECIPES.items():
        if recipe.weak:
            yield from (
                hiding("strong", (name,), 0, seeds, strength) for strength in STRONG_STRENGTHS
            )


def law(name: str, k: int, seeds: Range) -> Case:
    """Make a case with a smooth law outside the catalogue."""
    case_id = f"law/{name}/{k}"
    effect = drawn_law(name, random_of(case_id, seeds))
    return Case(
        id=case_id,
        kind="law",
        seed=seed_of(case_id, seeds),
        outside=(Unlisted(name=name, parameters=effect.given()),),
    )


SUITES = {
    "quick": quick,
    "standard": standard,
    "full": full,
    "recordings": recordings,
    "equations": equations,
    "laboratory": laboratories,
    "strong": strong,
}
