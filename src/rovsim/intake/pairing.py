"""Find the log of commands that belongs to each motion.

In this order: commands in the same file, commands whose predicted motion is the measured one, names
of files, clocks.
"""

import re
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import Callable, Iterator, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.evaluation.commanded_motion.cross_correlation import MIN_CORRELATION, MIN_LEAD_RATIO
from rovsim.intake.motions import CommandFile, MotionFile
from rovsim.intake.names import run_key, sensor_key


@dataclass(frozen=True, eq=False)
class Pair:
    """The motion of a run and its commands.

    Attributes:
        motion: of the run.
        log: its commands; None where there are none, or where a person has to choose.
        reason: how the log is known, or why it is not.
        options: logs to choose from, where it is not known.
        likely: where the name speaks for another log, the log that the motion follows.
    """

    motion: MotionFile
    log: CommandFile | None
    reason: str
    options: tuple[CommandFile, ...] = ()
    likely: CommandFile | None = None

    @property
    def shown(self) -> CommandFile | None:
        """The log of the run, else the likeliest; None where there is neither."""
        return self.log or self.likely


class _Clues(NamedTuple):
    """Positions of the log that each clue speaks for; None where it speaks for none.

    Attributes:
        content: the log that the motion follows.
        name: by the names of the files.
        folder: the only log in the folder of a motion that is alone there.
        clock: by the clocks.
    """

    content: int | None
    name: int | None
    folder: int | None
    clock: int | None


def pair(
    motions: Sequence[MotionFile],
    logs: Sequence[CommandFile],
    score: Callable[[MotionFile, CommandFile], float],
) -> list[Pair]:
    """Find the commands of each motion.

    Args:
        motions: of the runs.
        logs: of commands.
        score: the correlation of a motion with what a log would cause, 0 where unknown.
    """
    by_path = {log.path: log for log in logs}
    if all(motion.path in by_path for motion in motions):
        return [Pair(m, by_path[m.path], "in the same file") for m in motions]
    if not logs:
        return [Pair(m, None, "") for m in motions]
    table = np.array([[score(m, log) for log in logs] for m in motions])
    told = (
        _by_content(table),
        _by_name(motions, logs),
        _by_folder(motions, logs),
        _by_clock(motions, logs),
    )
    clues = [_Clues(*one) for one in zip(*told, strict=True)]
    return [_decided(m, list(logs), table[k], clues[k]) for k, m in enumerate(motions)]


def _by_content(table: Array) -> list[int | None]:
    """Find the log that each motion follows; None where another pair is nearly as good.

    Args:
        table: (motions, logs) of correlations.

    Returns:
        For each motion the position of its log.
    """
    matches: list[int | None] = []
    for k, row in enumerate(table):
        best = int(np.argmax(row))
        rivals = [*np.delete(row, best), *np.delete(table[:, best], k)]
        sure = row[best] >= MIN_CORRELATION and row[best] >= MIN_LEAD_RATIO * max(
            rivals, default=0.0
        )
        matches.append(best if sure else None)
    return matches


def _by_name(motions: Sequence[MotionFile], logs: Sequence[CommandFile]) -> list[int | None]:
    """Find the log whose name differs from the motion's only in words for roles and sensors.

    Where there is none, take the log whose name starts with the same words.

    Returns:
        For each motion the position of its log, None where names do not tell.
    """
    matches: list[int | None] = [None] * len(motions)
    for key in (_by_role, _by_sensor):
        _add_by(key, motions, logs, matches)
    for k, log in _by_first_words(motions, logs):
        matches[k] = log if matches[k] is None else matches[k]
    return matches


def _by_folder(motions: Sequence[MotionFile], logs: Sequence[CommandFile]) -> list[int | None]:
    """Find the only log in the folder of a motion that is alone there."""
    matches: list[int | None] = [None] * len(motions)
    _add_by(lambda path: str(path.absolute().parent), motions, logs, matches)
    return matches


