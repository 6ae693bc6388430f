"""Zero-phase low-pass filters for poses. Measurement and model go through the same one."""

from dataclasses import replace
from typing import Annotated, Literal, TypeAlias

import numpy as np
import scipy
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core import rotations
from rovsim.core.errors import BadInput
from rovsim.core.schema import Section
from rovsim.measurement.signals.clock import find_stretches, time_step
from rovsim.measurement.signals.motion import Poses

# The extension at either end and the stretch its parabola is fitted to, in periods of the cut-off
# frequency. Four periods let the filter settle (below 1e-6 at order 3). A longer fit is calmer but
# misses more of the motion; half a period balances 0.5 mm of noise and 1 m/s of 1 Hz motion.
EXTENSION_PERIODS, FIT_PERIODS = 4.0, 0.5
# What lies two periods away or more adds less than 1e-3 to a smoothed sample (order 3).
REACH_PERIODS = 2.0
HALF_POWER_PRODUCT = 1.45  # Hz s: half-power frequency times window of Savitzky-Golay at degree 3


class Butterworth(Section):
    """Butterworth low-pass, forwards and backwards: gain 1 / (1 + (f / cutoff)^(2 order)).

    Either end is first continued by a parabola fitted to the last samples, so that a motion of
    constant acceleration passes unchanged up to its ends, also in a window of half a second.
    (The usual reflection turns the acceleration round there and drives it to zero.)
    """

    kind: Literal["butterworth"] = "butterworth"
    # Hz: the vehicle moves below 2 Hz (gain there 0.996 at order 3); of 0.5 mm and 2 mrad noise
    # at 100 Hz, 2.5 mm/s and 10 mrad/s are left in the velocities
    cutoff: float = Field(default=5.0, gt=0)
    order: int = Field(default=3, ge=2, le=6)

    def below(self, cutoff: float) -> "Butterworth":
        """This filter with its cut-off limited to that many Hz."""
        return self.model_copy(update={"cutoff": min(self.cutoff, cutoff)})

    @property
    def reach(self) -> float:
        """Time in s to either side over which samples affect a smoothed one."""
        return REACH_PERIODS / self.cutoff

    def smoothed(self, x: Array, dt: float) -> Array:
        """Filter `x` (..., time, channels), `dt` s apart.

        Raises:
            BadInput: the cut-off is not below half the sampling rate.
        """
        if 2.0 * self.cutoff * dt >= 1.0:
            raise BadInput(
                f"cutoff {self.cutoff:g} Hz at {1 / dt:g} samples/s",
                where="filter",
                expected=f"a cutoff below {0.5 / dt:g} Hz",
                remedy="Lower signals.filter.cutoff or raise signals.resample.rate.",
            )
        period = 1.0 / (self.cutoff * dt)
        pad = round(EXTENSION_PERIODS * period)
        extended = _continued(x, pad, max(round(FIT_PERIODS * period), 5))
        sos = scipy.signal.butter(self.order, self.cutoff, fs=1.0 / dt, output="sos")
        forward = _one_way(sos, extended)
        back = _one_way(sos, forward[..., ::-1, :])[..., ::-1, :]
        return back[..., pad : pad + x.shape[-2], :]


class SavitzkyGolay(Section):
    """Least-squares polynomials in a sliding window (Savitzky & Golay 1964).

    Polynomials up to `degree` pass unchanged, the ends included.
    """

    kind: Literal["savgol"] = "savgol"
    # s: half-power at 5 Hz with degree 3 (Schafer 2011, IEEE Signal Process. Mag. 28(4), eq. 12)
    window: float = Field(default=0.29, gt=0)
    degree: int = Field(default=3, ge=1, le=5)

    def below(self, cutoff: float) -> "SavitzkyGolay":
        """This filter with a window long enough for a half-power frequency of at most that (Hz)."""
        wider = max(1.0, HALF_POWER_PRODUCT / (self.window * cutoff))
        return self.model_copy(update={"window": self.window * wider})

    @property
    def reach(self) -> float:
        """Time in s to either side over which samples affect a smoothed one."""
        return 0.5 * self.window

    def smoothed(self, x: Array, dt: float) -> Array:
        """Filter `x` (..., time, channels), `dt` s apart; short series get a shorter window."""
        width = odd_window(self.window, dt, x.shape[-2])
        if width <= self.degree:
            return x
        return scipy.signal.savgol_filter(x, width, self.degree, axis=-2, mode="interp")


class Unfiltered(Section):
    """No filter."""

    kind: Literal["none"] = "none"

    def below(self, cutoff: float) -> "Unfiltered":
        """This filter, which has no cut-off to limit."""
        return self

    @property
    def reach(self) -> float:
        """Time in s to either side over which samples affect a smoothed one: none."""
        return 0.0

    def smoothed(self, x: Array, dt: float) -> Array:
        """Return `x` unchanged."""
        return x


Filter: TypeAlias = Annotated[Butterworth | SavitzkyGolay | Unfiltered, Field(discriminator="kind")]


def filter_eta(eta: Array, dt: float, settings: Filter) -> Array:
    """Filter poses (..., time, 7) of one stretch each, `dt` s apart.

    Quaternions must be sign-continuous; they are filtered by components and scaled back to unit
    length, which for a steady turn is exact.

    Raises:
        BadInput: the filter cannot work at this sampling rate.
    """
    smooth = np.array(settings.smoothed(np.asarray(eta, dtype=float), dt))
    smooth[..., 3:] = rotations.normalized(smooth[..., 3:])
    return smooth


def filter_poses(poses: Poses, settings: Filter) -> Poses:
    """Filter every usable stretch by itself; the rest stays as it is.

    Raises:
        BadInput: the filter cannot work at this sampling rate.
    """
    eta = poses.eta.copy()
    for start, end in find_stretches(poses.usable):
        eta[start:end] = filter_eta(poses.eta[start:end], time_step(poses.time), settings)
    return replace(poses, eta=eta)


def odd_window(seconds: float, dt: float, available: int) -> int:
    """Odd number of samples nearest to `seconds`, at most `available`."""
    width = 2 * round(0.5 * seconds / dt - 0.5) + 1
    return max(1, min(width, available if available % 2 else available - 1))


def _one_way(sos: Array, x: Array) -> Array:
    """Filter `x` (..., time, channels) forwards, starting from the steady state of a constant x[0].

    Args:
        sos: second-order sections (sections, 6), as `scipy.signal.butter` gives them.
        x: the series.
    """
    zi = scipy.signal.sosfilt_zi(sos)  # (sections, 2)
    x = np.moveaxis(x, -2, -1)
    state = zi.reshape(len(sos), *[1] * (x.ndim - 1), 2) * x[..., :1]
    return np.moveaxis(scipy.signal.sosfilt(sos, x, axis=-1, zi=state)[0], -1, -2)


def _continued(x: Array, pad: int, fit: int) -> Array:
    """Extend `x` (..., time, channels) by `pad` samples at either end, along fitted parabolas.

    Each parabola is the least-squares fit to the `fit` samples at that end.
    """
    fit = min(fit, x.shape[-2])
    inside = np.arange(fit) / fit
    outside = -np.arange(pad, 0, -1) / fit
    degree = min(2, fit - 1)
    # (pad, fit): the least-squares parabola through the first samples, before the first
    ahead = np.vander(outside, degree + 1) @ np.linalg.pinv(np.vander(inside, degree + 1))
    before = ahead @ x[..., :fit, :]
    after = (ahead @ x[..., : -fit - 1 : -1, :])[..., ::-1, :]
    return np.concatenate([before, x, after], axis=-2)
