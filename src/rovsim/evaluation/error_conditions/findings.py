"""Find the conditions that explain a model's error, one after the other, if not by chance.

On every axis, what the best condition explains is subtracted from the error, and the rest is
searched again. So one cause is reported once, and not as everything that varied together with it. A
condition counts only if it explains more than any condition on any axis would by chance.
"""

from dataclasses import dataclass, field, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from threadpoolctl import threadpool_limits

from rovsim.core.axes import AXES
from rovsim.core.rounding import rounded_or_none
from rovsim.evaluation.error_conditions.bins import (
    BinnedErrors,
    Binning,
    bin_errors,
    cut_bins,
    number_stretches,
    weigh_evidence,
)
from rovsim.evaluation.error_conditions.conditions import Blocks, Condition
from rovsim.results.error_conditions import THROUGHOUT, ConditionShare

SIGNIFICANCE_LEVEL = 0.005  # chance of any false finding in a whole search over an adequate model
SIGN_FLIP_COUNT = 3999  # they tell chances down to 1/4000, a twentieth of SIGNIFICANCE_LEVEL
MIN_ERROR_SHARE = 0.03  # share of the squared error: a condition that explains less is not reported
MIN_ERROR_RATIO = 0.03  # likewise: explained error over the measured acceleration, both RMS
TIE_RATIO = 0.9  # of the best share: conditions with more cannot be told apart from the best
MAX_AXIS_FINDINGS = 3  # findings that are reported of each axis
MIN_STRETCHES = 8  # with fewer, nothing is said


@dataclass(frozen=True, eq=False)
class Finding:
    """A condition that explains part of the error of one axis.

    Attributes:
        axis: surge to yaw.
        condition: its name.
        share_of_error: share of the squared error that it explains.
        chance: of explaining so much by accident.
        table: bins of the error that earlier findings of the axis left.
        alike: conditions that explain it nearly as well.
        after: names of the conditions that were subtracted from the error before.
        constant: share of the squared error that a constant alone explains.
        steady: that constant, the mean error, m/s2 or rad/s2.
        push: force or moment of such a constant, N or N m; None where the inertia is unknown.
    """

    axis: str
    condition: str
    share_of_error: float
    chance: float
    table: BinnedErrors
    alike: tuple[Condition, ...] = ()
    after: tuple[str, ...] = ()
    constant: float = 0.0
    steady: float = 0.0
    push: float | None = None

    def share(self) -> ConditionShare:
        """The finding, as a diagnosis lists it under `where`."""
        constant = self.push is not None and self.condition == THROUGHOUT
        return ConditionShare(
            axis=self.axis,
            condition=self.condition,
            share_of_error=round(self.share_of_error, 3),
            push=rounded_or_none(self.push, 4) if constant else None,
        )


@dataclass(frozen=True, eq=False)
class ErrorExplanation:
    """Errors of one model by axis and condition, and the findings.

    Attributes:
        blocks: errors and conditions; None without a usable sample.
        tables: errors in bins, by axis and name of the condition.
        findings: the largest share first.
        enough: False if too little was recorded to judge anything.
    """

    blocks: Blocks | None
    tables: dict[str, dict[str, BinnedErrors]]
    findings: list[Finding] = field(default_factory=list)
    enough: bool = True

    @staticmethod
    def nothing() -> "ErrorExplanation":
        """The explanation of a model without a usable sample."""
        return ErrorExplanation(None, {axis: {} for axis in AXES}, [], False)


def explain_errors(blocks: Blocks, seed: int = 0, inertia: Array | None = None) -> ErrorExplanation:
    """Search all conditions on the axes that were measured.

    Args:
        blocks: errors and conditions.
        seed: of the random signs that tell what chance explains.
        inertia: of the model (6, 6), which turns mean errors into forces; None if unknown.
    """
    if len(blocks.time) < 2:
        return ErrorExplanation.nothing()
    tables: dict[str, dict[str, BinnedErrors]] = {axis: {} for axis in AXES}
    findings: list[Finding] = []
    enough_stretches = True
    for k in np.flatnonzero(blocks.axes).tolist():
        axis, error = AXES[k], blocks.error[:, k]
        stretch = number_stretches(blocks, error)
        cuts = [cut_bins(c, x, stretch) for c, x in blocks.values.items()]
        tables[axis] = {b.condition.name: bin_errors(b, error, stretch) for b in cuts}
        threshold = max(MIN_ERROR_SHARE, MIN_ERROR_RATIO**2 * _relative_power(blocks, k))
        with threadpool_limits(1, "blas"):  # the matrices are small: threads would wait
            causes = _of_axis(axis, error, cuts, stretch, seed)
        pushes = [_estimate_push(f, blocks, k, inertia) for f in causes]
        findings += [f for f in pushes if f.share_of_error > threshold]
        enough_stretches = enough_stretches and int(stretch.max()) + 1 >= MIN_STRETCHES
    return ErrorExplanation(
        blocks, tables, sorted(findings, key=lambda f: -f.share_of_error), enough_stretches
    )


