"""A flight that a log of commands prescribes: sent as it is, nobody steers."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import HALF_TURN_X
from rovsim.core.run import Commands
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands_csv import read_commands
from rovsim.measurement.recording.readers import KIND
from rovsim.results.experiment import Experiment

# How exactly people put a vehicle where a flight is to begin: standard deviations, m and rad.
PLACED, TURNED = 0.05, 0.05


@dataclass(frozen=True, eq=False)
class SentLog:
    """Commands to be sent, for so many `seconds`, from rest at `place` (3,) m, `heading` rad, NED.

    `place` and `heading` are None where nobody said: the middle of the tank, to the north.
    """

    commands: Commands
    seconds: float
    place: Array | None = None
    heading: float = 0.0

    def at(self, t: float) -> Array:
        """The command (c,) that holds at t s."""
        line = int(np.searchsorted(self.commands.time, t + 1e-9, side="right")) - 1
        return self.commands.value[max(line, 0)]

    def start(self, tank: Array, random: np.random.Generator) -> Array:
        """State (13,) at rest and level, near where it should be."""
        place = tank.mean(axis=1) if self.place is None else self.place
        half = 0.5 * (self.heading + TURNED * random.normal())
        attitude = [np.cos(half), 0.0, 0.0, np.sin(half)]
        return np.concatenate([place + PLACED * random.normal(size=3), attitude, np.zeros(6)])


def read_sent_log(path: Path, log: CommandLog, up: bool) -> SentLog:
    """Read a log; where it starts says `experiment.json` beside it, if it is there.

    Args:
        path: a csv of commands.
        log: how the tank's own logs are.
        up: the recordings' z axis points up.

    Raises:
        BadInput: it is no log like these, or too short.
    """
    found = read_commands(path, log)
    if len(found.time) < 2:
        raise BadInput(
            f"{len(found.time)} lines of commands",
            where=path,
            expected="a log of some seconds",
            remedy="Give the experiment.csv that `rovsim design` wrote.",
        )
    commands = Commands(found.time - found.time[0], found.value, KIND[log.kind])
    lasts = float(commands.time[-1] + np.median(np.diff(commands.time)))
    beside = path.with_suffix(".json")
    if not beside.is_file():
        return SentLog(commands, lasts)
    start = Experiment.read(beside).start
    signs = HALF_TURN_X if up else np.ones(3)
    place = np.array([start.x_m, start.y_m, start.z_m]) * signs
    return SentLog(commands, lasts, place, float(signs[2] * start.yaw_rad))
