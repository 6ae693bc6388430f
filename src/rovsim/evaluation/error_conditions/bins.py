"""Errors by bins of a condition, and how far chance could make their means differ from zero.

Neighbouring errors resemble one another, so samples are not counted as independent: a run is cut
into stretches of several correlation times, and the stretches count. The standard error of a bin's
mean is that of a mean of clusters; the chance level comes from turning the sign of whole stretches
at random, which keeps every correlation within them, and destroys what a condition explains.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.evaluation.error_conditions.conditions import Blocks, Condition
from rovsim.results.error_conditions import BLOCK

BINS = 8  # of equal width between the tails
VISITS = 4  # stretches that must have visited a bin before it is judged
SHORTEST, LONGEST = 2.0, 10.0  # s, of a stretch
FLAT = 1e-6  # N, m, rad, s, or of them a second: less is rounding
MANY = 2000  # stretches: chance is known well by then, and memory goes with their number
NEAR = 0.6  # of a block, within which two are as far apart as a lag: a gap lies between others
TAIL = 0.03  # of all values, beyond the outer edges at either end
TIMES = 3.0  # correlation times a stretch should last


@dataclass(frozen=True, eq=False)
class Binning:
    """One condition cut into b bins: `edges` (b+1,), `center` (b,) mean of the values inside.

    `bin` (n,) of each block, `count` (b,) of blocks, `judged` (b,): visited often enough.
    """

    condition: Condition
    edges: Array
    center: Array
    bin: Array
    count: Array
    judged: Array


@dataclass(frozen=True, eq=False)
class BinnedErrors:
    """One axis by one condition, b bins: `mean`, `error` of the mean, `rms`, `effective` (b,)."""

    binning: Binning
    mean: Array
    error: Array
    rms: Array
    effective: Array
    share: float  # of the squared error that the means explain, what chance adds taken off


def number_stretches(blocks: Blocks, error: Array) -> Array:
    """Number (n,) of the stretch each block belongs to, 0 .. g-1, for errors (n,) of one axis."""
    usual = np.clip(
        TIMES * correlation_time(_unexplained(blocks, error), blocks), SHORTEST, LONGEST
    )
    length = max(float(usual), len(error) * BLOCK / MANY)
    key = np.stack([blocks.run, np.floor(blocks.time / length)], axis=1)
    return np.unique(key, axis=0, return_inverse=True)[1].ravel()


def _unexplained(blocks: Blocks, error: Array) -> Array:
    """Errors less the bin means of the two conditions that take most away: memory, not cause."""
    members = [cut(values)[1] for values in blocks.values.values()]
    for _ in range(2):
        means = [np.bincount(m, error) / np.maximum(np.bincount(m), 1) for m in members]
        fits = [mean[m] for mean, m in zip(means, members, strict=True)]
        error = error - max(fits, key=lambda fit: float(np.sum(fit**2)))
    return error


def correlation_time(error: Array, blocks: Blocks) -> float:
    """Integral of the correlation over both signs of the lag, s, up to its first zero."""
    power = float(np.mean(error**2))
    total = 1.0
    for lag in range(1, int(LONGEST / BLOCK)):
        near = np.abs(blocks.time[lag:] - blocks.time[:-lag] - lag * BLOCK) < NEAR * BLOCK
        pairs = near & (blocks.run[lag:] == blocks.run[:-lag])
        product = float(np.mean((error[lag:] * error[:-lag])[pairs])) if pairs.any() else 0.0
        if product <= 0 or power == 0:
            break
        total += 2 * product / power
    return total * BLOCK


def cut(values: Array) -> tuple[Array, Array]:
    """Edges (b+1,) of equal bins over the usual range, and the bin (n,) of each value.

    The outer bins hold whatever lies beyond; what never varied has a single bin.
    """
    low, high = np.quantile(values, [TAIL, 1.0 - TAIL])
    count = BINS if high - low > FLAT else 1
    edges = np.linspace(low, high, count + 1)
    member = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, count - 1)
    edges[0], edges[-1] = values.min(), values.max()
    return edges, member


def cut_bins(condition: Condition, values: Array, stretch: Array) -> Binning:
    """Bins of a condition, and which of them were visited often enough to be judged."""
    edges, member = cut(values)
    count = np.bincount(member, minlength=len(edges) - 1)
    visits = np.array([len(np.unique(stretch[member == b])) for b in range(len(count))])
    total = np.bincount(member, values, minlength=len(count))
    center = np.where(count > 0, total / np.maximum(count, 1), 0.5 * (edges[1:] + edges[:-1]))
    return Binning(condition, edges, center, member, count, visits >= VISITS)


def sums(binning: Binning, error: Array, stretch: Array) -> Array:
    """Sums (bins, stretches) of the errors (n,) of one axis."""
    total = np.zeros((len(binning.count), stretch.max(initial=-1) + 1))
    np.add.at(total, (binning.bin, stretch), error)
    return total


def bin_errors(binning: Binning, error: Array, stretch: Array) -> BinnedErrors:
    """Means, their standard errors and the explained share of the errors (n,) of one axis."""
    total, safe = sums(binning, error, stretch), np.maximum(binning.count, 1)
    mean = total.sum(axis=1) / safe
    size = sums(binning, np.ones(len(error)), stretch)
    visits = (size > 0).sum(axis=1)
    inflation = visits / np.maximum(visits - 1, 1)
    spread = np.sum((total - size * mean[:, None]) ** 2, axis=1) * inflation / safe**2
    square = np.bincount(binning.bin, error**2, minlength=len(safe)) / safe
    variance = np.maximum(square - mean**2, 0.0)
    alone = np.minimum(safe, variance / np.where(spread > 0, spread, np.inf))
    gained = np.sum((binning.count * (mean**2 - spread))[binning.judged])
    power = float(np.sum(error**2))
    share = max(float(gained) / power, 0.0) if power > 0 else 0.0
    return BinnedErrors(binning, mean, np.sqrt(spread), np.sqrt(square), alone, share)


def weigh_evidence(cuts: Sequence[Binning], error: Array, stretch: Array, signs: Array) -> Array:
    """How far the bin means of the errors (n,) are from zero: (c, f) of c cuts, f draws.

    The sum over bins of (sum of the errors)^2 / sum over stretches of (their sums)^2, the errors of
    every stretch under each of the `signs` (g, f): about 1 a bin by chance, up to the number of
    stretches in it. Every bin has its own scale, so that a few large errors at the end of a range
    neither make nor hide a finding.
    """
    parts = [sums(cut, error, stretch)[cut.judged] for cut in cuts]
    owner = np.repeat(np.arange(len(cuts)), [len(part) for part in parts])
    total = np.concatenate(parts)
    scale = np.sqrt(np.sum(total**2, axis=1))
    moved = scale > 0
    squares = (total[moved] / scale[moved, None] @ signs) ** 2
    found = np.zeros((len(cuts), signs.shape[1]))
    np.add.at(found, owner[moved], squares)
    return found