def _estimate_push(one: Finding, blocks: Blocks, k: int, inertia: Array | None) -> Finding:
    """Add to a finding of axis k the push of a constant: row k of tau_res = M a_res."""
    if inertia is None:
        return one
    mean = np.where(blocks.axes, blocks.error.mean(axis=0), 0.0)
    mean[k] = one.steady
    return replace(one, push=float(inertia[k] @ mean))


def _relative_power(blocks: Blocks, k: int) -> float:
    """Ratio of mean squared measured acceleration and mean squared error of axis k."""
    power = float(np.mean(blocks.error[:, k] ** 2))
    return float(np.mean(blocks.measured[:, k] ** 2)) / power if power > 0 else 0.0


def _of_axis(
    axis: str, error: Array, cuts: Sequence[Binning], stretch: Array, seed: int
) -> list[Finding]:
    """Find conditions on one axis, each of which explains what the ones before left.

    Args:
        axis: surge to yaw.
        error: of that axis (n,), m/s2 or rad/s2.
        cuts: all conditions in bins.
        stretch: number (n,) of the stretch of each block.
        seed: of the random signs.
    """
    count = int(stretch.max()) + 1
    signs = np.random.default_rng(seed).choice([-1.0, 1.0], (count, SIGN_FLIP_COUNT))
    findings: list[Finding] = []
    remainder, power = error, float(np.sum(error**2))
    while count >= MIN_STRETCHES and len(findings) < MAX_AXIS_FINDINGS and power > 0:
        finding = _find_next(
            axis, remainder, cuts, stretch, signs, float(np.sum(remainder**2)) / power
        )
        if finding is None or finding.share_of_error < MIN_ERROR_SHARE:
            break
        findings.append(replace(finding, after=tuple(f.condition for f in findings)))
        at = finding.table.binning
        remainder = remainder - np.where(at.judged, finding.table.mean, 0.0)[at.bin]
    return findings


def _find_next(axis, left, cuts, stretch, signs, scale: float) -> Finding | None:
    """Find the condition that explains most of what is left; None where chance explains as much.

    A constant is preferred if it explains nearly as much. `scale` is the share of the whole squared
    error that is left.
    """
    tables = [bin_errors(b, left, stretch) for b in cuts]
    chances = _chances(left, cuts, stretch, signs)
    significant = [
        (t, p) for t, p in zip(tables, chances, strict=True) if p <= SIGNIFICANCE_LEVEL / len(AXES)
    ]
    if not significant:
        return None
    largest = max(t.share for t, _ in significant)
    near_largest = sorted(
        (r for r in significant if r[0].share >= TIE_RATIO * largest), key=lambda r: -r[0].share
    )
    simplest = [r for r in near_largest if r[0].binning.condition.name == THROUGHOUT]
    table, chance = (simplest or near_largest)[0]
    similar = () if simplest else tuple(t.binning.condition for t, _ in near_largest[1:])
    name = table.binning.condition.name
    whole_run = next((t for t in tables if t.binning.condition.name == THROUGHOUT), None)
    constant, steady = (
        (whole_run.share * scale, float(whole_run.mean[0])) if whole_run else (0.0, 0.0)
    )
    return Finding(
        axis, name, table.share * scale, chance, table, similar, constant=constant, steady=steady
    )


def _chances(error: Array, cuts: Sequence[Binning], stretch: Array, signs: Array) -> list[float]:
    """Chance, for each condition, that the most striking of all is as striking by accident.

    Args:
        error: of one axis (n,).
        cuts: c conditions in bins.
        stretch: number (n,) of the stretch of each block.
        signs: random signs (g, f) of the stretches.
    """
    unflipped = np.ones((len(signs), 1))
    flipped = weigh_evidence(cuts, error, stretch, signs)
    actual = weigh_evidence(cuts, error, stretch, unflipped)[:, 0]
    mean, spread = flipped.mean(axis=1), flipped.std(axis=1)
    spread = np.where(spread > 0, spread, np.inf)
    highest = ((flipped - mean[:, None]) / spread[:, None]).max(axis=0)
    z_scores = (actual - mean) / spread
    return [float(1 + np.sum(highest >= z)) / (1 + len(highest)) for z in z_scores]
