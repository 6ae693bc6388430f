"""Widen what is known of late thrust beside a filter of the cameras: both delay what is seen.

The motion tells the sum of both delays far better than the noise of the cameras tells the filter's
part of it. Where an answer has late thrust as well, a cutoff is no surer than that noise, of
whatever kind it is, and the other delay no surer than the filter's.
"""

from dataclasses import replace

from rovsim.diagnosis.selection.filter_delay import (
    DELAY_ID,
    LAG_ID,
    find_cutoff_std,
    find_slow_delay,
)
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.camera import OPEN_STDS, Smoothing

LATE_PARAMETERS = (f"{DELAY_ID}.delay", f"{LAG_ID}.time_constant")  # the first one gives way


def share_delay(fit: Fit, smoothing: Smoothing) -> tuple[Fit, Smoothing]:
    """The fit and the filter, with intervals that leave open which of them delays.

    Both unchanged where thrust is not late.
    """
    names = fit.hypothesis.parameter_names
    late = next((names.index(name) for name in LATE_PARAMETERS if name in names), None)
    if late is None:
        return fit, smoothing
    scales = [p.scale for term in fit.hypothesis.terms for p in term.parameters]
    slowest, fastest = find_slow_delay(smoothing.lowest), find_slow_delay(smoothing.highest)
    std = (slowest - fastest) / (2.0 * OPEN_STDS)
    covariance = fit.covariance.copy()
    covariance[late, late] += (std / scales[late]) ** 2
    cutoff_std = max(smoothing.std, find_cutoff_std(smoothing.cutoff, std))
    return replace(fit, covariance=covariance), replace(smoothing, std=cutoff_std)
