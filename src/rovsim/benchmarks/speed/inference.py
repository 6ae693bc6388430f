"""Latency of every way to predict, that of rovsim and of the libraries, one call at a time."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from time import perf_counter_ns

import numpy as np
from numpy import ndarray as Array

from rovsim.benchmarks.speed import libraries
from rovsim.benchmarks.speed.data import Pairs, fitted, unfading
from rovsim.benchmarks.speed.machine import as_a_control_loop
from rovsim.dynamics.learned.layout import POINTS
from rovsim.dynamics.learned.predictor import evaluate_many, posterior_many
from rovsim.dynamics.learned.residual import Residual
from rovsim.evaluation.latency import time_calls
from rovsim.learning.learner import library_of
from rovsim.results.timing import Latency

BUSY_US = 100  # about the time of the slowest of our ways to predict
MAX_COMPARED_QUERIES = 500  # queries whose predictions are compared
# Takes the latencies so far, and how the process was scheduled.
Tell = Callable[[dict[str, Latency], str], None]
GP_SETTINGS = {"kernel": "shared"}  # all else as in `conf/residual/gp.yaml`


@dataclass(frozen=True)
class Effort:
    """How much is measured.

    Attributes:
        calls: timed calls of each way to predict.
        warmup: calls before these.
        seconds: longest time for a library's calls, s.
    """

    calls: int
    warmup: int
    seconds: float


class Stopwatch:
    """Times ways to predict.

    Attributes:
        pairs: what is learned and predicted.
        effort: how much is measured.
        scheduling: how the process was scheduled.
        tell: called with the results so far and the scheduling, after each way to predict.
        latencies: by `name@points`.
    """

    def __init__(self, pairs: Pairs, effort: Effort, tell: Tell = lambda *_: None) -> None:
        self.pairs, self.effort, self.scheduling, self.tell = pairs, effort, "", tell
        self.latencies: dict[str, Latency] = {}

    def time(self, name: str, call: Callable, points: int, seconds: float) -> Latency:
        """Time one way to predict, and keep the latency under `name@points`.

        Args:
            name: of the way.
            call: predicts one query (1, d).
            points: that the predictor looks at.
            seconds: longest time.
        """
        from threadpoolctl import threadpool_limits

        effort = self.effort
        # one query has no work for two threads; waiting for the second one costs milliseconds
        with threadpool_limits(1), as_a_control_loop() as self.scheduling:
            stats = time_calls(
                call,
                self.pairs.queries,
                effort.calls,
                effort.warmup,
                points=points,
                seconds=seconds,
            )
        self.latencies[f"{name}@{points}"] = stats
        times = f"{stats.median_us:12.1f} us median {stats.p999_us:12.1f} us p99.9"
        print(f"{name}@{points}".ljust(36), times, flush=True)
        self.tell(self.latencies, self.scheduling)
        return stats

    def beside(
        self, name: str, own: Callable, points: int, theirs: dict[str, Callable], seconds: float
    ) -> None:
        """Time our way and those of the libraries; keep ratios and differences of the predictions.

        Args:
            name: of our way.
            own: our way.
            points: that all predictors look at.
            theirs: ways of the libraries, by name.
            seconds: longest time for each library.
        """
        stats = self.time(name, own, points, 60.0)
        queries = self.pairs.queries[:: max(1, len(self.pairs.queries) // MAX_COMPARED_QUERIES)]
        first_queries = queries[:3]  # a library may take seconds a call
        differences, speedups = {}, {}
        for other, call in theirs.items():
            latency = self.time(other, call, points, seconds)
            compared = first_queries if latency.median_us > 1e5 else queries
            differences[other] = _difference(own, call, compared)
            speedups[other] = latency.median_us / stats.median_us
        update = {"largest_difference": differences} | (
            {"times_faster": speedups} if speedups else {}
        )
        self.latencies[f"{name}@{points}"] = stats.model_copy(update=update)


def _difference(own: Callable, call: Callable, queries: Array) -> float:
    """Return the largest difference of two ways over the queries, one at a time."""
    gaps = [np.abs(np.asarray(own(q[None])) - np.asarray(call(q[None]))).max() for q in queries]
    return float(max(gaps))


def ours(residual: Residual | Array) -> Callable:
    """Return our prediction (mean), as the compiled loop makes it."""
    data = residual.data if isinstance(residual, Residual) else residual
    return lambda x: evaluate_many(data, x)


def both(residual: Residual) -> Callable:
    """Return our prediction of mean and variance."""
    return lambda x: posterior_many(residual.data, x)


def busy(x: Array) -> Array:
    """Do nothing for as long as a prediction takes; if it is late, the machine was elsewhere."""
    end = perf_counter_ns() + 1000 * BUSY_US
    while perf_counter_ns() < end:
        pass
    return x


def inference(
    pairs: Pairs, effort: Effort, sweep: float, tell: Tell = lambda *_: None
) -> tuple[dict[str, Latency], str]:
    """Time all ways to predict: some sizes beside the libraries for long, then sweeps over sizes.

    Args:
        pairs: what is learned and predicted.
        effort: how much is measured.
        sweep: longest time for a library's calls in the sweeps, s.
        tell: called with the results so far and the scheduling, after each way to predict.

    Returns:
        Latencies by `name@points`, and how the process was scheduled.
    """
    stopwatch = Stopwatch(pairs, effort, tell)
    stopwatch.time(f"nothing_for_{BUSY_US}_us", busy, 0, effort.seconds)
    for points in (2_000, 20_000):
        time_neighbours(stopwatch, points, effort.seconds)
    time_processes(stopwatch, 2_000, effort.seconds)
    _six_kernels(stopwatch, 2_000, sweep)
    _inducing(stopwatch, effort.seconds)
    for points in (500, 5_000, 50_000):
        time_neighbours(stopwatch, points, sweep)
    for points in (500, 1_000, 4_000):
        time_processes(stopwatch, points, sweep)
    for name, call, points in _variants(pairs):
        stopwatch.beside(name, call, points, {}, sweep)
    return stopwatch.latencies, stopwatch.scheduling


def time_neighbours(stopwatch: Stopwatch, points: int, seconds: float) -> None:
    """Time the nearest neighbours among that many points, by our search and by the libraries'."""
    knn = fitted("knn", stopwatch.pairs.first(points))
    stopwatch.beside("knn", ours(knn), points, libraries.neighbours(knn), seconds)


