"""When the log of a run does not tell what was commanded: before it, after it, and in holes.

A command holds until the next line. But a log that writes at a steady rate and then nothing for a
second has lost lines, and the line before a hole is no better guess than that after it.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import LONG_STEP
from rovsim.core.run import Commands

# s, and times the usual step of a log, or the longest of an unsteady one, by which it begins too
# late or ends too early
MAX_END_GAP_S, MAX_END_GAP_STEPS = 2.0, 5.0
# Share of the steps that are usual ones where a log has a steady rate: one line in twenty may lack.
# A log that only writes changes has no steady rate, and no holes.
MIN_USUAL_SHARE = 0.95
# s, and usual steps, from which on a step is a hole: sticks change faster; shorter ones are judged
# line by line
MIN_HOLE_S, MIN_HOLE_STEPS = 0.3, 10.0


def find_unlogged(commands: Commands, begin: float, end: float) -> Array:
    """Spans (g, 2) in s, in their order, in which nobody knows what was commanded.

    Not where the command beside is zero, as before a pilot takes over, or where a hole has the same
    command on either side.

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
    spans = []
    if time[0] - begin > allowed and value[0].any():
        spans.append((begin, time[0]))
    if steady:
        holes = steps > max(MIN_HOLE_S, MIN_HOLE_STEPS * usual)
        holes &= (value[1:] != value[:-1]).any(axis=1)
        spans += zip(time[:-1][holes] + usual, time[1:][holes], strict=True)
    if end - time[-1] > allowed and value[-1].any():
        spans.append((time[-1], end))
    return np.reshape(spans, (-1, 2))
