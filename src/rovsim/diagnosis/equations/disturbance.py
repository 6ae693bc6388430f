"""Estimate the force that no law explains: when and where it acted, and how fast it varies.

The whitened innovations e of an axis have unit variance. A push d on that axis, with the spectrum
S of the fitted disturbance, appears in them as H d, where H is the response of the filter. The best
estimate of d from all readings of a run, later ones included, is then S H* e at every frequency
(Wiener 1949; the smoother of the filter's own model).
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.fft import next_fast_len
from scipy.signal import find_peaks

from rovsim.core.axes import AXES
from rovsim.diagnosis.equations.spectrum import Spectrum, find_spectrum
from rovsim.diagnosis.structure.residual import AxisResidual, Structure, split_by_axis
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.kalman import AxisFilter
from rovsim.estimation.observer.observed_run import ObservedRun

# s between pushes, RMS that one stands out by, how many.
MIN_PUSH_SPACING_S, MIN_PUSH_RMS, MAX_LISTED_PUSHES = 1.0, 2.0, 8


@dataclass(frozen=True, eq=False)
class Push:
    """A moment at which the disturbance was strong on one axis.

    Attributes:
        run: id of the run.
        time: on the clock of the motion capture, s.
        axis: of the body, by name.
        force: along that axis, N or N m.
        place: (3,) of the vehicle in MoCap coordinates, m.
    """

    run: str
    time: float
    axis: str
    force: float
    place: Array


@dataclass(frozen=True, eq=False)
class ForceInTime:
    """A force that follows no law, as it acted over time.

    Attributes:
        runs: ids of the runs.
        time: (n,) of each run's readings, on the clock of the motion capture, s.
        place: (n, 3) of the vehicle in each run, in MoCap coordinates, m.
        force: wrench (n, 6) of each run along the body axes (FRD), N and N m.
        axes: on which the force is more than noise.
        rms: (6,) of the wrench over all runs, N and N m.
        spectrum: of the wrench.
        band: lowest and highest frequency of most of its power on the strongest axis, Hz.
        pushes: moments at which it was strong, the strongest first.
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
    """Estimate the force that a fit leaves; None if no axis with structure was read throughout.

    Args:
        fit: whose whitened innovations are smoothed.
        bank: the runs that it was fitted to, with their filters.
        structures: what was found in the innovations, and on which axes.
    """
    residuals = {x.axis: x for x in split_by_axis(fit, bank)}
    with_structure = {x.axis for x in structures}
    axes = tuple(a for a in AXES if a in residuals and a in with_structure)
    if not axes:
        return None
    M, correlation_time = fit.hypothesis.model.M, fit.noise.correlation_time
    forces = []
    for k, run in enumerate(bank.runs):
        a = np.zeros((len(run.time), 6))
        for i, axis in enumerate(AXES):
            if axis in residuals:
                residual = residuals[axis]
                std, lasts = residual.disturbance_std, float(correlation_time[i])
                a[:, i] = smooth(residual.white[k], residual.filters[k], run, std, lasts)
        forces.append(a @ M.T)
    return _gather(bank.runs, forces, axes, residuals)


def smooth(white: Array, f: AxisFilter, run: ObservedRun, std: float, lasts: float) -> Array:
    """Estimate the push on one axis at all readings of a run.

    Args:
        white: whitened settled innovations (m,) of that axis.
        f: the filter that whitened them.
        run: the run.
        std: of the disturbance, m/s2 or rad/s2.
        lasts: correlation time of the disturbance, s.

    Returns:
        Accelerations (n,), m/s2 or rad/s2. Innovations that have not settled count as 0.
    """
    e, out = np.zeros(len(run.time)), np.zeros(len(run.time))
    e[run.settled] = white
    for begin, end in run.innovation_segments:
        out[begin:end] = smooth_stretch(e[begin:end], f, run.period, std, lasts)
    return out


def smooth_stretch(e: Array, f: AxisFilter, period: float, std: float, lasts: float) -> Array:
    """Estimate the push on one axis in a stretch without gaps: S H* e at every frequency.

    Args:
        e: whitened innovations (n,) of the stretch.
        f: the filter that whitened them.
        period: between two readings, s.
        std: of the disturbance, m/s2 or rad/s2.
        lasts: correlation time of the disturbance, s.

    Returns:
        Accelerations (n,), m/s2 or rad/s2.
    """
    count = next_fast_len(2 * len(e))  # zero padding: the FFT is periodic
    z = np.exp(2j * np.pi * np.fft.rfftfreq(count))
    fade = np.exp(-period / lasts)
    spectrum = std**2 * (1.0 - fade**2) / np.abs(1.0 - fade / z) ** 2
    smoother = spectrum * np.conj(f.respond_at(z))
    return np.fft.irfft(smoother * np.fft.rfft(e, count), count)[: len(e)]


def _gather(
    runs: Sequence[ObservedRun],
    forces: Sequence[Array],
    axes: tuple[str, ...],
    residuals: dict[str, AxisResidual],
) -> ForceInTime:
    """Gather the wrenches (n, 6) of all runs, and what characterises them.

    Args:
        runs: the runs.
        forces: wrench (n, 6) of each run, N and N m.
        axes: on which the force is more than noise.
        residuals: what the fit left on each axis, by the name of the axis.
    """
    total = np.concatenate(forces)
    rms = np.sqrt(np.mean(total**2, axis=0))
    index = [AXES.index(a) for a in axes]
    places = [run.motion.state[run.innovation_samples, :3] * run.motion.site.axes for run in runs]
    strongest = max(index, key=lambda i: rms[i] / _find_acceleration_std(residuals[AXES[i]], runs))
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


def _find_acceleration_std(residual: AxisResidual, runs: Sequence[ObservedRun]) -> float:
    """Standard deviation of an axis' acceleration: the unit that makes axes comparable."""
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
    """List the moments at which the force was strongest, in units of the RMS of its axis.

    Args:
        runs: the runs.
        forces: wrench (n, 6) of each run, N and N m.
        places: (n, 3) of the vehicle in each run, in MoCap coordinates, m.
        index: numbers of the axes on which the force is more than noise.
        rms: (6,) of the wrench over all runs, N and N m.
    """
    ranked: list[tuple[float, Push]] = []
    for run, force, place in zip(runs, forces, places, strict=True):
        for i in index:
            size = np.abs(force[:, i]) / max(rms[i], 1e-12)
            peaks, _ = find_peaks(
                size,
                height=MIN_PUSH_RMS,
                distance=max(1, round(MIN_PUSH_SPACING_S / run.period)),
            )
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
    return [push for _, push in ranked[:MAX_LISTED_PUSHES]]
