"""Recordings as other laboratories have them, imitated by the tank: other sensors and vehicles.

depth and attitude   a vehicle without motion capture, its pilot's demands on board
gyro                 rates at 200 Hz, attitude and depth of an autopilot, thruster commands
ship                 a model ship in the plane, two thrusters that turn, poses at 20 Hz
decay                let go from an angle and not commanded, filmed
torpedo              fins, acoustic positions, a Doppler log, an inertial unit

The cases of a kind hide in turn each effect that its channels can show, and some that they cannot.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator, Mapping

import numpy as np

from rovsim.benchmarks.blind.case import Case, Range, random_of, seed_of
from rovsim.core.rounding import rounded
from rovsim.dynamics.effect_entry import EffectEntry, Value

Sizes = Mapping[str, tuple[float, float]]  # of parameters, least and most
Hidden = tuple[str, Sizes]
CASES_PER_KIND = 8

SHIP_FILE = str(Path(__file__).parent / "vehicles" / "azimuth_ship.yaml")
# An autopilot's attitude is good to 0.2 degrees, its pressure sensor to a centimetre.
ATTITUDE_SENSOR = {"rate": 10.0, "noise": 0.003}
LAG: Hidden = ("thruster_lag", {"time_constant": (0.1, 0.25)})
DELAY: Hidden = ("input_delay", {"delay": (0.1, 0.25)})
CURRENT: Hidden = ("current", {"north": (0.04, 0.1), "east": (0.04, 0.1)})
BUOYANCY: Hidden = ("net_buoyancy", {"force": (1.5, 3.0)})


@dataclass(frozen=True)
class Kind:
    """A kind of recording.

    Attributes:
        tank: settings of the tank.
        shown: effects that such a recording can show, each with the range of its parameters.
        silent: effects that it cannot show.
    """

    tank: Mapping[str, Any]
    shown: tuple[Hidden, ...]
    silent: tuple[Hidden, ...] = ()


def _runs(control: str = "6dof", **extra: Any) -> list[dict[str, Any]]:
    splits = ("train", "train", "train", "test")
    return [
        {"id": f"run-{k}", "control": control, "split": split, **extra}
        for k, split in enumerate(splits, 1)
    ]


def _releases() -> list[dict[str, Any]]:
    """Make eight runs of a few seconds, each let go from another angle while it moves."""
    angles = ((0.4, 0.0), (-0.4, 0.3), (0.3, -0.3), (-0.3, 0.1), (0.2, 0.4), (0.4, 0.2))
    tests = ((0.35, 0.1), (-0.35, -0.2))
    splits = ["train"] * len(angles) + ["test"] * len(tests)
    runs = []
    for k, (split, (roll, pitch)) in enumerate(zip(splits, (*angles, *tests), strict=True), 1):
        velocity = (roll, pitch, -roll, 0, 0, 2.0 * pitch)
        release = {"pose": (0, 0, 0, roll, pitch, 0), "velocity": velocity}
        runs.append({"id": f"run-{k}", "control": "6dof", "split": split, "release": release})
    return runs


KINDS: Mapping[str, Kind] = {
    "depth and attitude": Kind(
        {
            "runs": _runs("3dof"),
            "log": {"kind": "demand"},
            "sensors": {"depth": {"rate": 3.0, "noise": 0.01}, "attitude": ATTITUDE_SENSOR},
        },
        (
            BUOYANCY,
            ("linear_damping", {"heave": (10.0, 20.0)}),
            DELAY,
            ("buoyancy_center", {"x": (0.003, 0.008)}),
            LAG,
            ("payload", {"mass": (0.3, 0.7)}),
        ),
        (CURRENT,),
    ),
    "gyro": Kind(
        {
            "runs": _runs(),
            "sensors": {
                "rates": {"rate": 200.0, "noise": 0.01},
                "attitude": ATTITUDE_SENSOR,
                "depth": {"rate": 5.0, "noise": 0.01},
            },
        },
        (
            ("linear_damping", {"yaw": (1.0, 3.0)}),
            LAG,
            ("added_mass", {"yaw": (0.1, 0.3)}),
            ("buoyancy_center", {"y": (0.003, 0.008)}),
            DELAY,
            ("propeller_torque", {"ratio": (0.01, 0.03)}),
        ),
        (CURRENT,),
    ),
    "ship": Kind(
        {
            "runs": _runs(),
            "vehicle": SHIP_FILE,
            "duration": 120.0,
            "tank": {"x": (0.0, 40.0), "y": (0.0, 40.0), "z": (0.0, 3.0)},
            "turbulence": {"force": 0.05, "moment": 0.02},
            "sensors": {
                "position": {"rate": 20.0, "noise": 0.002},
                "attitude": {"rate": 20.0, "noise": 0.003},
            },
        },
        (
            ("linear_damping", {"surge": (0.8, 2.0)}),
            ("input_delay", {"delay": (0.2, 0.5)}),
            CURRENT,
            ("constant_wrench", {"sway": (0.2, 0.5)}),
            ("thruster_gain", {"all": (0.7, 0.85)}),
            ("added_mass", {"sway": (3.0, 8.0)}),
        ),
        (BUOYANCY,),
    ),
    "decay": Kind(
        {"runs": _releases(), "duration": 10.0},
        (
            BUOYANCY,
            ("buoyancy_center", {"z": (0.003, 0.008)}),
            ("linear_damping", {"roll": (0.3, 0.8)}),
            ("added_mass", {"roll": (0.1, 0.25)}),
        ),
        (LAG, DELAY),
    ),
    "torpedo": Kind(
        {
            "runs": _runs(),
            "vehicle": "remus100",
            "duration": 90.0,
            "tank": {"x": (0.0, 200.0), "y": (0.0, 200.0), "z": (0.0, 30.0)},
            "sensors": {
                "position": {"rate": 5.0, "noise": 0.3},
                "velocity": {"rate": 5.0, "noise": 0.01},
                "attitude": {"rate": 10.0, "noise": 0.005},
                "rates": {"rate": 50.0, "noise": 0.005},
                "depth": {"rate": 5.0, "noise": 0.02},
            },
        },
        (
            ("fin_effectiveness", {"all": (0.5, 0.75)}),
            CURRENT,
            BUOYANCY,
            ("input_delay", {"delay": (0.3, 0.6)}),
            ("thruster_gain", {"all": (0.7, 0.85)}),
        ),
    ),
}


def recordings(seeds: Range) -> Iterator[Case]:
    """Yield eight cases of each kind: what it can show, what it cannot, nothing, and over again."""
    for kind in KINDS:
        yield from (recording(kind, k, seeds) for k in range(CASES_PER_KIND))


def recording(kind: str, k: int, seeds: Range) -> Case:
    """Make the k-th case of a kind."""
    settings = KINDS[kind]
    cycle: list[Hidden | None] = [*settings.shown, *settings.silent, None]
    case_id, hidden = f"{kind}/{k}", cycle[k % len(cycle)]
    entry = _draw(hidden, random_of(case_id, seeds)) if hidden else None
    silent = tuple(name for name, _ in settings.silent if hidden and name == hidden[0])
    return Case(
        id=case_id,
        kind=kind,
        seed=seed_of(case_id, seeds),
        hidden=(entry,) if entry else (),
        silent=silent,
        tank=dict(settings.tank),
    )


def _draw(hidden: Hidden, random: np.random.Generator) -> EffectEntry:
    name, sizes = hidden
    values = {key: Value(value=rounded(random.uniform(*size), 3)) for key, size in sizes.items()}
    return EffectEntry(effect=name, parameters=values)
