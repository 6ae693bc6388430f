"""Average errors in bins of a condition, and tell how far their means differ from zero by chance.

Neighbouring errors are correlated, so blocks are not independent. A run is cut into stretches of
several correlation times, and these count as independent. The standard error of a bin's mean is
that of a mean of clusters. What chance explains is found by changing the sign of whole stretches at
random: that keeps every correlation within them, and destroys what a condition explains.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.evaluation.error_conditions.conditions import Blocks, Condition
from rovsim.results.error_conditions import BLOCK_S

BIN_COUNT = 8  # of equal width between the tails
MIN_VISITS = 4  # stretches that a bin needs to be judged
MIN_STRETCH_S, MAX_STRETCH_S = 2.0, 10.0  # length of a stretch
# in the unit of the condition: one that varies less varies by rounding alone
MIN_VALUE_RANGE = 1e-6
MAX_STRETCHES = 2000  # they are enough to know chance, and need memory
# of a block: two blocks whose distance differs more from a lag have a gap between them
MAX_LAG_DEVIATION = 0.6
TAIL_SHARE = 0.03  # share of all values beyond the outer edges, at either end
STRETCH_CORRELATION_TIMES = 3.0  # correlation times that a stretch should last


@dataclass(frozen=True, eq=False)
class Binning:
    """A condition that is cut into b bins.

    Attributes:
        condition: the condition.
        edges: of the bins (b + 1,), in its unit.
        center: mean (b,) of the values inside of each bin.
        bin: index (n,) of the bin of each block.
        count: number of blocks (b,) in each bin.
        judged: mask (b,) of the bins with blocks of enough stretches.
    """

    condition: Condition
    edges: Array
    center: Array
    bin: Array
    count: Array
    judged: Array


@dataclass(frozen=True, eq=False)
class BinnedErrors:
    """Errors of one axis in b bins of a condition, m/s2 or rad/s2.

    Attributes:
        binning: the bins.
        mean: of the errors (b,).
        error: standard error of that mean (b,).
        rms: of the errors (b,).
        effective: number of blocks (b,), as if they were independent.
        share: of the squared error that the means explain, without what chance adds.
    """

    binning: Binning
    mean: Array
    error: Array
    rms: Array
    effective: Array
    share: float


def number_stretches(blocks: Blocks, error: Array) -> Array:
    """Cut runs into g stretches, each several correlation times of the errors long.

    Args:
        blocks: n blocks of all runs.
        error: of one axis (n,).

    Returns:
        Number of the stretch, 0 to g - 1, to which each block belongs (n,).
    """
    typical = np.clip(
        STRETCH_CORRELATION_TIMES * correlation_time(_unexplained(blocks, error), blocks),
        MIN_STRETCH_S,
        MAX_STRETCH_S,
    )
    length = max(float(typical), len(error) * BLOCK_S / MAX_STRETCHES)
    key = np.stack([blocks.run, np.floor(blocks.time / length)], axis=1)
    return np.unique(key, axis=0, return_inverse=True)[1].ravel()


def _unexplained(blocks: Blocks, error: Array) -> Array:
    """Subtract from errors (n,) the bin means of the two conditions that explain most.

    What a condition explains is correlated for as long as the condition lasts; the correlation time
    of the rest is wanted.
    """
    members = [cut(values)[1] for values in blocks.values.values()]
    for _ in range(2):
        means = [np.bincount(m, error) / np.maximum(np.bincount(m), 1) for m in members]
        fits = [mean[m] for mean, m in zip(means, members, strict=True)]
        error = error - max(fits, key=lambda fit: float(np.sum(fit**2)))
    return error


def correlation_time(error: Array, blocks: Blocks) -> float:
    """Correlation time of errors (n,) in s: integral of the correlation up to its first zero.

    The integral includes negative lags.
    """
    power = float(np.mean(error**2))
    total = 1.0
    for lag in range(1, int(MAX_STRETCH_S / BLOCK_S)):
        lagged = (
            np.abs(blocks.time[lag:] - blocks.time[:-lag] - lag * BLOCK_S)
            < MAX_LAG_DEVIATION * BLOCK_S
        )
        pairs = lagged & (blocks.run[lag:] == blocks.run[:-lag])
        product = float(np.mean((error[lag:] * error[:-lag])[pairs])) if pairs.any() else 0.0
        if product <= 0 or power == 0:
            break
        total += 2 * product / power
    return total * BLOCK_S


def cut(values: Array) -> tuple[Array, Array]:
    """Cut values (n,) into bins of equal width over their usual range.

    The outer bins include all that lies beyond. Values that do not vary have a single bin.

    Returns:
        Edges (b + 1,), and the index (n,) of the bin of each value.
    """
    low, high = np.quantile(values, [TAIL_SHARE, 1.0 - TAIL_SHARE])
    count = BIN_COUNT if high - low > MIN_VALUE_RANGE else 1
    edges = np.linspace(low, high, count + 1)
    member = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, count - 1)
    edges[0], edges[-1] = values.min(), values.max()
    return edges, member


def cut_bins(condition: Condition, values: Array, stretch: Array) -> Binning:
    """Cut a condition into bins, and mark those with blocks of enough stretches to be judged.

    Args:
        condition: the condition.
        values: of the condition (n,).
        stretch: number (n,) of the stretch of each block.
    """
    edges, member = cut(values)
    count = np.bincount(member, minlength=len(edges) - 1)
    visits = np.array([len(np.unique(stretch[member == b])) for b in range(len(count))])
    total = np.bincount(member, values, minlength=len(count))
    center = np.where(count > 0, total / np.maximum(count, 1), 0.5 * (edges[1:] + edges[:-1]))
    return Binning(condition, edges, center, member, count, visits >= MIN_VISITS)


def sums(binning: Binning, error: Array, stretch: Array) -> Array:
    """Sums (b, g) of the errors (n,) of one axis, over the blocks of each bin and stretch."""
    total = np.zeros((len(binning.count), stretch.max(initial=-1) + 1))
    np.add.at(total, (binning.bin, stretch), error)
    return total


def bin_errors(binning: Binning, error: Array, stretch: Array) -> BinnedErrors:
    """Average the errors of one axis in bins, and tell how much of them the means explain.

    Args:
        binning: b bins.
        error: of one axis (n,), m/s2 or rad/s2.
        stretch: number (n,) of the stretch of each block.
    """
    total, divisor = sums(binning, error, stretch), np.maximum(binning.count, 1)
    mean = total.sum(axis=1) / divisor
    size = sums(binning, np.ones(len(error)), stretch)
    visits = (size > 0).sum(axis=1)
    inflation = visits / np.maximum(visits - 1, 1)
    spread = np.sum((total - size * mean[:, None]) ** 2, axis=1) * inflation / divisor**2
    square = np.bincount(binning.bin, error**2, minlength=len(divisor)) / divisor
    variance = np.maximum(square - mean**2, 0.0)
    effective_count = np.minimum(divisor, variance / np.where(spread > 0, spread, np.inf))
    explained = np.sum((binning.count * (mean**2 - spread))[binning.judged])
    power = float(np.sum(error**2))
    share = max(float(explained) / power, 0.0) if power > 0 else 0.0
    return BinnedErrors(binning, mean, np.sqrt(spread), np.sqrt(square), effective_count, share)


def weigh_evidence(cuts: Sequence[Binning], error: Array, stretch: Array, signs: Array) -> Array:
    """Tell how far the bin means of the errors are from zero, with changed signs of stretches.

    The evidence is the sum over bins of (sum of the errors)^2 / sum over stretches of (their
    sums)^2. Chance makes it about 1 for each bin; at most it is the number of stretches in the bin.
    Every bin has its own scale, so that a few large errors at the end of a range neither make nor
    hide a finding.

    Args:
        cuts: c conditions in bins.
        error: of one axis (n,).
        stretch: number (n,) of the stretch of each block.
        signs: 1 or -1 for each stretch in each of f draws (g, f).

    Returns:
        The evidence (c, f).
    """
    parts = [sums(cut, error, stretch)[cut.judged] for cut in cuts]
    owner = np.repeat(np.arange(len(cuts)), [len(part) for part in parts])
    total = np.concatenate(parts)
    scale = np.sqrt(np.sum(total**2, axis=1))
    nonzero = scale > 0
    squares = (total[nonzero] / scale[nonzero, None] @ signs) ** 2
    evidence = np.zeros((len(cuts), signs.shape[1]))
    np.add.at(evidence, owner[nonzero], squares)
    return evidence
