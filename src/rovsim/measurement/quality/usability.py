"""Whether a recording can be used, and if not, why."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import usual_range
from rovsim.core.rotations import conjugate, log, multiply
from rovsim.measurement.quality.velocity_conventions import find_impossible
from rovsim.measurement.recording.recording import Recording

MIN_RUN_S = 2.0  # one scoring window
# A body at rest stays well inside these: MoCap noise spreads over a few mm and about 0.01 rad, a
# manoeuvring vehicle over decimetres within seconds.
REST_POSITION_SPREAD, REST_ATTITUDE_SPREAD = 0.01, 0.02  # m, rad


def usable_reason(recording: Recording) -> str | None:
    """Say why a recording cannot be used, or None when it can.

    Without full poses only its length and the size of its velocities are checked.
    """
    tracked = recording.tracked
    if too_fast := find_impossible(recording):
        return too_fast
    if not recording.posed:
        length = float(np.ptp(recording.time))
        reason = f"too short: it lasts {length:.2f} s, {MIN_RUN_S:g} needed"
        return reason if length < MIN_RUN_S else None
    tracked_s = float(np.sum(tracked)) / recording.rate
    duration = float(np.ptp(recording.time[tracked])) if tracked.any() else 0.0
    if min(tracked_s, duration) < MIN_RUN_S:
        return (
            f"too short: the body was seen for {min(tracked_s, duration):.2f} s, "
            f"{MIN_RUN_S:g} needed"
        )
    position = _spread(recording.position[tracked])
    attitude = _spread(_turns(recording.attitude[tracked]))
    if position < REST_POSITION_SPREAD and attitude < REST_ATTITUDE_SPREAD:
        return f"motionless: it stays within {1e3 * position:.1f} mm and {attitude:.3f} rad"
    return None


def _turns(attitude: Array) -> Array:
    """Rotation vectors (n, 3), rad, from the first attitude to each of n."""
    return log(multiply(conjugate(attitude[:1]), attitude))


def _spread(values: Array) -> float:
    """Largest range over the columns, without the outer 1 % at either end (outlier frames)."""
    low, high = usual_range(values)
    return float(np.max(high - low))
