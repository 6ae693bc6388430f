"""Flights whose commands come from a log, without a pilot."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.files import sha256_of
from rovsim.core.rotations import HALF_TURN_X
from rovsim.core.run import Commands
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.formats.commands_csv import read_commands
from rovsim.measurement.recording.tidying import tidy_commands
from rovsim.results.experiment import Experiment
from rovsim.simulation.rest import PLACEMENT_STD_M, PLACEMENT_STD_RAD, rest_state

# s: less shows nothing; more is no flight that nobody steers, and would fill the memory with states
MIN_LOG_S, MAX_LOG_S = 2.0, 1800.0


@dataclass(frozen=True, eq=False)
class SentLog:
    """Commands to be sent in a flight that begins at rest and level.

    Attributes:
        commands: by time since the start, s.
        seconds: duration of the flight, s.
        place: (3,) where it starts, m NED; None: in the middle of the tank.
        heading: with which it starts, rad from north.
    """

    commands: Commands
    seconds: float
    place: Array | None = None
    heading: float = 0.0

    def at(self, t: float) -> Array:
        """The command (c,) that holds at t s."""
        return self.commands.held_at(t + 1e-9)

    def start(self, tank: Array, random: np.random.Generator) -> Array:
        """Draw the initial state (13,): at rest and level, placed about as exactly as people do.

        Args:
            tank: walls (3, 2) in NED, m.
            random: generator.
        """
        position = tank.mean(axis=1) if self.place is None else self.place
        heading = self.heading + PLACEMENT_STD_RAD * random.normal()
        return rest_state(position + PLACEMENT_STD_M * random.normal(size=3), heading)


def described_by(path: Path) -> Path | None:
    """Path of the `.json` with the plan of a flight beside its log; None where there is none."""
    plan = path.with_suffix(".json")
    return plan if plan.is_file() else None


def read_sent_log(path: Path, log: CommandLog, up: bool) -> SentLog:
    """Read a log of commands, and the start of the flight from the plan beside it, if there is one.

    Args:
        path: a csv of commands.
        log: format of the tank's own logs, which this one must have.
        up: whether the z axis of recordings points up, so that the plan's position is converted.

    Raises:
        BadInput: the log has another format, is too short or too long, or is not the one that the
            plan beside it describes.
    """
    log_lines, _ = tidy_commands(read_commands(path, log), path)
    commands = replace(log_lines, time=log_lines.time - log_lines.time[0])
    step = float(np.median(np.diff(commands.time))) if len(commands.time) > 1 else 0.0
    duration = float(commands.time[-1]) + step
    if not MIN_LOG_S <= duration <= MAX_LOG_S:
        raise BadInput(
            f"{len(log_lines.time)} lines of commands, which last {duration:.4g} s",
            where=path,
            expected=f"a log of {MIN_LOG_S:g} to {MAX_LOG_S:g} s",
            remedy="Give the experiment.csv that `rovsim design` wrote.",
        )
    plan = described_by(path)
    if plan is None:
        return SentLog(commands, duration)
    flight = Experiment.read(plan)
    _require_the_same(path, plan, flight)
    signs = HALF_TURN_X if up else np.ones(3)
    start = flight.start
    position = np.array([start.x_m, start.y_m, start.z_m]) * signs
    return SentLog(commands, duration, position, float(signs[2] * start.yaw_rad))


def _require_the_same(path: Path, beside: Path, flight: Experiment) -> None:
    """Refuse a plan that describes another log: its start could lead this one into a wall."""
    if flight.commands_sha256 in (None, sha256_of(path)):
        return
    raise BadInput(
        f"its commands are not those that {beside.name} describes",
        where=path,
        expected="the two files of one plan: what starts the vehicle stands in the other",
        remedy=f"Run `rovsim design` again, or move {beside.name} away to fly the log from the "
        "middle of the tank.",
    )
