"""What past innovations say about the next, where axes drive each other.

The filters of noise.py treat every axis by itself. A vehicle that always goes ahead couples some:
its sway drives its yaw, its heave its pitch (the Munk moment; Fossen 2021, Handbook of Marine Craft
Hydrodynamics and Motion Control, sections 6.3 and 8.1). There the innovations of one axis foretell
those of another, and an effect that pushes like that is taken for found. So they are whitened once
more by a vector autoregression (Luetkepohl 2005, New Introduction to Multiple Time Series Analysis,
chapter 2) within surge, heave and pitch and within sway, roll and yaw, which hardly meet.
"""

from dataclasses import dataclass
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.observer.observed_run import ObservedRun

# Readings before the present one, in growing groups whose sum counts: about a second at 20 Hz.
LAG_GROUPS = ((1, 1), (2, 2), (3, 4), (5, 8), (9, 16))
# Longitudinal and lateral, which a plane of symmetry keeps apart.
SUBSYSTEMS = ((0, 2, 4), (1, 3, 5))
# 1/s: two axes that always drive each other this fast do so within what the filters, whose
# bandwidth is about 1 Hz, take for a disturbance. A torpedo's sway and yaw: 0.6.
MIN_COUPLING = 0.4


class Stretches(NamedTuple):
    """Settled innovations of all runs, one after the other.

    `first` (n,): where the unbroken stretch of each begins; `shown` (n, 6): which axes are read.
    """

    first: Array
    shown: Array

    @staticmethod
    def of(runs: Sequence[ObservedRun]) -> "Stretches":
        """The stretches of some runs."""
        begins, masks, count = [np.empty(0, np.int64)], [np.empty((0, 6), bool)], 0
        for run in runs:
            number = np.searchsorted(
                run.innovation_segments[:, 1], np.arange(len(run.time)), side="right"
            )
            _, starts, stretch = np.unique(
                number[run.settled], return_index=True, return_inverse=True
            )
            begins.append(count + starts[stretch])
            masks.append(run.innovation_mask[run.settled])
            count += len(stretch)
        return Stretches(np.concatenate(begins), np.concatenate(masks))


@dataclass(frozen=True, eq=False)
class Autoregression:
    """What is foretold: `weights` (6, 6, g), of axis i from axis j, and `spread` (6,) of the rest.

    In units of innovations that each axis' own filter has whitened.
    """

    weights: Array
    spread: Array

    def whiten(self, z: Array, stretches: Stretches) -> Array:
        """Innovations (..., 6, n) less what their past foretells, again of unit variance."""
        out = z.astype(float)
        for axes in SUBSYSTEMS:
            for j in axes:
                for group, past in enumerate(_sum_past(z[..., j, :], stretches.first)):
                    for i in axes:
                        out[..., i, :] -= self.weights[i, j, group] * past
        return np.asarray(out * (stretches.shown.T / self.spread[:, None]), z.dtype)


def fit_autoregression(
    draws: Sequence[Array], stretches: Stretches
) -> tuple[Autoregression, float]:
    """The likeliest autoregression of innovations, and its likelihood-ratio statistic.

    Args:
        draws: innovations (6, n), whitened axis by axis; each might be the true ones.
        stretches: where they begin, and which are there.
    """
    weights, spread, lr_statistic = np.zeros((6, 6, len(LAG_GROUPS))), np.ones(6), 0.0
    for axes in SUBSYSTEMS:
        past = [np.concatenate([_sum_past(z[j], stretches.first) for j in axes]) for z in draws]
        for i in axes:
            mask = stretches.shown[:, i]
            regressors = np.concatenate([draw[:, mask] for draw in past], axis=1)
            z = np.concatenate([draw[i, mask] for draw in draws])
            if mask.sum() <= len(regressors) or not z.any():
                continue
            coefficients, *_ = np.linalg.lstsq(regressors.T, z, rcond=None)
            variance = float(np.mean((z - coefficients @ regressors) ** 2))
            weights[i, list(axes)] = coefficients.reshape(len(axes), -1)
            spread[i] = np.sqrt(variance)
            lr_statistic += float(z @ z) / len(draws) - mask.sum() * (1.0 + np.log(variance))
    return Autoregression(weights, spread), lr_statistic


def _sum_past(z: Array, first: Array) -> Array:
    """Sums (g, ..., n) of each group of readings (..., n) before, within the stretch."""
    total = np.concatenate([np.zeros((*z.shape[:-1], 1)), np.cumsum(z, axis=-1, dtype=float)], -1)
    index = np.arange(z.shape[-1])
    return np.stack(
        [
            total[..., np.maximum(index - a + 1, first)] - total[..., np.maximum(index - b, first)]
            for a, b in LAG_GROUPS
        ]
    )
