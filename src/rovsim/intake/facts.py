"""What all files together tell about a campaign: runs, commands, vehicle and axes."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Sequence

import numpy as np

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.intake.axes import Axes, find_axes
from rovsim.intake.bodies import FoundBody, find_body, track_of
from rovsim.intake.choice import Choice, choose
from rovsim.intake.collect_files import CollectedFiles
from rovsim.intake.motions import CommandFile, MotionFile, correlate, highest
from rovsim.intake.names import run_ids
from rovsim.intake.pairing import Pair, pair
from rovsim.intake.survey import Contents
from rovsim.intake.together import list_stems
from rovsim.intake.vehicles import VehicleMatch, fitting
from rovsim.measurement.recording.readers import mocap_readers

OTHER_LOG_REMEDY = "Run init for each kind of log, with another out=."
ATTITUDE_REMEDY = (
    "If these are measured angles, name them after their unit: roll_deg, pitch_deg, yaw_deg, or "
    "roll_rad …; they are then read beside the rest of the run."
)


@dataclass(frozen=True, eq=False)
class Facts:
    """What the files tell; what they do not tell is empty.

    Attributes:
        collected: what each file holds.
        logs: of commands.
        body: the rigid body or topic that is the vehicle.
        pairs: the motion of each run and its commands.
        choice: the vehicle.
        axes: of the world and of the body.
        ids: of the runs, in the order of `pairs`.
    """

    collected: CollectedFiles
    logs: tuple[CommandFile, ...]
    body: FoundBody
    pairs: tuple[Pair, ...]
    choice: Choice
    axes: Axes
    ids: tuple[str, ...]

    @property
    def motions(self) -> tuple[Contents, ...]:
        """The file of each run's motion, in the order of the runs."""
        return self.collected.motions

    @property
    def log(self) -> CommandFile | None:
        """The first log that a run uses, else the first of all, as an example of their columns."""
        paired = [p.log for p in self.pairs if p.log is not None]
        return next(iter([*paired, *self.logs]), None)

    @property
    def kind_asked(self) -> bool:
        """Whether only a person can say what kind of commands these are."""
        return any(log.drive.asked for log in self.logs)


def find_facts(collected: CollectedFiles) -> Facts:
    """Find out all that the files tell.

    Raises:
        BadInput: they are not runs of one vehicle, or not logged alike.
    """
    logs = _logs(collected)
    fits = _fits(logs)

    def score(motion: MotionFile, log: CommandFile) -> float:
        return max((highest(correlate(motion, log, fit)) for fit in fits), default=0.0)

    body = find_body(collected.motions, lambda name: _of_body(collected, name, logs, score))
    motions = [
        MotionFile(
            contents.named,
            track_of(contents, body.name),
            tuple(file.named for file in contents.beside),
        )
        for contents in collected.motions
    ]
    pairs = pair(motions, logs, score)
    choice = _supposing(logs, choose(fits, pairs) if fits else _no_choice(logs))
    body_known = body.name or body.choices == ("",)
    file_axes = mocap_readers()[collected.motions[0].format].axes
    axes = find_axes(file_axes, [m.track for m in motions], choice.turned if body_known else ())
    ids = run_ids(list_stems(collected.motions))
    return Facts(collected, tuple(logs), body, tuple(pairs), choice, axes, tuple(ids))


def _of_body(collected: CollectedFiles, name: str, logs: Sequence[CommandFile], score) -> float:
    """Score a body: mean over files of its motion's correlation with the commands.

    These are the commands in the same file, else those of the log that correlates best.
    """
    scores = []
    for contents in collected.motions:
        motion = MotionFile(contents.named, track_of(contents, name))
        candidates = [log for log in logs if log.path == contents.named] or logs
        scores.append(max((score(motion, log) for log in candidates), default=0.0))
    return float(np.mean(scores))


def _logs(collected: CollectedFiles) -> list[CommandFile]:
    """List the logs of commands: files of their own, else those in the files of the motions."""
    separate = [
        CommandFile(contents.named, contents.drives[0])
        for contents in collected.logs
        if contents.drives
    ]
    if separate:
        return separate
    inside = []
    for contents in (file for motion in collected.motions for file in motion.files):
        moving = [drive for drive in contents.drives if drive.moves]
        for drive in (moving or list(contents.drives))[:1]:
            inside.append(CommandFile(contents.named, drive))
    return inside


def _fits(logs: Sequence[CommandFile]) -> list[VehicleMatch]:
    """List the vehicles that the logs fit.

    Raises:
        BadInput: two logs have different columns.
    """
    for log in logs[1:]:
        _check_same(logs[0], log)
    return fitting(logs[0].drive) if logs else []


def _check_same(first: CommandFile, log: CommandFile) -> None:
    if set(log.drive.columns) != set(first.drive.columns):
        raise BadInput(
            f"the commands {', '.join(log.drive.columns)}; those of {Path(first.path).name} are "
            f"{', '.join(first.drive.columns)}",
            where=log.path,
            expected="the same columns in every log of commands",
            remedy=ATTITUDE_REMEDY if set(log.drive.columns) <= set(AXES[3:]) else OTHER_LOG_REMEDY,
        )


def _supposing(logs: Sequence[CommandFile], choice: Choice) -> Choice:
    """Withdraw the choice of a vehicle where the kind of the commands has to be asked first."""
    if not any(log.drive.asked for log in logs):
        return choice
    return replace(choice, fit=None, reason=f"if the commands are N and N m, {choice.reason}")


def _no_choice(logs: Sequence[CommandFile]) -> Choice:
    reason = "no vehicle file takes such commands" if logs else "there are no commands that tell"
    return Choice(None, reason, (), (), {})
