"""Choose the vehicle: of those that the columns fit, the one whose predicted motion is measured."""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.vehicle import default_vehicle
from rovsim.evaluation.commanded_motion.cross_correlation import (
    MIN_CORRELATION,
    MIN_LEAD_RATIO,
    CrossCorrelation,
)
from rovsim.intake.motions import correlate, rank_rotations
from rovsim.intake.pairing import Pair
from rovsim.intake.vehicles import VehicleMatch

SAME_HULL_DIFFERENCE = 0.03  # correlation by which vehicles of one hull differ


@dataclass(frozen=True, eq=False)
class Choice:
    """The vehicle of the runs, and how its predicted motion correlates with the measured one.

    Attributes:
        fit: the vehicle, None where the files do not tell.
        reason: how it is known, or why it is not.
        fits: all vehicles that the columns of the commands fit, the likeliest first.
        turned: mean correlation of the runs along each of 24 body axes, and these axes, a rotation
            (3, 3) from FRD into the file's; the best first.
        runs: correlation of each run that could be compared, by its position among the runs.
        likeliest: the vehicle that `turned` and `runs` are of, where there is one.
    """

    fit: VehicleMatch | None
    reason: str
    fits: tuple[VehicleMatch, ...]
    turned: tuple[tuple[float, Array], ...]
    runs: dict[int, CrossCorrelation]
    likeliest: VehicleMatch | None = None


def choose(fits: Sequence[VehicleMatch], pairs: Sequence[Pair]) -> Choice:
    """Choose the vehicle if no other hull explains the runs nearly as well.

    Also chosen is the only vehicle whose file names its columns as the log does.
    """
    if not fits:
        return Choice(None, "no vehicle file has as many commands", (), (), {})
    compared = {fit.name: _correlate_runs(fit, pairs) for fit in fits}
    by_axes = {
        name: rank_rotations(correlations)
        for name, correlations in compared.items()
        if correlations
    }
    scores = {name: _score(compared[name], by_axes[name]) for name in by_axes}
    ordered = sorted(fits, key=lambda fit: -scores.get(fit.name, 0.0))
    best = _first(ordered, scores)
    undecided = Choice(
        None,
        _explain_fits(ordered, scores),
        tuple(ordered),
        tuple(by_axes.get(best.name, [])),
        compared[best.name],
        best,
    )
    rivals = [scores.get(fit.name, 0.0) for fit in ordered if not _one_hull(fit, best)]
    likely = scores.get(best.name, 0.0) >= MIN_CORRELATION
    ahead = scores.get(best.name, 0.0) >= MIN_LEAD_RATIO * max(rivals, default=0.0)
    by_name = best.by_name and len(ordered) == 1
    return replace(undecided, fit=best) if by_name or (likely and ahead) else undecided


def _score(
    correlations: dict[int, CrossCorrelation], turns: Sequence[tuple[float, Array]]
) -> float:
    """Score a vehicle: correlation along the best axes, less for wrong speeds (Lin 1989).

    The concordance of two series is their correlation times 2 r / (1 + r^2), r the ratio of their
    standard deviations.
    """
    ratios = np.array([correlation.strength for correlation in correlations.values()])
    return turns[0][0] * float(np.mean(2.0 * ratios / (1.0 + ratios**2)))


def _first(ordered: Sequence[VehicleMatch], scores: dict[str, float]) -> VehicleMatch:
    """Return the best vehicle, or the default one if it has that hull and is nearly as good."""
    best = ordered[0]
    for fit in ordered:
        close = scores.get(fit.name, 0.0) > scores.get(best.name, 0.0) - SAME_HULL_DIFFERENCE
        if close and fit.name == default_vehicle() and _one_hull(fit, best):
            return fit
    return best


def _correlate_runs(fit: VehicleMatch, pairs: Sequence[Pair]) -> dict[int, CrossCorrelation]:
    correlations = {
        k: correlate(p.motion, log, fit) for k, p in enumerate(pairs) if (log := p.shown)
    }
    return {k: c for k, c in correlations.items() if c is not None and c.excited.any()}


def _one_hull(a: VehicleMatch, b: VehicleMatch) -> bool:
    """Whether two vehicles have the same hydrodynamics, so that only their thrusters differ."""
    return a.vehicle.hydrodynamics == b.vehicle.hydrodynamics


def _explain_fits(fits: Sequence[VehicleMatch], scores: dict[str, float]) -> str:
    if not scores:
        return f"the columns fit {', '.join(fit.name for fit in fits)}"
    vehicles = [f"{fit.name} ({scores.get(fit.name, 0.0):.2f})" for fit in fits]
    return f"the columns fit, and the motion is like that of (correlation) {', '.join(vehicles)}"
