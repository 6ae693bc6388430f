"""Error against cost: which share of the residual a correction leaves, on seen and unseen motion.

Residuals are trained on 3-DoF runs, and predict 3-DoF test runs (seen) and 6-DoF test runs (unseen:
heave, roll and pitch hardly move in the former).
"""

from collections.abc import Iterator

import numpy as np

from rovsim.benchmarks.speed.data import Pairs, fitted, unfading
from rovsim.benchmarks.speed.inference import ours
from rovsim.dynamics.learned.residual import Residual
from rovsim.evaluation.latency import time_calls
from rovsim.results.timing import Accuracy, RemainingRms

SEEN_CONTROL, UNSEEN_CONTROL = "3dof", "6dof"
TIMED_CALLS = 2_000


def measure_accuracy(pairs: Pairs) -> tuple[Accuracy, ...]:
    """Measure cost (us a prediction) and share of the residual left, for each way to learn."""
    train = pairs.of(SEEN_CONTROL)
    return tuple(
        Accuracy(
            name=name,
            points=residual.points,
            fades=fades,
            median_us=_cost(residual, pairs),
            seen=measure_left(residual, pairs, SEEN_CONTROL),
            unseen=measure_left(residual, pairs, UNSEEN_CONTROL),
        )
        for name, fades, residual in _ways(train)
    )


def _cost(residual: Residual, pairs: Pairs) -> float:
    latency = time_calls(ours(residual), pairs.queries, TIMED_CALLS, 200, points=residual.points)
    return latency.median_us


def _ways(taught: Pairs) -> Iterator[tuple[str, bool, Residual]]:
    """Yield name, whether the correction fades outside of the train data, and residual."""
    for points in (500, 2_000, 5_000, 20_000):
        yield "knn", False, fitted("knn", taught, max_points=points)
    for name, residual in _processes(taught):
        yield name, False, unfading(residual)
        yield name, True, residual


def _processes(taught: Pairs) -> Iterator[tuple[str, Residual]]:
    for points in (125, 250, 500, 1_000, 2_000):
        yield "gp", fitted("gp", taught, kernel="shared", max_points=points)
    yield "gp_six_kernels", fitted("gp", taught, max_points=1_000)
    for inducing in (50, 100, 200):
        yield "svgp", fitted("svgp", taught, inducing=inducing)


def measure_left(residual: Residual, pairs: Pairs, control: str) -> RemainingRms:
    """Measure the RMS of prediction errors over the RMS of the residual, on test runs.

    Args:
        residual: that predicts.
        pairs: test rows.
        control: of the test runs.

    Returns:
        The mean over the six axes, and the worst axis.
    """
    rows = pairs.query_control == control
    error = residual.predict(pairs.queries[rows]) - pairs.answers[rows]
    share = np.sqrt((error**2).mean(0) / (pairs.answers[rows] ** 2).mean(0))
    return RemainingRms(mean=float(share.mean()), worst=float(share.max()))
