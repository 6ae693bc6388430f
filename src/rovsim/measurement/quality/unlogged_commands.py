"""When the log of a run does not tell what was commanded: before it, after it, and in holes.

A command holds until the next line. But where a log writes at a steady rate, then nothing for a
second, and goes on far from where it was, lines were lost. The line before such a hole is no better
guess than the line after it.
"""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import LONG_STEP
from rovsim.core.run import Commands
from rovsim.measurement.signals.motion import Motion

MEMORY_SECONDS = 0.5  # for which propellers remember what was commanded

# s, and times the usual step of a log, or the longest of an unsteady one, by which it begins too
# late or ends too early
MAX_END_GAP_S, MAX_END_GAP_STEPS = 2.0, 5.0
# Of the largest command of a column: less is the rest position of a stick.
MIN_COMMAND = 0.05
# Share of the steps that are usual ones where a log has a steady rate: one line in twenty may lack.
MIN_USUAL_SHARE = 0.95
# s, and usual steps, from which on a step may be a hole; shorter ones are judged line by line
MIN_HOLE_S, MIN_HOLE_STEPS = 0.3, 10.0
# Share of the lines that change by less than what changes over a hole. A log that writes nothing
# while nothing changes goes on from where it was.
USUAL_CHANGE = 0.95


def find_unlogged(commands: Commands, begin: float, end: float) -> Array:
    """Spans (g, 2) in s, in their order, in which nobody knows what was commanded.

    None where the log was at rest before (or after it, where it begins late): then nothing is
    commanded until the next line.

    Args:
        commands: of the run.
        begin: of the recording, s.
        end: of the recording, s.
    """
    time, value = commands.time, commands.value
    if len(time) < 2:
        return np.empty((0, 2))
    steps = np.diff(time)
    usual = float(np.median(steps))
    steady = np.mean(steps < LONG_STEP * usual) >= MIN_USUAL_SHARE
    allowed = max(MAX_END_GAP_S, MAX_END_GAP_STEPS * (usual if steady else float(steps.max())))
    acts = (np.abs(value) > MIN_COMMAND * np.abs(value).max(axis=0)).any(axis=1)
    spans = []
    if time[0] - begin > allowed and acts[0]:
        spans.append((begin, time[0]))
    if steady:
        holes = (steps > max(MIN_HOLE_S, MIN_HOLE_STEPS * usual)) & acts[:-1] & _jumps(value)
        spans += zip(time[:-1][holes] + usual, time[1:][holes], strict=True)
    if end - time[-1] > allowed and acts[-1]:
        spans.append((time[-1], end))
    return np.reshape(spans, (-1, 2))


def keep_logged(motion: Motion) -> Motion:
    """The motion of a run, of which only that is usable whose commands are known."""
    time = motion.time
    unlogged = find_unlogged(motion.commands, float(time[0]), float(time[-1]))
    if not len(unlogged):
        return motion
    known = [(time < begin) | (time > end + MEMORY_SECONDS) for begin, end in unlogged]
    return replace(motion, usable=motion.usable & np.all(known, axis=0))


def _jumps(value: Array) -> Array:
    """Mask (m - 1,) of the steps over which commands (m, c) change more than they usually do."""
    change = np.abs(np.diff(value, axis=0))
    return np.asarray((change > np.quantile(change, USUAL_CHANGE, axis=0)).any(axis=1))
