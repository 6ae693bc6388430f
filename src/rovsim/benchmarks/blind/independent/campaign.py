"""Campaigns of the second simulator: raw exports and `campaign.yaml`, nothing of the truth."""

from itertools import pairwise
from pathlib import Path
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.spatial.transform import Rotation

from rovsim.benchmarks.blind.independent.exports import BODY_NAME, write_commands, write_poses
from rovsim.benchmarks.blind.independent.motion import Mover, Vehicle
from rovsim.benchmarks.blind.independent.pilot import Pilot, draw_turbulence
from rovsim.benchmarks.blind.independent.thrusters import Thrusters
from rovsim.benchmarks.blind.independent.vehicle import MOCAP_TO_NED, Hidden, read_constants
from rovsim.core.errors import BadInput
from rovsim.core.shipped import conf_file
from rovsim.core.yaml_files import read_yaml, write_yaml

# Effects of the catalogue that this simulator has. Missing are a loop on board, whose set-points
# the log would hold, and a current that wanders, since no observer can drift with it.
SIMULATED_EFFECTS = frozenset({
    "net_buoyancy", "buoyancy_center", "payload", "constant_wrench", "linear_damping",
    "quadratic_damping", "cubic_damping", "dry_friction", "coupled_damping", "added_mass",
    "added_mass_coupling", "lift", "fluid_memory", "current", "tether_tension", "tether_drag",
    "wall_proximity", "surface_proximity", "thruster_lag", "input_delay", "clock_drift",
    "thruster_deadband", "force_curve", "thruster_gain", "thrust_asymmetry", "voltage_sag",
    "advance_loss", "propeller_torque", "pose_filter", "marker_offset", "marker_misalignment",
    "world_tilt",
})  # fmt: skip


class OutOfTank(BadInput):
    """The vehicle reached a wall, the floor or the surface."""


def record_campaign(settings: Mapping[str, Any], out: Path) -> None:
    """Fly all runs of a campaign and write their exports.

    Args:
        settings: of the tank, as plain data.
        out: folder of the campaign.

    Raises:
        OutOfTank: the pilot cannot hold the vehicle against what is hidden.
    """
    out.mkdir(parents=True, exist_ok=True)
    seeds = np.random.SeedSequence(settings["seed"]).spawn(len(settings["runs"]))
    for run, seed in zip(settings["runs"], seeds, strict=True):
        _record(settings, run, out, np.random.default_rng(seed))
    write_yaml(out / "campaign.yaml", _describe(settings))


def _record(
    settings: Mapping[str, Any], run: Mapping[str, Any], out: Path, random: np.random.Generator
) -> None:
    """Fly one run, and write its exports."""
    file = read_yaml(conf_file(f"vehicle/{settings['vehicle']}.yaml") or Path(settings["vehicle"]))
    hidden = _list_hidden(settings)
    tank = np.sort(np.array([settings["tank"][k] for k in "xyz"]) * MOCAP_TO_NED[:, None], axis=1)
    seconds, tick = float(settings["duration"]), 1.0 / settings["log"]["rate"]
    thrusters = Thrusters(file, hidden, seconds)
    flight = Flight(
        Mover(read_constants(file, hidden), thrusters, hidden, tank),
        Pilot(run["control"], tank, seconds, random),
        tick,
        1.0 / settings["camera"]["rate"],
    )
    ticks, turbulence = round(seconds / tick), settings["turbulence"]
    pushes = draw_turbulence(
        turbulence["force"], turbulence["moment"], turbulence["time_constant"], tick, ticks, random
    )
    frames = list(flight.fly(pushes, tank))
    attitudes = Rotation.from_matrix(np.array([frame.R for frame in frames]))
    write_poses(
        out / f"{run['id']}_6D.tsv",
        np.array([frame.place for frame in frames]),
        attitudes,
        settings["camera"],
        hidden,
        random,
    )
    write_commands(
        out / f"{run['id']}_commands.csv", flight.stamps, flight.commands, settings["log"], random
    )


