"""Tell where a motion does not follow its commands, or follows them too late or too early."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.evaluation.commanded_motion.cross_correlation import MIN_CORRELATION, CrossCorrelation

# Lags of a motion whose clock is right. A thruster answers within tenths of a second, a radio or an
# autopilot adds as much again, and the correlation tells the lag to about a tenth of a second.
MIN_USUAL_LAG_S, MAX_USUAL_LAG_S = -0.25, 0.6
# Under periodic commands, a peak some seconds away may be as high as that at the true lag.
# correlation by which it must be higher, s beyond the usual lags
MIN_PEAK_LEAD, NEAR_EXCESS_S = 0.03, 1.0
QUARTER_HOUR_S = 900.0  # time zones differ by whole quarters of an hour
# s by which clocks that were set by hand may differ beside the time zone
HAND_SET_TOLERANCE_S = 60.0
DAY_S = 86400.0  # no two time zones are further apart
TO_COMMAND_TIMES = "to the times of the commands (`commands_shift_s` in the run)"
MAX_FITTED_DELAY_S = 0.5  # a fit of `input_delay` does not correct a larger offset


# The best lags of runs whose clocks have the same offset differ by less than this.
MAX_LAG_SCATTER_S = 0.4


def tell_following(correlation: CrossCorrelation, axes: Array, start: float | None = None) -> str:
    """Say that a motion hardly follows its commands, or follows them too late or too early.

    Where not all commanded axes were measured, a low correlation of the others tells nothing.

    Args:
        correlation: the correlation of the motion with its commands.
        axes: body axes of the file (3, 3), see `CrossCorrelation.along`.
        start: when the motion began according to its own file, local time in s since 1970; None
            where it does not say.

    Returns:
        A half sentence; empty where nothing is wrong.
    """
    score, lag = correlation.best(axes)
    if score < MIN_CORRELATION and correlation.unseen:
        return ""
    if score < MIN_CORRELATION:
        return (
            f"the motion hardly follows its commands (correlation {score:.2f}): another log, "
            "another vehicle, a tether that pulls?"
        )
    if not is_off(correlation, axes):
        return ""
    return _explain_offset(score, lag, start)


def tell_together(
    correlations: Sequence[CrossCorrelation], axes: Array, start: float | None = None
) -> str:
    """Say that the clocks of all runs have the same offset, as far as a correlation can tell.

    Args:
        correlations: the correlation of each run.
        axes: body axes of the files (3, 3).
        start: when one of the motions began, see `tell_following`.

    Returns:
        A half sentence; empty where the clocks are right, or there are fewer than two runs.
    """
    if len(correlations) < 2:
        return ""
    scores, lags = (
        np.array([correlation.best(axes) for correlation in correlations]).reshape(-1, 2).T
    )
    consistent = min(scores) >= MIN_CORRELATION and np.ptp(lags) < MAX_LAG_SCATTER_S
    if not consistent or not all(is_off(correlation, axes) for correlation in correlations):
        return ""
    return _explain_offset(float(np.mean(scores)), float(np.median(lags)), start)


def is_off(correlation: CrossCorrelation, axes: Array) -> bool:
    """Whether a motion follows its commands clearly later, or earlier, than thrusters answer."""
    score, lag = correlation.best(axes)
    excess = max(MIN_USUAL_LAG_S - lag, lag - MAX_USUAL_LAG_S)
    plausible = (correlation.lag >= MIN_USUAL_LAG_S) & (correlation.lag <= MAX_USUAL_LAG_S)
    plausible_best = correlation.along(axes)[plausible].max(initial=-1.0)
    return bool(
        excess > 0.0 and (excess <= NEAR_EXCESS_S or score >= plausible_best + MIN_PEAK_LEAD)
    )


def _explain_by_start(lag: float, start: float) -> str:
    """Say that commands count from 1970 and the motion from its start, if `start` agrees with that.

    Args:
        lag: by which the motion comes after its commands, s.
        start: when the motion began according to its own file, local time in s since 1970.

    Returns:
        What to do; empty where the offset is another one.
    """
    zone = QUARTER_HOUR_S * round((start + lag) / QUARTER_HOUR_S)
    if (
        abs(lag) < DAY_S
        or abs(zone) > DAY_S
        or not MIN_USUAL_LAG_S <= lag + start - zone <= MAX_USUAL_LAG_S
    ):
        return ""
    remark = f", less {zone / 3600.0:+g} h for its time zone" if zone else ""
    return (
        "the times of the commands count from 1970, those of the motion from its start: add "
        f"{zone - start:+.3f} s {TO_COMMAND_TIMES}. That is the start in the header of "
        f"the motion{remark}; an `input_delay` that a diagnosis then finds is what is left of it."
    )


def _explain_offset(score: float, lag: float, start: float | None) -> str:
    """Say how far clocks differ and what to do about it: a time zone, another epoch, or any offset.

    Args:
        score: correlation of motion and commands at that lag.
        lag: by which the motion comes after its commands, s.
        start: when the motion began, see `tell_following`.
    """
    if start is not None and (advice := _explain_by_start(lag, start)):
        return advice
    side = "after" if lag > 0 else "before"
    zone = QUARTER_HOUR_S * round(lag / QUARTER_HOUR_S)
    if zone and abs(lag) < DAY_S and abs(lag - zone) < HAND_SET_TOLERANCE_S:
        remainder = f"{lag - zone:+.1f}"
        next_step = f" first, and look at the {remainder} s that remain" if float(remainder) else ""
        advice = f"a time zone? Add {zone:+.0f} s {TO_COMMAND_TIMES}{next_step}"
    else:
        advice = (
            f"add {lag:+.1f} s {TO_COMMAND_TIMES}. That holds the answer of the "
            "thrusters too, some 0.2 s: an `input_delay` that a diagnosis then finds, of either "
            "sign, is what is left of the clock; add it as well"
        )
        if abs(lag) < MAX_FITTED_DELAY_S:
            advice = f"let `input_delay` find it, or {advice}"
    return (
        f"the motion comes {abs(lag):.2f} s {side} its commands (correlation {score:.2f}): the "
        f"clocks differ; {advice}."
    )
