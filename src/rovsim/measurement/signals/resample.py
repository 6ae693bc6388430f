"""Resample recorded poses to a uniform clock; long gaps stay gaps."""

from typing import Annotated, Literal, TypeAlias

import numpy as np
import scipy
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core import rotations
from rovsim.core.schema import Section
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.clock import uniform_clock, without_short
from rovsim.measurement.signals.motion import Poses
from rovsim.measurement.signals.outliers import Outliers, find_outliers

# A sample this close to a recorded frame is that frame: MoCap stamps resolve 10 microseconds.
SAME_INSTANT_S = 2e-5


class _Clock(Section):
    # Hz; None = the recording's own. A lower rate picks samples, it does not average.
    rate: float | None = Field(default=None, gt=0)
    # s: at 1 m/s2 a straight bridge is off by a h^2 / 8 = 1.3 mm over 0.1 s, about the noise
    max_gap: float = Field(default=0.1, gt=0)
    # s: shorter stretches hold not even the shortest scored window
    min_segment: float = Field(default=0.5, ge=0)


class Linear(_Clock):
    """Straight lines and constant turn rates between frames; error a h^2 / 8 (acceleration a)."""

    kind: Literal["linear"] = "linear"

    def between(self, time: Array, eta: Array, wanted: Array) -> Array:
        """Poses at the times `wanted` (m,) inside `time` (n,); `eta` (n, 7)."""
        i = np.clip(np.searchsorted(time, wanted, side="right") - 1, 0, len(time) - 2)
        part = ((wanted - time[i]) / (time[i + 1] - time[i]))[:, None]
        position = (1 - part) * eta[i, :3] + part * eta[i + 1, :3]
        turn = rotations.log(rotations.multiply(rotations.conjugate(eta[i, 3:]), eta[i + 1, 3:]))
        attitude = rotations.multiply(eta[i, 3:], rotations.exp(part * turn))
        return np.concatenate([position, attitude], axis=1)


class Pchip(_Clock):
    """Shape-preserving cubics (Fritsch & Butland 1984), which never overshoot.

    Quaternions are interpolated by components and scaled to unit length: off by less than
    h^2 (omega^2 / 16 + alpha / 8) rad, 0.06 mrad at 3 rad/s and frames h = 10 ms apart.
    """

    kind: Literal["pchip"] = "pchip"

    def between(self, time: Array, eta: Array, wanted: Array) -> Array:
        """Poses at the times `wanted` (m,) inside `time` (n,); `eta` (n, 7)."""
        return np.asarray(scipy.interpolate.PchipInterpolator(time, eta)(wanted))


Resampling: TypeAlias = Annotated[Linear | Pchip, Field(discriminator="kind")]


def resample(recording: Recording, settings: Resampling, outlier_settings: Outliers) -> Poses:
    """Put the believable frames of a recording on a uniform clock.

    The clock starts at the first believable frame and ends by the last. `usable` is False in
    gaps longer than `max_gap` and in stretches shorter than `min_segment`. A recording with
    fewer than two believable frames gives poses none of which is usable.
    """
    rate = settings.rate or recording.rate
    believed = recording.tracked & ~find_outliers(recording, outlier_settings)
    if np.count_nonzero(believed) < 2:
        return _nothing_usable(recording, rate)
    time = recording.time[believed]
    attitude = rotations.continuous(recording.attitude[believed])
    clock = uniform_clock(time[0], time[-1], rate)
    eta = settings.between(
        time, np.concatenate([recording.position[believed], attitude], axis=1), clock
    )
    eta[:, 3:] = rotations.continuous(rotations.normalized(eta[:, 3:]))
    usable = find_bridged(time, clock, settings.max_gap)
    usable = without_short(usable, round(settings.min_segment * rate))
    return Poses(recording.run, recording.site, clock, eta, usable, recording.commands)


def find_bridged(time: Array, clock: Array, max_gap: float) -> Array:
    """Whether each sample (n,) of `clock` is at a frame, or between two that are close enough.

    Args:
        time: times (m,) of the frames, s, increasing.
        clock: times (n,), s.
        max_gap: longest time between two frames that is bridged, s.
    """
    before = np.clip(np.searchsorted(time, clock + SAME_INSTANT_S, side="right") - 1, 0, None)
    after = np.clip(np.searchsorted(time, clock - SAME_INSTANT_S), None, len(time) - 1)
    return time[after] - time[before] <= max_gap + SAME_INSTANT_S


def _nothing_usable(recording: Recording, rate: float) -> Poses:
    clock = uniform_clock(recording.time[0], recording.time[-1], rate)
    eta = np.tile([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (len(clock), 1))
    usable = np.zeros(len(clock), bool)
    return Poses(recording.run, recording.site, clock, eta, usable, recording.commands)
