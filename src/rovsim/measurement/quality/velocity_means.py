"""Check by the poses whether exported body velocities are means from line to line."""

from typing import Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import exp, multiply, turns, unrotate
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.binned import MAX_BIN_RATIO

MIN_STEPS = 50
MAX_INSTANT_RATIO = 0.85  # of the differences, over the axes: noise alone comes to 1
EVEN_STEP_SPREAD = 0.1  # of a step, standard deviation: beyond, the readings can be distinguished
MIN_MEANS_RATIO = 1.1  # of the differences


def doubt_means(recording: Recording) -> Iterator[str]:
    """Yield a sentence where velocities that are read as means are values at the poses' times.

    If poses and velocities are means over the same times, they agree like values at the same
    times. With even steps the two cases cannot be distinguished; with uneven ones, the sentence is
    only given if that reading fits surely worse.
    """
    differences = _differences(recording)
    if differences is None:
        return
    to_next, at_times, both_means, even_steps = differences
    if _ratio(at_times, to_next) < MAX_INSTANT_RATIO and (
        even_steps or _ratio(both_means, at_times) > MIN_MEANS_RATIO
    ):
        yield (
            "The body velocities fit the poses as values at their times, not as means from line to "
            "line: write 'velocity: instant' below 'mocap'. Only where the poses are means over "
            "the same times as the velocities, leave it: the two look alike."
        )


def _differences(recording: Recording) -> tuple[Array, Array, Array, bool] | None:
    """Compare the motion between successive poses with three readings of the velocities.

    Returns:
        The median absolute difference (6,), m/s and rad/s, if velocities are means to the next
        line, if they are values at the lines, and if velocities and poses both are means; and
        whether the steps are even. None where there are too few steps.
    """
    time, nu = recording.time, recording.nu
    if nu is None:
        return None
    step = np.diff(time)
    pose_nu = _moved(recording) / step[:, None]
    length = np.append(step, np.median(step))[:, None]
    passed = length * nu
    readings = (
        nu[:-1],
        0.5 * (nu[:-1] + nu[1:]),
        0.5 * (passed[:-1] + passed[1:]) / step[:, None],
    )
    mask = np.isfinite(np.hstack([pose_nu, *readings])).all(axis=1)
    mask &= step < MAX_BIN_RATIO * np.median(step)
    if mask.sum() < MIN_STEPS:
        return None
    to_next, at_times, both_means = (np.median(np.abs(pose_nu - x)[mask], axis=0) for x in readings)
    return (
        to_next,
        at_times,
        both_means,
        bool(np.std(step[mask]) < EVEN_STEP_SPREAD * np.mean(step[mask])),
    )


def _moved(recording: Recording) -> Array:
    """Displacement, m, and turn, rad, (n - 1, 6) from pose to pose, in the body axes halfway."""
    rotation = turns(recording.attitude)
    halfway = multiply(recording.attitude[:-1], exp(0.5 * rotation))
    return np.hstack([unrotate(halfway, np.diff(recording.position, axis=0)), rotation])


def _ratio(one: Array, other: Array) -> float:
    """Geometric mean over the axes that moved of the ratio of two differences (6,)."""
    moved = (one > 0.0) & (other > 0.0)
    return float(np.exp(np.mean(np.log(one[moved] / other[moved])))) if moved.any() else 1.0
