"""Which condition explains a model's error: found one after the other, against chance.

For every axis the condition that explains most is taken out of the error and the rest is searched
again, so that one cause is told once and not under the name of everything that varied with it. A
condition counts only when it explains more than any of all conditions on any axis would by chance.
"""

from dataclasses import dataclass, field, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from threadpoolctl import threadpool_limits

from rovsim import AXES
from rovsim.evaluation.error_conditions.bins import (
    BinnedErrors,
    Binning,
    bin_errors,
    cut_bins,
    number_stretches,
    weigh_evidence,
)
from rovsim.evaluation.error_conditions.conditions import THROUGHOUT, Blocks, Condition
from rovsim.results.error_conditions import ConditionShare

LEVEL = 0.005  # chance of a single false finding in a whole search over an adequate model
FLIPS = 3999  # of signs: these tell chances down to 1/4000, a twentieth of LEVEL
SMALLEST = 0.03  # share of the squared error below which a condition is not worth a sentence
NEGLIGIBLE = 0.03  # explained error relative to the measured acceleration, likewise (both RMS)
AS_GOOD = 0.9  # of the best share: conditions the data do not tell apart from it
MOST = 3  # findings an axis
FEWEST = 8  # stretches without which nothing is said


@dataclass(frozen=True, eq=False)
class Finding:
    """What explains part of the error of one axis.

    `share_of_error` of its squared error, of which `constant` varies with nothing; `table` of the
    error that was left when it was found; `alike` conditions that explain it nearly as well;
    `chance` of such a share by accident; `after` the conditions that were taken out of the error
    before this one was sought. `steady` is the mean error, and `push` what a constant would push
    with, N or N m, where the inertia is known.
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
        """As `where` of a diagnosis lists it."""
        alone = self.push is not None and self.condition == THROUGHOUT
        return ConditionShare(
            axis=self.axis,
            condition=self.condition,
            share_of_error=round(self.share_of_error, 3),
            push=float(f"{self.push:.4g}") if alone else None,
        )


@dataclass(frozen=True, eq=False)
class ErrorExplanation:
    """Errors of one model by axis and condition, and the findings, largest share first."""

    blocks: Blocks | None
    tables: dict[str, dict[str, BinnedErrors]]
    findings: list[Finding] = field(default_factory=list)
    enough: bool = True  # False: too little was recorded to judge anything

    @staticmethod
    def nothing() -> "ErrorExplanation":
        """What is known of a model without a usable sample."""
        return ErrorExplanation(None, {axis: {} for axis in AXES}, [], False)


def explain(blocks: Blocks, seed: int = 0, inertia: Array | None = None) -> ErrorExplanation:
    """Search all conditions on the axes that were measured.

    Args:
        blocks: what is searched.
        seed: of the signs that say what chance does.
        inertia: of the model (6, 6), which makes forces of accelerations.
    """
    if len(blocks.time) < 2:
        return ErrorExplanation.nothing()
    tables: dict[str, dict[str, BinnedErrors]] = {axis: {} for axis in AXES}
    found: list[Finding] = []
    enough = True
    for k in np.flatnonzero(blocks.axes).tolist():
        axis, error = AXES[k], blocks.error[:, k]
        stretch = number_stretches(blocks, error)
        cuts = [cut_bins(c, x, stretch) for c, x in blocks.values.items()]
        tables[axis] = {b.condition.name: bin_errors(b, error, stretch) for b in cuts}
        worth = max(SMALLEST, NEGLIGIBLE**2 * _relative_power(blocks, k))
        with threadpool_limits(1, "blas"):  # the matrices are small: threads would wait
            causes = _of_axis(axis, error, cuts, stretch, seed)
        pushes = [_pushed(f, blocks, k, inertia) for f in causes]
        found += [f for f in pushes if f.share_of_error > worth]
        enough = enough and int(stretch.max()) + 1 >= FEWEST
    return ErrorExplanation(blocks, tables, sorted(found, key=lambda f: -f.share_of_error), enough)


def _pushed(one: Finding, blocks: Blocks, k: int, inertia: Array | None) -> Finding:
    """A finding of axis k with the push of a constant: that axis' row of tau_res = M a_res."""
    if inertia is None:
        return one
    mean = np.where(blocks.axes, blocks.error.mean(axis=0), 0.0)
    mean[k] = one.steady
    return replace(one, push=float(inertia[k] @ mean))


def _relative_power(blocks: Blocks, k: int) -> float:
    """Mean squared measured acceleration of axis k over mean squared error."""
    power = float(np.mean(blocks.error[:, k] ** 2))
    return float(np.mean(blocks.measured[:, k] ** 2)) / power if power > 0 else 0.0


def _of_axis(
    axis: str, error: Array, cuts: Sequence[Binning], stretch: Array, seed: int
) -> list[Finding]:
    """Findings of one axis, each explaining what the ones before it left."""
    count = int(stretch.max()) + 1
    signs = np.random.default_rng(seed).choice([-1.0, 1.0], (count, FLIPS))
    found: list[Finding] = []
    left, power = error, float(np.sum(error**2))
    while count >= FEWEST and len(found) < MOST and power > 0:
        best = _next(axis, left, cuts, stretch, signs, float(np.sum(left**2)) / power)
        if best is None or best.share_of_error < SMALLEST:
            break
        found.append(replace(best, after=tuple(f.condition for f in found)))
        at = best.table.binning
        left = left - np.where(at.judged, best.table.mean, 0.0)[at.bin]
    return found


def _next(axis, left, cuts, stretch, signs, scale: float) -> Finding | None:
    """The condition that explains most of what is left, if that is beyond chance."""
    tables = [bin_errors(b, left, stretch) for b in cuts]
    chances = _chances(left, cuts, stretch, signs)
    real = [(t, p) for t, p in zip(tables, chances, strict=True) if p <= LEVEL / len(AXES)]
    if not real:
        return None
    most = max(t.share for t, _ in real)
    close = sorted((r for r in real if r[0].share >= AS_GOOD * most), key=lambda r: -r[0].share)
    simplest = [r for r in close if r[0].binning.condition.name == THROUGHOUT]
    best, chance = (simplest or close)[0]
    alike = () if simplest else tuple(t.binning.condition for t, _ in close[1:])
    name = best.binning.condition.name
    alone = next((t for t in tables if t.binning.condition.name == THROUGHOUT), None)
    constant, steady = (alone.share * scale, float(alone.mean[0])) if alone else (0.0, 0.0)
    return Finding(
        axis, name, best.share * scale, chance, best, alike, constant=constant, steady=steady
    )


def _chances(error: Array, cuts: Sequence[Binning], stretch: Array, signs: Array) -> list[float]:
    """Chance that the most striking of all conditions is as striking as each one is."""
    none = np.ones((len(signs), 1))
    flipped = weigh_evidence(cuts, error, stretch, signs)
    seen = weigh_evidence(cuts, error, stretch, none)[:, 0]
    mean, spread = flipped.mean(axis=1), flipped.std(axis=1)
    spread = np.where(spread > 0, spread, np.inf)
    highest = ((flipped - mean[:, None]) / spread[:, None]).max(axis=0)
    ours = (seen - mean) / spread
    return [float(1 + np.sum(highest >= z)) / (1 + len(highest)) for z in ours]
