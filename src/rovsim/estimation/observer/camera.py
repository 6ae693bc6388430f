"""Does the software of the motion capture smooth the poses that it reports?

Where it does, the noise of the cameras falls off at high frequencies as the software's filter does,
and the frequency at which that begins is the cutoff. Camera errors that last several frames fall
off as well, and so do frames that were interpolated, but with another shape than two equal
first-order low-passes. A filter is only reported if none of these kinds of noise is as likely.
"""

from dataclasses import dataclass
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import minimize_scalar

from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.camera_noise import (
    NOISE_KINDS,
    NoiseKind,
    NoiseSpectrum,
    measure_spectra,
)
from rovsim.estimation.observer.observed_run import ObservedRun

MIN_LR_OF_FILTER = 30.0  # odds of a million to one, for no effect depends on it
MAX_RELATIVE_STD = 0.15  # of the cutoff: software at 6 Hz is known to 0.03 of it in four minutes
MIN_CUTOFF_HZ, MAX_CUTOFF_SHARE = 0.5, 0.5  # the share is of the highest frequency there is
CUTOFFS_TRIED = 24  # cutoffs between these, a fifth apart
LOG_CUTOFF_STEP = 0.05  # of the logarithm, for the curvature
END_SHARE = 0.98  # of the highest cutoff tried: where the search stops at its end, it found none
OPEN_STDS = 3.0  # of the cutoff to either side, within which it is left open
# Of the cutoff, left open in any case: behind stamps that are off by 2 ms it is found 7 % too high.
OPEN_CUTOFF_SHARE = 0.1


@dataclass(frozen=True)
class Smoothing:
    """The filter of the motion capture's software: two equal first-order low-passes.

    Attributes:
        cutoff: in Hz, as it is known now.
        std: standard deviation of the cutoff, Hz.
        lr_statistic: likelihood-ratio statistic of the filter, against no filter.
        noise_cutoff: the cutoff in Hz that the noise of the poses gives by itself.
        lowest: the lowest cutoff in Hz that is possible, whatever the kind of that noise.
        highest: likewise the highest, Hz.
        frame: time from one pose to the next, s.
        latency: further delay of the reported poses, s (as of a `PoseFilter`).
    """

    cutoff: float
    std: float
    lr_statistic: float
    noise_cutoff: float
    lowest: float
    highest: float
    frame: float
    latency: float = 0.0

    @property
    def effect(self) -> PoseFilter:
        """The filter as an effect of a model."""
        return PoseFilter(cutoff=self.cutoff, latency=self.latency)

    def is_near(self, other: "Smoothing") -> bool:
        """Whether two cutoffs are the same within what noise of an unknown kind can tell."""
        return abs(self.cutoff - other.cutoff) < OPEN_CUTOFF_SHARE * other.cutoff


def find_smoothing(base: Model, runs: Sequence[ObservedRun]) -> Smoothing | None:
    """The filter that the poses of these runs went through; None where they show none.

    Args:
        base: the model that is diagnosed; what it already says of the cameras is taken as given.
        runs: the runs, of which those recorded by motion capture count.
    """
    spectra = measure_spectra(base, runs)
    return fit_smoothing(spectra) if spectra else None


def fit_smoothing(spectra: Sequence[NoiseSpectrum]) -> Smoothing | None:
    """The filter that the noise in these spectra went through; None where they show none."""
    highest = MAX_CUTOFF_SHARE * min(float(s.frequency[-1]) for s in spectra)
    cutoffs = np.geomspace(MIN_CUTOFF_HZ, highest, CUTOFFS_TRIED)
    costs = np.array([[_cost(spectra, kind, cutoff) for cutoff in cutoffs] for kind in NOISE_KINDS])
    minima = [
        _refine(spectra, kind, cutoffs, kind_costs)
        for kind, kind_costs in zip(NOISE_KINDS, costs, strict=True)
    ]
    least_cost, cutoff, std = min(minima)
    unfiltered = min(_cost(spectra, kind, None) + _penalty(spectra, kind) for kind in NOISE_KINDS)
    lr_statistic = unfiltered - least_cost
    # A cutoff far below the band that is examined would only make the motion itself fall off more
    # steeply, as it also does where a vehicle tumbles. The cutoff is then hardly determined.
    if (
        lr_statistic < MIN_LR_OF_FILTER
        or cutoff > END_SHARE * highest
        or not std < MAX_RELATIVE_STD * cutoff
    ):
        return None
    plausible = cutoffs[costs.min(axis=0) < costs.min() + OPEN_STDS**2]
    margin = max(OPEN_STDS * std, OPEN_CUTOFF_SHARE * cutoff)
    lowest, highest = min(cutoff - margin, plausible[0]), max(cutoff + margin, plausible[-1])
    frame = max(s.period for s in spectra)
    return Smoothing(cutoff, std, lr_statistic, cutoff, float(lowest), float(highest), frame)


class _LikelyCutoff(NamedTuple):
    """A cutoff in Hz with its standard deviation; `cost` includes the penalty of the noise."""

    cost: float
    cutoff: float
    std: float


def _cost(spectra: Sequence[NoiseSpectrum], kind: NoiseKind, cutoff: float | None) -> float:
    return sum(s.cost(kind, cutoff) for s in spectra)


def _penalty(spectra: Sequence[NoiseSpectrum], kind: NoiseKind) -> float:
    return sum(s.penalty(kind) for s in spectra)


def _refine(
    spectra: Sequence[NoiseSpectrum], kind: NoiseKind, tried: Array, costs: Array
) -> _LikelyCutoff:
    """The likeliest cutoff near the best of those that were tried (t,), for one kind of noise."""

    def cost(x: float) -> float:
        return _cost(spectra, kind, float(np.exp(x)))

    at = int(np.argmin(costs))
    bracket = np.log(tried[[max(at - 1, 0), min(at + 1, len(tried) - 1)]])
    minimum = minimize_scalar(cost, bounds=bracket, method="bounded", options={"xatol": 1e-3})
    x, least_cost = float(minimum.x), float(minimum.fun)
    sides = cost(x + LOG_CUTOFF_STEP) + cost(x - LOG_CUTOFF_STEP)
    curvature = 0.5 * (sides - 2.0 * least_cost) / LOG_CUTOFF_STEP**2
    cutoff = float(np.exp(x))
    std = cutoff / np.sqrt(curvature) if curvature > 0.0 else np.inf
    return _LikelyCutoff(least_cost + _penalty(spectra, kind), cutoff, float(std))