def time_processes(stopwatch: Stopwatch, points: int, seconds: float) -> None:
    """Time a Gaussian process with one kernel for six outputs.

    That is its mean, its mean and variance, and the correction that fades outside of the data.
    """
    pairs = stopwatch.pairs.first(points)
    gp = fitted("gp", pairs, max_points=points, **GP_SETTINGS)
    unfaded = unfading(gp)
    stopwatch.beside("gp_mean", ours(unfaded), points, libraries.means(unfaded), seconds)
    stopwatch.beside("gp_faded", ours(gp), points, {}, seconds)
    theirs = libraries.variances(gp) if points <= 2_000 else {}
    stopwatch.beside("gp_variance", both(gp), points, theirs, seconds)


def _six_kernels(stopwatch: Stopwatch, points: int, seconds: float) -> None:
    """Time a Gaussian process with a kernel for each output."""
    pairs = stopwatch.pairs.first(points)
    gp = fitted("gp", pairs, max_points=points)
    unfaded = unfading(gp)
    ways: tuple[tuple[str, Callable, dict[str, Callable]], ...] = (
        ("gp_mean", ours(unfaded), libraries.means(unfaded)),
        ("gp_faded", ours(gp), {}),
        ("gp_variance", both(gp), libraries.variances(gp)),
    )
    for name, predict, library_calls in ways:
        theirs = {f"{other}_six_kernels": call for other, call in library_calls.items()}
        stopwatch.beside(f"{name}_six_kernels", predict, points, theirs, seconds)


def _inducing(stopwatch: Stopwatch, seconds: float) -> None:
    """Time a sparse variational process, with inducing points."""
    svgp = unfading(fitted("svgp", stopwatch.pairs.first(2_000)))
    points = svgp.points
    stopwatch.beside("svgp", ours(svgp), points, {"gpytorch_svgp": library_of(svgp)}, seconds)
    theirs = {"gpytorch_svgp_variance": libraries.variances(svgp)["gpytorch_variance"]}
    stopwatch.beside("svgp_variance", both(svgp), points, theirs, seconds)


def _variants(pairs: Pairs) -> Iterator[tuple[str, Callable, int]]:
    """Yield our predictors by number of neighbours, and by number of outputs."""
    for k in (1, 10, 20):
        yield f"knn_k{k}", ours(fitted("knn", pairs.first(20_000), k=k)), 20_000
    for outputs in range(1, 6):
        for kind, points in (("knn", 20_000), ("gp", 2_000)):
            data = pairs.exported(kind, points, outputs)
            yield f"{kind}_{outputs}_outputs", ours(data), int(data[POINTS])
