"""Where no law holds: the force in time that is left, where and when it acted, and how fast it is.

The innovations of an axis are white, and a push d with the spectrum S of the fitted disturbance
shows in them as H d. The best estimate of it from all of a run, later readings included, is then
S H* e at every frequency (Wiener 1949; the smoother of the filter's own model).
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.fft import next_fast_len
from scipy.signal import find_peaks

from rovsim import AXES
from rovsim.diagnosis.equations.spectrum import Spectrum, find_spectrum
from rovsim.diagnosis.structure.residual import AxisResidual, Structure, split_by_axis
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.kalman import AxisFilter
from rovsim.estimation.observer.observed_run import ObservedRun

APART, STRONG, LISTED = 1.0, 2.0, 8  # s between pushes, RMS that one stands out by, how many


@dataclass(frozen=True, eq=False)
class Push:
    """A moment at which the disturbance was strong: N, N m on one axis, at a place (3,) MoCap m."""

    run: str
    time: float
    axis: str
    force: float
    place: Array


@dataclass(frozen=True, eq=False)
class ForceInTime:
    """What pushes and follows no law.

    `runs` and their `time` (n,) s on the clock of the motion capture, `place` (n, 3) MoCap m and
    `force` (n, 6) N, N m along the body;
    `axes` on which it is more than noise; `rms` (6,); its `spectrum`, and the `band` Hz that holds
    most of its power on the strongest of these; `pushes`, the strongest first.
    """

    runs: tuple[str, ...]
    time: tuple[Array, ...]
    place: tuple[Array, ...]
    force: tuple[Array, ...]
    axes: tuple[str, ...]
    rms: Array
    spectrum: Spectrum
    band: tuple[float, float]
    pushes: tuple[Push, ...]


def trace_force(fit: Fit, bank: FilterBank, structures: Sequence[Structure]) -> ForceInTime | None:
    """The smooth force that is left; None where its axes were not read throughout."""
    residuals = {one.axis: one for one in split_by_axis(fit, bank)}
    named = {one.axis for one in structures}
    axes = tuple(a for a in AXES if a in residuals and a in named)
    if not axes:
        return None
    M, correlation_time = fit.hypothesis.model.M, fit.noise.correlation_time
    forces = []
    for k, run in enumerate(bank.runs):
        a = np.zeros((len(run.time), 6))
        for i, axis in enumerate(AXES):
            if axis in residuals:
                own = residuals[axis]
                std, lasts = own.disturbance_std, float(correlation_time[i])
                a[:, i] = smooth(own.white[k], own.filters[k], run, std, lasts)
        forces.append(a @ M.T)
    return _gather(bank.runs, forces, axes, residuals)


def smooth(white: Array, f: AxisFilter, run: ObservedRun, std: float, lasts: float) -> Array:
    """Acceleration (n,) at the readings of a run, of its settled whitened innovations (m,).

    Args:
        white: the innovations.
        f: the filter that made them.
        run: where.
        std: of the disturbance.
        lasts: its correlation time, s.
    """
    e, out = np.zeros(len(run.time)), np.zeros(len(run.time))
    e[run.settled] = white
    for first, last in run.innovation_segments:
        out[first:last] = smooth_stretch(e[first:last], f, run.period, std, lasts)
    return out


def smooth_stretch(e: Array, f: AxisFilter, period: float, std: float, lasts: float) -> Array:
    """Acceleration (n,) that an unbroken stretch of whitened innovations (n,) tells of."""
    count = next_fast_len(2 * len(e))  # so that the end does not meet the beginning
    z = np.exp(2j * np.pi * np.fft.rfftfreq(count))
    b, a = f.response
    fade = np.exp(-period / lasts)
    spectrum = std**2 * (1.0 - fade**2) / np.abs(1.0 - fade / z) ** 2
    response = np.polyval(b, z) / np.polyval(a, z)
    return np.fft.irfft(spectrum * np.conj(response) * np.fft.rfft(e, count), count)[: len(e)]


def _gather(
    runs: Sequence[ObservedRun],
    forces: Sequence[Array],
    axes: tuple[str, ...],
    residuals: dict[str, AxisResidual],
) -> ForceInTime:
    whole = np.concatenate(forces)
    rms = np.sqrt(np.mean(whole**2, axis=0))
    index = [AXES.index(a) for a in axes]
    places = [run.motion.state[run.innovation_samples, :3] * run.motion.site.axes for run in runs]
    strongest = max(index, key=lambda i: rms[i] / _usual(residuals[AXES[i]], runs))
    spectrum = find_spectrum(forces, runs[0].period)
    return ForceInTime(
        tuple(run.motion.run.id for run in runs),
        tuple(map(_tell_time, runs)),
        tuple(places),
        tuple(forces),
        axes,
        rms,
        spectrum,
        spectrum.find_band(strongest),
        tuple(_find_pushes(runs, forces, places, index, rms)),
    )


def _tell_time(run: ObservedRun) -> Array:
    """Time (n,) of the readings on the clock of the motion capture, s."""
    return np.asarray(run.edges[0] + run.time)


def _usual(residual: AxisResidual, runs: Sequence[ObservedRun]) -> float:
    """How much the axis accelerates in these runs, so that forces and moments compare."""
    i = AXES.index(residual.axis)
    nu_dot = np.concatenate([run.motion.nu_dot[run.motion.usable, i] for run in runs])
    return max(float(np.nanstd(nu_dot)), 1e-9)


def _find_pushes(
    runs: Sequence[ObservedRun],
    forces: Sequence[Array],
    places: Sequence[Array],
    index: Sequence[int],
    rms: Array,
) -> list[Push]:
    """The strongest, in units of the RMS of their axis."""
    ranked: list[tuple[float, Push]] = []
    for run, force, place in zip(runs, forces, places, strict=True):
        for i in index:
            size = np.abs(force[:, i]) / max(rms[i], 1e-12)
            peaks, _ = find_peaks(size, height=STRONG, distance=max(1, round(APART / run.period)))
            ranked += [
                (
                    float(size[k]),
                    Push(
                        run.motion.run.id,
                        float(_tell_time(run)[k]),
                        AXES[i],
                        float(force[k, i]),
                        place[k],
                    ),
                )
                for k in peaks
            ]
    ranked.sort(key=lambda one: -one[0])
    return [push for _, push in ranked[:LISTED]]
