"""Latency: how long one prediction takes, called one at a time as a control loop would."""

import gc
from collections.abc import Callable
from contextlib import contextmanager
from time import perf_counter_ns
from typing import Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.learned.predictor import evaluate_many
from rovsim.dynamics.learned.residual import Residual
from rovsim.results.timing import CONTROL_RATES_HZ, BothWays, Latency


def time_calls(
    call: Callable[[Array], Array],
    queries: Array,
    calls: int,
    warmup: int,
    *,
    points: int,
    seconds: float = 10.0,
) -> Latency:
    """Time `call` on one query after the other.

    Python's garbage collector runs once before the calls and not during them, so that the numbers
    are those of the prediction. In a loop that leaves it on, a call may take longer by its pause.

    Args:
        call: from features (1, d) to accelerations (1, m).
        queries: features (n, d), used in turn.
        calls: how often to call, at most.
        warmup: calls before the clock starts; fewer if they take more than a tenth of `seconds`.
        points: number of points that the predictor uses, for the record.
        seconds: no further call is started after this long; at least one is timed.
    """
    rows = [queries[i : i + 1] for i in range(len(queries))]
    begin = perf_counter_ns()
    for i in range(max(warmup, 1)):
        answer = call(rows[i % len(rows)])
        if perf_counter_ns() - begin > 1e8 * seconds:
            break
    with _no_collection():
        durations = _timed(call, rows, calls, int(seconds * 1e9))
    return Latency(
        points=points,
        features=int(queries.shape[1]),
        outputs=int(np.shape(answer)[-1]),
        calls=len(durations),
        median_us=float(np.median(durations)) / 1e3,
        p99_us=float(np.percentile(durations, 99.0)) / 1e3,
        p999_us=float(np.percentile(durations, 99.9)) / 1e3,
        max_us=float(durations.max()) / 1e3,
        misses={str(rate): int(np.sum(durations > 1e9 / rate)) for rate in CONTROL_RATES_HZ},
    )


def _timed(call: Callable[[Array], Array], rows: list[Array], calls: int, limit: int) -> Array:
    """Time calls one after the other; nanoseconds (k,) of each.

    Args:
        call: what is timed.
        rows: its arguments, used in turn.
        calls: how many, at most.
        limit: nanoseconds after which no further call is started.
    """
    durations = np.zeros(max(calls, 1), dtype=np.int64)
    end = perf_counter_ns() + limit
    for i in range(len(durations)):
        row = rows[i % len(rows)]
        start = perf_counter_ns()
        call(row)
        stop = perf_counter_ns()
        durations[i] = stop - start
        if stop > end:
            return durations[: i + 1]
    return durations


@contextmanager
def _no_collection() -> Iterator[None]:
    """Collect garbage once, and keep the collector off inside the `with` block."""
    was_enabled = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def time_both_ways(
    residual: Residual, queries: Array, calls: int, warmup: int, seconds: float
) -> BothWays:
    """Time a trained residual as a call of its library, if it has one, and as it is exported.

    Args:
        residual: the trained residual.
        queries: features (n, d), used in turn.
        calls: how often to call each, at most.
        warmup: calls before the clock starts.
        seconds: for each, no further call is started after this long.
    """
    from rovsim.learning.learner import learner, library_of

    def timed(call: Callable[[Array], Array]) -> Latency:
        return time_calls(call, queries, calls, warmup, points=residual.points, seconds=seconds)

    has_library = learner(residual.kind).library_from is not None
    library = timed(library_of(residual)) if has_library else None
    return BothWays(library=library, exported=timed(lambda x: evaluate_many(residual.data, x)))
