"""How noisy the poses of a recording are."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import STD_PER_MAD
from rovsim.core.rotations import turns
from rovsim.measurement.quality.excitation import select_found_poses
from rovsim.measurement.recording.recording import Recording
from rovsim.results.quality import PoseNoise

THIRD_DIFFERENCE_GAIN = 20.0  # its variance over that of white noise: 1 + 9 + 9 + 1


def measure_noise(recording: Recording) -> PoseNoise:
    """Estimate the noise of a pose, m and rad: robust spread of third differences / sqrt(20).

    Motion that is slow against four samples cancels in third differences. On a slow export it does
    not, and the number is an upper bound. None with too few samples.
    """
    _, position, attitude = select_found_poses(recording)
    mask = _evenly_spaced(recording)
    dp, dtheta = np.diff(position, 3, axis=0)[mask], np.diff(turns(attitude), 2, axis=0)[mask]
    return PoseNoise(position_m=_robust_std(dp), attitude_rad=_robust_std(dtheta))


def _evenly_spaced(recording: Recording) -> Array:
    """Mask (k - 3,): where four consecutive found frames are one nominal step apart each."""
    steps = np.diff(recording.time[recording.tracked])
    even = np.abs(steps * recording.rate - 1.0) < 0.5
    return even[:-2] & even[1:-1] & even[2:]


def _robust_std(third: Array) -> float | None:
    if len(third) < 10:
        return None
    per_axis = STD_PER_MAD * np.median(np.abs(third - np.median(third, axis=0)), axis=0)
    return float(np.sqrt(np.mean(per_axis**2) / THIRD_DIFFERENCE_GAIN))