class Flight:
    """One run, flown tick by tick of the command log.

    Attributes:
        mover: integrates the motion.
        pilot: steers.
        tick: period of the command log, s.
        frame: period of the camera, s.
        stamps: time of each command by its log, s.
        acts: time from which each command acts, s.
        commands: that were given, (n,) each.
    """

    def __init__(self, mover: Mover, pilot: Pilot, tick: float, frame: float) -> None:
        self.mover, self.pilot, self.tick, self.frame = mover, pilot, tick, frame
        self.stamps: list[float] = []
        self.acts: list[float] = []
        self.commands: list[Array] = []

    def fly(self, turbulence: Sequence[Array], tank: Array) -> Iterator[Vehicle]:
        """Yield the vehicle at every frame, the first at the start of the run.

        Args:
            turbulence: wrench (6,) over each tick, body axes, N and N m.
            tank: least and largest coordinates (3, 2), m, NED.

        Raises:
            OutOfTank: the vehicle left the tank.
        """
        thrusters = self.mover.thrusters
        vehicle = self.pilot.begin(len(self.mover.own.position))
        for k, wrench in enumerate(turbulence):
            begin, end = k * self.tick, (k + 1) * self.tick
            command = thrusters.command(self.pilot.steer(begin, vehicle, self.tick))
            stamp, acts = thrusters.log(begin)
            self.stamps.append(stamp)
            self.acts.append(acts)
            self.commands.append(command)
            if k == 0:
                yield vehicle
                spun_up = thrusters.force(command)
                vehicle = Vehicle(
                    vehicle.place, vehicle.R, vehicle.velocity, spun_up, vehicle.memory
                )
            vehicle, frames = self._advance(vehicle, wrench, begin, end)
            if np.any(vehicle.place < tank[:, 0]) or np.any(vehicle.place > tank[:, 1]):
                raise _leave_tank(end)
            # the last instant is the end of the run, which has no frame
            yield from frames if k + 1 < len(turbulence) else frames[:-1]

    def _advance(
        self, now: Vehicle, turbulence: Array, begin: float, end: float
    ) -> tuple[Vehicle, list[Vehicle]]:
        """Carry the vehicle over one tick; the commands change wherever one acts inside it.

        Returns:
            The vehicle at the end, and at the frames inside the tick.
        """
        changes = [t for t in self.acts if begin < t < end]
        times = [
            k * self.frame
            for k in range(round(begin / self.frame) + 1, round(end / self.frame) + 1)
        ]
        frames: list[Vehicle] = []
        for a, b in pairwise([begin, *changes, end]):
            k = int(np.searchsorted(self.acts, 0.5 * (a + b), side="right")) - 1
            static = self.mover.thrusters.force(self.commands[max(k, 0)])
            instants = [min(t, b) for t in times if a + 1e-9 < t <= b + 1e-9]
            now, vehicles = self.mover.carry(now, static, turbulence, (a, b), instants)
            frames += vehicles
        return now, frames


def _leave_tank(t: float) -> OutOfTank:
    return OutOfTank(
        f"the vehicle left the tank after {t:.1f} s",
        where="independent simulator",
        expected="a run that stays between walls, floor and surface",
        remedy="Hide weaker effects, or make the tank larger.",
    )


def _list_hidden(settings: Mapping[str, Any]) -> Hidden:
    """Return the parameters of the hidden effects, by effect and name."""
    return {
        entry["effect"]: {k: float(v["value"]) for k, v in entry["parameters"].items()}
        for entry in settings["effects"]
    }


def _describe(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the content of `campaign.yaml`."""
    count = 8
    return {
        "name": settings["name"],
        "vehicle": settings["vehicle"],
        "tank": {k: list(settings["tank"][k]) for k in "xyz"},
        "mocap": {"format": "qtm_tsv", "body": BODY_NAME, "world_axes": "z_up", "body_axes": "flu"},
        "commands": {
            "format": "csv",
            "kind": "pwm",
            "columns": [f"t{k + 1}" for k in range(count)],
        },
        "runs": [
            {
                "id": run["id"],
                "control": run["control"],
                "split": run["split"],
                "mocap": f"{run['id']}_6D.tsv",
                "commands": f"{run['id']}_commands.csv",
            }
            for run in settings["runs"]
        ],
    }
