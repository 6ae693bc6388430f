"""How pushes show in the whitened innovations of a run."""

import numpy as np
from numpy import ndarray as Array
from scipy.signal import lfilter

from rovsim.estimation.observer.kalman import AxisFilter
from rovsim.estimation.observer.observed_run import ObservedRun


def respond(disturbance: Array, f: AxisFilter, run: ObservedRun) -> Array:
    """Filter pushes on one axis as the innovations of a run would show them.

    Args:
        disturbance: accelerations (..., n) at all readings of the run, m/s2 or rad/s2.
        f: filter of that axis.
        run: the run.

    Returns:
        The response (..., m) in the whitened innovations of the settled readings.
    """
    b, a = f.response
    out = np.empty(disturbance.shape)
    for begin, end in run.innovation_segments:
        out[..., begin:end] = lfilter(b, a, disturbance[..., begin:end])
    return out[..., run.settled]
