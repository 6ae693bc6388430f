"""From a recording to a motion: outliers, resampling, filter, derivatives.

Recordings with exported velocities, which are bin means, pass the first two stages unchanged.
"""

from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy import ndarray as Array

from rovsim.core.array_files import read_arrays
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.binned import bin_motion
from rovsim.measurement.signals.clock import find_stretches, time_step, without_margins
from rovsim.measurement.signals.differentiate import (
    Differentiation,
    Spline,
    differentiate_eta,
)
from rovsim.measurement.signals.filter import (
    Butterworth,
    Filter,
    filter_eta,
    filter_poses,
)
from rovsim.measurement.signals.measured import MAX_CUTOFF_SHARE, blank
from rovsim.measurement.signals.motion import Motion, Poses
from rovsim.measurement.signals.outliers import OutlierSettings
from rovsim.measurement.signals.resample import Linear, Resampling, resample
from rovsim.measurement.signals.track import track_channels

# The result of the first two stages: poses, or a binned recording that passes unchanged.
Stage: TypeAlias = Poses | Recording


class SignalSettings(OutlierSettings):
    """Settings of the whole chain: one section a step, with a `kind` and the keys of that kind."""

    resample: Resampling = Linear()
    filter: Filter = Butterworth()
    differentiate: Differentiation = Spline()

    def suited(self, motion: Poses | Motion) -> "SignalSettings":
        """Lower the filter's cut-off to what the sampling of a run can show.

        That is `Measured.cutoff` where only some channels were measured (the margin at the ends of
        stretches then grows with the period of the cut-off), otherwise `MAX_CUTOFF_SHARE` of the
        sampling rate. Binned motions are not filtered: for them nothing changes.
        """
        if motion.measured is None:
            return self._below_sampling(motion)
        cutoff = float(motion.measured.cutoff[0])
        margin = max(self.differentiate.margin, 0.5 / cutoff)  # half a period, as by default
        return self.model_copy(
            update={
                "filter": self.filter.below(cutoff),
                "differentiate": self.differentiate.model_copy(update={"margin": margin}),
            }
        )

    def _below_sampling(self, motion: Poses | Motion) -> "SignalSettings":
        if len(motion.time) < 2 or (isinstance(motion, Motion) and motion.binned):
            return self
        highest = MAX_CUTOFF_SHARE / time_step(motion.time)
        return self.model_copy(update={"filter": self.filter.below(highest)})

    @property
    def reach(self) -> float:
        """Time in s to either side over which poses affect a velocity; near an end it is worse."""
        return self.filter.reach + self.differentiate.margin


def clean(recording: Recording, settings: SignalSettings) -> Motion:
    """Turn a recording into a motion.

    Raises:
        BadInput: the settings do not suit the recording's rate, or a binned one is too short.
    """
    return differentiated(filtered(resampled(recording, settings), settings), settings)


def resampled(recording: Recording, settings: SignalSettings) -> Stage:
    """Carry out the first stage: poses on a uniform clock, or a binned recording unchanged.

    Raises:
        BadInput: nothing of the motion was measured.
    """
    if not recording.posed:
        return track_channels(recording, settings.resample)
    if recording.nu is not None:
        return recording
    return resample(recording, settings.resample, settings.outliers)


def filtered(stage: Stage, settings: SignalSettings) -> Stage:
    """Carry out the second stage: filter poses; a binned recording passes unchanged."""
    if isinstance(stage, Recording):
        return stage
    return filter_poses(stage, settings.suited(stage).filter)


def differentiated(stage: Stage, settings: SignalSettings) -> Motion:
    """Carry out the third stage: turn filtered poses or a binned recording into a motion."""
    if isinstance(stage, Recording):
        return _at_level(bin_motion(stage))
    return _at_level(differentiate_poses(stage, settings))


def _at_level(motion: Motion) -> Motion:
    """Set `site.level`, the depth where a floating vehicle is at rest, to the median depth."""
    if not motion.usable.any():
        return motion
    level = float(np.median(motion.eta[motion.usable, 2]))
    return replace(motion, site=replace(motion.site, level=level))


def read_stage(path: Path) -> Stage:
    """Read the result of the first or second stage from a file: poses or a binned recording."""
    return Recording.read(path) if "found" in read_arrays(path) else Poses.read(path)


def differentiate_poses(poses: Poses, settings: SignalSettings) -> Motion:
    """Differentiate filtered poses to body velocities and accelerations.

    Both are NaN where poses are not usable, and zero in axes that were not measured. `margin`
    seconds at either end of every stretch are not usable any more.
    """
    nu = np.full((len(poses.time), 6), np.nan)
    nu_dot = nu.copy()
    dt = time_step(poses.time) if len(poses.time) > 1 else 1.0
    for start, end in find_stretches(poses.usable):
        nu[start:end], nu_dot[start:end] = differentiate_eta(
            poses.eta[start:end], dt, settings.differentiate
        )
    margin = settings.suited(poses).differentiate.margin
    usable = without_margins(poses.usable, round(margin / dt))
    usable &= np.isfinite(nu).all(axis=1)
    nu, nu_dot = blank(poses.measured, nu, 0.0), blank(poses.measured, nu_dot, 0.0)
    return Motion(
        poses.run,
        poses.site,
        poses.time,
        poses.eta,
        nu,
        nu_dot,
        nu,
        usable,
        poses.commands,
        binned=False,
        end=float(poses.time[-1]),
        measured=poses.measured,
    )


def filter_and_differentiate(
    eta: Array, dt: float, settings: SignalSettings
) -> tuple[Array, Array]:
    """Body velocity and acceleration (..., n, 6) of model poses (..., n, 7), `dt` s apart.

    Filter and derivative are those that the measurement went through. Quaternions must be
    sign-continuous.

    Raises:
        BadInput: the filter cannot work at this sampling rate.
    """
    smooth = filter_eta(eta, dt, settings.filter)
    return differentiate_eta(smooth, dt, settings.differentiate)
