"""Sudden pushes: more large ones than a Gaussian disturbance has, or a single one."""

from typing import Iterator

import numpy as np
from numpy import ndarray as Array
from scipy.signal import lfilter
from scipy.stats import binom, chi2, norm

from rovsim.core.axes import AXES
from rovsim.core.robust import robust_std
from rovsim.diagnosis.structure.residual import FALSE_ALARM_RATE, AxisResidual, Structure
from rovsim.estimation.observer.kalman import AxisFilter
from rovsim.estimation.observer.observed_run import ObservedRun

SUDDEN_SECONDS = 0.2  # s, about what the readings resolve
RARE_STDS = 3.5  # standard deviations: once in 2000 Gaussian pushes
# Times its standard deviation: turbulence varies with time and from run to run.
UNEVEN_FACTOR = 1.15
KICK_SECONDS = (0.2, 1.0)  # s, from a knock to a snag
ECHO_SECONDS = 2.0  # s within which the filter forgets a kick
# A single push is judged by its own size, not by its mean over the run, but has to be this large.
MIN_KICK_STDS = 4.0  # standard deviations of the disturbance


def find_sudden(residual: AxisResidual) -> Iterator[Structure]:
    """Test for more large innovations than a Gaussian disturbance has, where commands are known."""
    width = max(1, round(SUDDEN_SECONDS / residual.runs[0].period))
    inputs = zip(residual.white, residual.uncertain, strict=True)
    filtered = [
        _add_neighbours(w, width)[_add_neighbours(uncertain, width) == 0] for w, uncertain in inputs
    ]
    sums = np.concatenate(filtered)
    if not len(sums):
        return
    # the median hardly changes with the few large innovations that are looked for
    std = robust_std(sums)
    count = int(np.sum(np.abs(sums) > RARE_STDS * std))
    limit = binom.isf(
        FALSE_ALARM_RATE / len(AXES), len(sums), 2.0 * norm.sf(RARE_STDS / UNEVEN_FACTOR)
    )
    if count > limit:
        seconds = len(sums) * width * residual.runs[0].period
        text = f"sudden pushes, one in about {seconds / count:.2g} s"
        yield Structure(residual.axis, text, 1.0, count / limit)


def _add_neighbours(w: Array, few: int) -> Array:
    return w[: len(w) // few * few].reshape(-1, few).sum(axis=1)


def find_kicks(residual: AxisResidual) -> Iterator[Structure]:
    """Test for a single short push, at any time at which it is known what the thrusters did."""
    inputs = zip(residual.white, residual.filters, residual.runs, residual.undecided, strict=True)
    for w, f, run, undecided in inputs:
        for duration in KICK_SECONDS:
            count = max(1, round(duration / run.period))
            template = _kick(count, f, run)
            if len(template) < len(w):
                decided = np.convolve(undecided, np.ones(count), "full")[count - 1 :] == 0.0
                yield from _judge_kick(residual, w, template, duration, run, decided)


def _kick(few: int, f: AxisFilter, run: ObservedRun) -> Array:
    """How a push of unit size over `few` readings shows in the innovations, until it has faded."""
    kick = np.concatenate([np.ones(few), np.zeros(round(ECHO_SECONDS / run.period))])
    return lfilter(*f.response, kick)


def _judge_kick(
    residual: AxisResidual,
    w: Array,
    template: Array,
    duration: float,
    run: ObservedRun,
    possible_begins: Array,
) -> Iterator[Structure]:
    """Judge the largest push of one duration in a run.

    Args:
        residual: of the axis.
        w: whitened innovations (n,) of the run.
        template: how a push of unit size shows in them.
        duration: of the push, s.
        run: the run.
        possible_begins: mask (n,) of readings at which a push may begin.
    """
    power = float(template @ template)
    factor = np.correlate(w, template, "valid") / power
    factor *= possible_begins[: len(factor)]
    k = int(np.argmax(np.abs(factor)))
    moments = len(factor) * len(residual.runs)
    limit = UNEVEN_FACTOR**2 * chi2.isf(
        FALSE_ALARM_RATE / (2 * len(KICK_SECONDS) * len(AXES) * moments), 1
    )
    at = run.edges[0] + run.time[run.settled][k]
    yield from residual.weigh(
        f"a push of {duration:g} s at {at:.1f} s in run {run.motion.run.id}",
        size=abs(factor[k]) / MIN_KICK_STDS,
        statistic=factor[k] ** 2 * power,
        limit=limit,
        moment=True,
    )
