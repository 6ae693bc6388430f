"""Cases as in a laboratory: a vehicle file that is wrong everywhere, and imperfect cameras.

workshop     every coefficient of the vehicle file off, and up to two special effects
camera       a right model, seen by cameras with coloured noise or with smoothing software
laboratory   all of that at once, with three or five special effects

The errors of the vehicle file are assumed: coefficients of drag and added mass are off by up to a
quarter, the gain of the thrusters by a twentieth, the net buoyancy by 1 N, and the height of the
centre of buoyancy by 4 mm.
"""

from typing import Any, Iterator, Mapping, Sequence

import numpy as np

from rovsim.benchmarks.blind.case import Case, Range, merged, random_of, seed_of
from rovsim.benchmarks.blind.recipes import RECIPES, draw_apart, drawn
from rovsim.core.axes import AXES
from rovsim.core.rounding import rounded
from rovsim.dynamics.effect_entry import EffectEntry, Value
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle

COEFFICIENTS = ("linear_damping", "quadratic_damping", "added_mass")
MAX_COEFFICIENT_ERROR = 0.25  # share of each coefficient
MAX_GAIN_ERROR, MAX_BUOYANCY_ERROR_N, MAX_CENTER_ERROR_M = 0.05, 1.0, 0.004
NOMINAL_EFFECTS = (*COEFFICIENTS, "thruster_gain", "net_buoyancy", "buoyancy_center")
# Effects that a wrong vehicle file does not explain, and a pilot can hold.
SPECIAL_EFFECTS = (
    "current", "tether_tension", "tether_drag", "thruster_lag", "input_delay", "clock_drift",
    "thruster_deadband", "thrust_asymmetry", "voltage_sag", "marker_offset",
    "marker_misalignment", "constant_wrench", "lift", "fluid_memory", "advance_loss",
)  # fmt: skip
CAMERAS: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "coloured": {"colour_noise": (2e-4, 3e-4), "colour_attitude": (6e-4, 9e-4)},  # m, rad
    "smoothed": {},
}
CUTOFF_RANGE_HZ = (3.0, 12.0)


def workshop(special: Sequence[str], k: int, seeds: Range) -> Case:
    """Make a case with a wrong vehicle file and some special effects.

    Args:
        special: ids of the special effects.
        k: number of the case among those with the same effects.
        seeds: range that the seed is from.
    """
    kind = f"workshop+{len(special)}"
    case_id = f"{kind}/{'+'.join(special) or 'nothing'}/{k}"
    random = random_of(case_id, seeds)
    hidden = (*wrong_file(random), *(drawn(name, 1.0, random) for name in special))
    return Case(
        id=case_id,
        kind=kind,
        seed=seed_of(case_id, seeds),
        hidden=hidden,
        forgiven=NOMINAL_EFFECTS,
        tank=merged(*(RECIPES[name].tank for name in special)),
    )


def workshops(k: int, seeds: Range) -> Iterator[Case]:
    """Make the k-th set of cases with a wrong vehicle file.

    These are each special effect alone, each with the third after it in the list, and three cases
    without any.
    """
    for i, name in enumerate(SPECIAL_EFFECTS):
        yield workshop((name,), k, seeds)
        yield workshop((name, SPECIAL_EFFECTS[(i + 3) % len(SPECIAL_EFFECTS)]), k, seeds)
    yield from (workshop((), 3 * k + j, seeds) for j in range(3))


def camera(how: str, k: int, seeds: Range) -> Case:
    """Make a case with a right model and imperfect cameras.

    Args:
        how: `coloured` (noise that varies slowly) or `smoothed` (by the camera's software).
        k: number of the case.
        seeds: range that the seed is from.
    """
    case_id = f"camera/{how}/{k}"
    settings, smoothing = _camera(how, random_of(case_id, seeds))
    return Case(
        id=case_id, kind="camera", seed=seed_of(case_id, seeds), hidden=smoothing, tank=settings
    )


def laboratory(families: Sequence[frozenset[str]], k: int, seeds: Range) -> Case:
    """Make a case with a wrong file, imperfect cameras, and special effects of different families.

    Args:
        families: sets of effects that push alike; at most one effect of each is hidden.
        k: number of the case; kinds of cameras and numbers of effects (three or five) take turns.
        seeds: range that the seed is from.
    """
    kind, count = list(CAMERAS)[k % 2], (3, 5)[k // 2 % 2]
    random = random_of(f"laboratory/{k}", seeds)
    eligible = [members for family in families if (members := family & set(SPECIAL_EFFECTS))]
    special = draw_apart(eligible, count, random)
    case_id = f"laboratory/{kind}/{'+'.join(special)}/{k}"
    settings, smoothing = _camera(kind, random)
    hidden = (*wrong_file(random), *(drawn(name, 1.0, random) for name in special), *smoothing)
    return Case(
        id=case_id,
        kind="laboratory",
        seed=seed_of(case_id, seeds),
        hidden=hidden,
        forgiven=NOMINAL_EFFECTS,
        tank=merged(*(RECIPES[name].tank for name in special), settings),
    )


def _camera(
    how: str, random: np.random.Generator
) -> tuple[dict[str, Any], tuple[EffectEntry, ...]]:
    """Draw settings of the tank for imperfect cameras, and the effect of their software, if any."""
    settings: dict[str, Any] = {name: random.uniform(*size) for name, size in CAMERAS[how].items()}
    cutoff = rounded(random.uniform(*CUTOFF_RANGE_HZ), 3)
    smoothing = EffectEntry(effect="pose_filter", parameters={"cutoff": Value(value=cutoff)})
    return {"camera": settings}, (smoothing,) if how == "smoothed" else ()


def wrong_file(random: np.random.Generator) -> Iterator[EffectEntry]:
    """Draw effects that change every coefficient of the vehicle file by its own share."""
    water = load_vehicle(default_vehicle()).hydrodynamics
    for name in COEFFICIENTS:
        nominal = np.array(getattr(water, name))
        yield _entry(
            name,
            dict(
                zip(
                    AXES,
                    random.uniform(-MAX_COEFFICIENT_ERROR, MAX_COEFFICIENT_ERROR, 6) * nominal,
                    strict=True,
                )
            ),
        )
    yield _entry("thruster_gain", {"all": 1.0 + random.uniform(-MAX_GAIN_ERROR, MAX_GAIN_ERROR)})
    yield _entry(
        "net_buoyancy", {"force": random.uniform(-MAX_BUOYANCY_ERROR_N, MAX_BUOYANCY_ERROR_N)}
    )
    yield _entry("buoyancy_center", {"z": random.uniform(-MAX_CENTER_ERROR_M, MAX_CENTER_ERROR_M)})


def _entry(name: str, values: Mapping[str, float]) -> EffectEntry:
    parameters = {k: Value(value=rounded(v, 4)) for k, v in values.items() if v}
    return EffectEntry(effect=name, parameters=parameters)