def _add_by(
    key: Callable[[Path], str],
    motions: Sequence[MotionFile],
    logs: Sequence[CommandFile],
    matches: list[int | None],
) -> None:
    """Pair a motion without a log with the log of the same key, if no other file has that key.

    Args:
        key: what of a path is compared.
        motions: of the runs.
        logs: of commands.
        matches: position of each motion's log; changed in place.
    """
    motion_keys, log_keys = ([key(x.path) for x in group] for group in (motions, logs))
    for k, label in enumerate(motion_keys):
        if matches[k] is None and label and motion_keys.count(label) == log_keys.count(label) == 1:
            matches[k] = log_keys.index(label)


def _by_first_words(
    motions: Sequence[MotionFile], logs: Sequence[CommandFile]
) -> Iterator[tuple[int, int]]:
    """Find pairs whose names share more leading words with each other than with any other file.

    Yields:
        Positions of a motion and of its log.
    """
    table = np.array([[_alike(m.path.stem, log.path.stem) for log in logs] for m in motions])
    for k, row in enumerate(table):
        best = int(np.argmax(row))
        rivals = [*np.delete(row, best), *np.delete(table[:, best], k)]
        if row[best] > max(rivals, default=0):
            yield k, best


def _alike(one: str, other: str) -> int:
    """Count the leading words that two names share; 0 where the rest of either has a digit."""
    words, other_words = (re.split(r"[\W_]+", stem.casefold()) for stem in (one, other))
    pairs = zip(words, other_words, strict=False)
    count = len([*takewhile(lambda pair: pair[0] == pair[1], pairs)])
    remainder = "".join(words[count:] + other_words[count:])
    return 0 if re.search(r"\d", remainder) else count


def _by_role(path: Path) -> str:
    return run_key(path.stem)


def _by_sensor(path: Path) -> str:
    return sensor_key(path.stem)


def _by_clock(motions: Sequence[MotionFile], logs: Sequence[CommandFile]) -> list[int | None]:
    """Find the only log whose times overlap those of a motion and of no other motion.

    Returns:
        For each motion the position of its log, None where clocks do not tell.
    """
    spans = [(log.drive.time.min(), log.drive.time.max()) for log in logs]
    meets = np.array([[m.track.start < b and a < m.track.end for a, b in spans] for m in motions])
    return [
        int(np.argmax(row)) if row.sum() == 1 and meets[:, np.argmax(row)].sum() == 1 else None
        for row in meets
    ]


def _decided(motion: MotionFile, logs: list[CommandFile], scores: Array, clues: _Clues) -> Pair:
    """Decide on the log of a motion.

    Args:
        motion: of the run.
        logs: all of them.
        scores: (logs,) correlation of the motion with each log.
        clues: what speaks for which of them.
    """
    content, where, why = clues.content, clues.name, "by its name"
    if where is None:
        where, why = clues.folder, "the only log beside it"
    if content is not None and where in (None, content):
        reason = f"its commands cause this motion (correlation {scores[content]:.2f})"
        agree = ", and the names agree" if clues.name is not None else ""
        return Pair(motion, logs[content], reason + agree)
    if content is not None and where is not None:
        explanation = (
            f"{why}: {logs[where].path.name}, but the motion is that of "
            f"{logs[content].path.name} (correlation {scores[content]:.2f} against "
            f"{scores[where]:.2f})"
        )
        return Pair(motion, None, explanation, (logs[content], logs[where]), logs[content])
    for candidate, explanation in ((where, why), (clues.clock, "the only log at that time")):
        if candidate is not None:
            caveat = f"; the motion does not show it (correlation {scores[candidate]:.2f})"
            return Pair(
                motion,
                logs[candidate],
                explanation + (caveat if 0 < scores[candidate] < MIN_CORRELATION else ""),
            )
    if len(logs) == 1:
        return Pair(motion, logs[0], "the only log of commands")
    order = np.argsort(-scores)
    return Pair(motion, None, "no name, clock or motion tells which", tuple(logs[k] for k in order))
