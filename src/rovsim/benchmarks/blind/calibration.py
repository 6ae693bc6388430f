"""Compare the intervals and probabilities that answers claim with the truth.

Simulation-based calibration (Talts et al. 2018, arXiv:1804.06788): draw a truth, simulate, infer;
if the inference is right, the rank of the truth in the posterior is uniform. Here the posterior of
a parameter is a Gaussian, so the rank is Φ((truth - value) / std).

Strict simulation-based calibration draws truths from the prior of the inference. Here they are
drawn by the recipes, and only parameters of effects that were named count. So this says whether
intervals are honest where the data decide, and not whether the whole inference is coherent.
"""

from collections import defaultdict
from dataclasses import dataclass
from itertools import pairwise
from typing import Callable, Iterable, Iterator, Sequence

import numpy as np
from scipy.special import ndtr
from scipy.stats import chisquare

from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.case import Case
from rovsim.core.normal import Z_95
from rovsim.dynamics.catalogue import built_in
from rovsim.results.bands import Bands
from rovsim.results.blind_benchmark import BandRates, Calibration, Claims, Ranks
from rovsim.results.fitted import FittedEffect

RANK_BINS = 10
# Claimed probabilities pile up at one, so that bins are finer there.
PROBABILITY_EDGES = (0.0, 0.5, 0.8, 0.95, 0.99, 0.999, 1.0)
MIN_BIN_VALUES = 5  # with fewer, the statistic is not chi-square (Cochran 1954)
TEST_BIN_COUNTS = (10, 5, 2)  # bins of the test: the most that have enough values


@dataclass(frozen=True)
class Miss:
    """How far a fitted parameter of a hidden effect that was named is from the truth.

    Attributes:
        effect: its id.
        name: of the parameter.
        deviations: (truth - value) / std.
    """

    effect: str
    name: str
    deviations: float


def calibrate(answers: Sequence[KeptAnswer]) -> Calibration:
    """Compare the claims of all answers of one method with the truth."""
    misses = [miss for answer in answers for miss in list_misses(answer)]
    claims = [claim for answer in answers for claim in _list_names(answer)]
    with_probability = [(p, right) for p, right in claims if p is not None]
    return Calibration(
        ranks=rank(misses),
        effects=_rank_each(misses, lambda m: m.effect),
        parameters=_rank_each(misses, lambda m: f"{m.effect}.{m.name}"),
        probability=tuple(_bin_claims(with_probability)),
        without_probability=_count([(0.0, right) for p, right in claims if p is None], None, None),
        bands=rate_bands([answer.bands for answer in answers if answer.bands is not None]),
    )


def rate_bands(all_bands: Sequence[Bands]) -> dict[str, BandRates]:
    """Measure how often measured velocities lie inside 90 % bands at the ends of windows.

    Args:
        all_bands: bands of the test runs, one entry for each campaign.

    Returns:
        Rates by the length of the windows in s.
    """
    campaigns: dict[str, list[tuple[float, int]]] = defaultdict(list)
    for bands in all_bands:
        shares: dict[str, list[float]] = defaultdict(list)
        for run in (run for model in bands.models.values() for run in model.runs.values()):
            for seconds, coverage in run.windows.items():
                inside = coverage.at_end.array()
                shares[seconds] += list(np.repeat(inside[np.isfinite(inside)], coverage.windows))
        for seconds, values in shares.items():
            if values:
                campaigns[seconds].append((float(np.mean(values)), len(values)))
    return {seconds: _rate_band(parts) for seconds, parts in campaigns.items()}


def _rate_band(parts: Sequence[tuple[float, int]]) -> BandRates:
    """Summarize campaigns, given the share inside the band and the number of points of each."""
    shares, points = np.array(parts).T
    low, high = np.quantile(shares, [0.05, 0.95])
    return BandRates(
        campaigns=len(parts),
        points=int(points.sum()),
        inside=float(shares @ points / points.sum()),
        low=float(low),
        high=float(high),
    )


def list_misses(answer: KeptAnswer) -> Iterator[Miss]:
    """List the misses of all fitted parameters of an answer that have a standard deviation.

    The truth of a parameter that is not hidden is its default.
    """
    hidden = {entry.effect: entry for entry in answer.case.hidden}
    for selected in answer.diagnosis.selected if answer.diagnosis else ():
        if selected.effect in hidden:
            truth = {name: v.value for name, v in hidden[selected.effect].parameters.items()}
            yield from _compare(selected, truth)


def _compare(one: FittedEffect, truth: dict[str, float]) -> Iterator[Miss]:
    """Compare a fitted effect with its true values; skip parameters without a known truth."""
    defaults = {p.name: p.default for p in built_in()[one.effect].parameters}
    true_values = defaults | truth  # parameters of a vehicle's fins have no default here
    for name, fitted in one.parameters.items():
        if name in true_values and fitted.value is not None and fitted.std:
            deviations = (true_values[name] - fitted.value) / fitted.std
            yield Miss(one.effect, name, float(deviations))


def rank(misses: Sequence[Miss]) -> Ranks:
    """Count deviations in bins of equal probability under a standard Gaussian; test the counts."""
    z = np.array([m.deviations for m in misses])
    bins = np.minimum((RANK_BINS * ndtr(z)).astype(int), RANK_BINS - 1)
    counts = np.bincount(bins, minlength=RANK_BINS)
    return Ranks(
        values=len(z),
        covered=float(np.mean(np.abs(z) <= Z_95)) if len(z) else None,
        stretch=float(np.quantile(np.abs(z), 0.95) / Z_95) if len(z) else None,
        counts=tuple(int(c) for c in counts),
        p_value=_test_evenness(counts),
    )


def _test_evenness(counts: np.ndarray) -> float | None:
    """Return the chance of a histogram (RANK_BINS,) at least as uneven; None for too few values."""
    for bins in TEST_BIN_COUNTS:
        if counts.sum() >= MIN_BIN_VALUES * bins:
            return float(chisquare(counts.reshape(bins, -1).sum(axis=1)).pvalue)
    return None


def _rank_each(misses: Iterable[Miss], key: Callable[[Miss], str]) -> dict[str, Ranks]:
    """Rank the misses of each group by itself; `key` returns the group of a miss."""
    groups: dict[str, list[Miss]] = {}
    for miss in misses:
        groups.setdefault(key(miss), []).append(miss)
    return {name: rank(group) for name, group in sorted(groups.items())}


def _list_names(answer: KeptAnswer) -> Iterator[tuple[float | None, bool]]:
    """Return, for each selected effect, its claimed probability and whether it is hidden."""
    for selected in answer.diagnosis.selected if answer.diagnosis else ():
        yield selected.probability, selected.effect in _names(answer.case)


def _names(case: Case) -> set[str]:
    return {entry.effect for entry in case.hidden}


def _bin_claims(names: Sequence[tuple[float, bool]]) -> Iterator[Claims]:
    """Count right names in bins of the claimed probability; empty bins are left out."""
    for low, high in pairwise(PROBABILITY_EDGES):
        last = high == PROBABILITY_EDGES[-1]
        inside = [(p, right) for p, right in names if low <= p and (p < high or last)]
        if inside:
            yield _count(inside, low, high)


def _count(names: Sequence[tuple[float, bool]], low: float | None, high: float | None) -> Claims:
    """Count names, given as pairs of claimed probability and whether the name is right."""
    return Claims(
        low=low,
        high=high,
        names=len(names),
        right=sum(right for _, right in names),
        claimed=None if low is None else float(np.mean([p for p, _ in names])),
    )
