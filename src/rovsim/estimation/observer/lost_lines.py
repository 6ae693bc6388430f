"""Commands that a log lost: what was probably sent between the lines beside them.

A command holds until the next line, so that behind a lost line a model pushes late: 1 % of the
lines of 50 Hz make all commands late by 0.2 ms in the mean, as much as a minute tells of a delay.
"""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import LONG_STEP, robust_std
from rovsim.core.run import Commands

MAX_LOST_IN_A_ROW = 3  # lines; longer, and commands hardly go straight from line to line
MAX_LOST_SHARE = 0.1  # of all lines: more, and lines may be left out on purpose, as if unchanged
MAX_JITTER_SHARE = 0.2  # of the usual step: a log whose steps vary by more is not regular


def fill_lost_lines(commands: Commands) -> Commands:
    """Put lines where a regular log lost some, on straight lines between those beside them.

    A log that is not regular, or has more than a few gaps, is left as it is, and so are gaps over
    which an angle may have turned past half a turn.
    """
    time, value = commands.time, commands.value
    steps = np.diff(time)
    if not len(steps):
        return commands
    usual = float(np.median(steps))
    lost = np.rint(steps / usual).astype(int) - 1
    gaps = np.flatnonzero((steps > LONG_STEP * usual) & (lost <= MAX_LOST_IN_A_ROW))
    if commands.kind == "thruster":
        gaps = gaps[np.abs(value[gaps + 1] - value[gaps]).max(axis=1, initial=0.0) < np.pi]
    regular = robust_std(steps - usual) < MAX_JITTER_SHARE * usual
    if not (regular and 0 < lost[gaps].sum() <= MAX_LOST_SHARE * len(time)):
        return commands
    missing = np.concatenate([_divide(time[k], time[k + 1], lost[k]) for k in gaps])
    place = np.searchsorted(time, missing)
    return replace(
        commands,
        time=np.insert(time, place, missing),
        value=np.insert(value, place, commands.linear_at(missing), axis=0),
    )


def _divide(begin: float, end: float, count: int) -> Array:
    """Instants (count,) that divide the time from `begin` to `end` evenly."""
    return np.linspace(begin, end, count + 2)[1:-1]
