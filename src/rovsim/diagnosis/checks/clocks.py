"""Find runs whose logs of commands have another clock, before anything is known of the model.

Where clocks differ from run to run by a tenth of a second, no effect is right for all runs, and
what is left of each hides which one differs. Here the lag of each run is that at which its commands
explain most of the measured acceleration, beside all that is linear in velocity, its square and the
attitude: a linear regression, in which neither inertia, drag nor gains need to be right. A lag of
the thrusters adds to all runs alike.
"""

from itertools import combinations
from typing import Iterable, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import unrotate
from rovsim.diagnosis.checks.by_run import group_runs
from rovsim.diagnosis.checks.run_differences import RunDifference, RunValues
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.hypothesis import Term
from rovsim.estimation.observer.observed_run import MIN_STRETCH_SECONDS, ObservedRun
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.measured_states import drive_as_measured
from rovsim.simulation.settings import SimulationSettings

MAX_LAG, LAG_STEP = 0.6, 0.02  # s; larger lags are told when a run is read
SAMPLE_SECONDS = 0.05  # s between rows: forces of thrusters change within tenths of a second
BLOCK_SECONDS, MIN_BLOCKS = 4.0, 5  # s; what is left is independent from block to block
MIN_ACCELERATION = 1e-6  # m/s2, rad/s2; less is rounding, on an axis that nothing moves
# s: of 36 campaigns whose clocks agree, of effects known and unknown, the most was 0.025
MIN_DIFFERENCE = 0.05
MIN_SIGMAS = 5.0  # by which lags differ surely: spreads of few blocks are rough


class RunLag(NamedTuple):
    """By how much a motion follows its commands too late, and the standard deviation of that, s."""

    value: float
    std: float


def find_clock_difference(
    base: Model, runs: Sequence[ObservedRun], settings: SimulationSettings
) -> RunDifference | None:
    """Find train runs whose commands surely have another clock than those of others.

    Args:
        base: gives the geometry of the thrusters.
        runs: all of them; of long ones there may be several parts.
        settings: how runs are filtered, and how commands are held.

    Returns:
        The delay of each run, its thrusters' included; None where the clocks may agree.
    """
    lags = {
        run: lag
        for run, own in group_runs(runs).items()
        if (lag := find_lag(base, [runs[k].motion for k in own], settings))
    }
    if not any(_differ(*pair) for pair in combinations(lags.values(), 2)):
        return None
    return RunDifference(
        {
            run: RunValues(Term(InputDelay(delay=lag.value), ("delay",)), {"delay": lag.std})
            for run, lag in lags.items()
        },
        explains=False,
    )


def find_shifts(
    base: Model, like: Iterable[Motion], runs: Iterable[Motion], settings: SimulationSettings
) -> dict[str, float]:
    """By how much later runs follow their commands, s, where their clock surely is another one.

    Args:
        base: gives the geometry of the thrusters.
        like: runs whose clocks agree.
        runs: that are compared with them.
        settings: how runs are filtered, and how commands are held.

    Returns:
        The time by run id, which `commands_shift_s` takes.
    """
    reference = find_lag(base, like, settings)
    if reference is None:
        return {}
    lags = {motion.run.id: find_lag(base, [motion], settings) for motion in runs}
    return {
        run: lag.value - reference.value
        for run, lag in lags.items()
        if lag and _differ(lag, reference)
    }


def find_lag(base: Model, parts: Iterable[Motion], settings: SimulationSettings) -> RunLag | None:
    """The lag of one run in several parts, or of runs whose clocks agree; None where nothing tells.

    Its standard deviation is that of a jackknife over blocks of time (Efron 1982).
    """
    lags = np.arange(-MAX_LAG, MAX_LAG + 0.5 * LAG_STEP, LAG_STEP)
    squares = []
    for motion in parts:
        if motion.measured is not None:
            return None
        squares.append(_sum_squares(base, motion, settings, lags))
    blocks = np.concatenate(squares, axis=1)  # (axes, blocks, lags)
    count = blocks.shape[1]
    if count < MIN_BLOCKS:
        return None
    total = blocks.sum(axis=1, keepdims=True)
    value = _likeliest(total[:, 0], lags)
    without_one = np.array([_likeliest(x, lags) for x in (total - blocks).swapaxes(0, 1)])
    spread = np.sum((without_one - without_one.mean()) ** 2)
    std = float(np.sqrt((count - 1) / count * spread))
    return RunLag(value, max(std, LAG_STEP / 10.0)) if np.isfinite(value + std) else None


def _differ(one: RunLag, other: RunLag) -> bool:
    difference = abs(one.value - other.value)
    sure = difference > MIN_SIGMAS * np.hypot(one.std, other.std)
    return bool(sure and difference > MIN_DIFFERENCE)


def _sum_squares(base: Model, motion: Motion, settings: SimulationSettings, lags: Array) -> Array:
    """Sums of squares (6, b, l) that regressions leave of each axis, in b blocks, for l lags."""
    time, period = motion.time, time_step(motion.time)
    wrench = drive_as_measured(base, motion, settings.replay).wrench
    if not motion.binned:
        wrench = settings.signals.suited(motion).filter.smoothed(wrench, period)
    wrench = wrench[:, np.ptp(wrench, axis=0) > 0.0]
    step = max(1, round(SAMPLE_SECONDS / period))
    long = [(a, b) for a, b in motion.segments() if (b - a) * period > MIN_STRETCH_SECONDS]
    at = np.concatenate([np.arange(a, b, step) for a, b in long] or [np.empty(0, int)])
    at = at[np.isfinite(np.hstack([motion.nu[at], motion.nu_dot[at]])).all(axis=1)]
    nu, number = motion.nu[at], np.floor(time[at] / BLOCK_SECONDS).astype(int)
    if not wrench.size or not len(at):
        return np.empty((6, 0, len(lags)))
    down = unrotate(motion.eta[at, 3:], np.array([0.0, 0.0, 1.0]))
    beside = np.column_stack([nu, np.abs(nu) * nu, down, np.ones(len(at))])
    of_block = (number[None] == np.unique(number)[:, None]).astype(float)
    sums = []
    for lag in lags:
        late = np.column_stack([np.interp(time[at] - lag, time, x) for x in wrench.T])
        X = np.hstack([beside, late])
        fitted = X @ np.linalg.lstsq(X, motion.nu_dot[at], rcond=None)[0]
        sums.append(of_block @ (motion.nu_dot[at] - fitted) ** 2)
    return np.array(sums).T


def _likeliest(squares: Array, lags: Array) -> float:
    """The lag that leaves least of all axes (6, l), to a fraction of a step; NaN at the ends."""
    moving = squares.min(axis=1) > MIN_ACCELERATION**2
    cost = np.log(squares[moving]).sum(axis=0)
    k = int(np.argmin(cost))
    if not 0 < k < len(lags) - 1:
        return float("nan")
    before, least, after = cost[k - 1 : k + 2]
    return float(lags[k] + 0.5 * LAG_STEP * (before - after) / (before - 2.0 * least + after))
