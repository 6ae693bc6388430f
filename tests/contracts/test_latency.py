"""Latency: every call counted, one at a time, with the collector out of the way."""

import gc

import numpy as np
import pytest

from rovsim.evaluation.latency import time_calls
from rovsim.results.timing import CONTROL_RATES_HZ

QUERIES = np.arange(12.0).reshape(4, 3)


def test_each_call_sees_one_query_and_all_are_used_in_turn():
    seen = []

    def call(row):
        seen.append((row.shape, row[0, 0]))
        return np.zeros((1, 6))

    stats = time_calls(call, QUERIES, calls=6, warmup=2, points=5)
    assert seen == [((1, 3), q) for q in (0, 3, 0, 3, 6, 9, 0, 3)]
    assert (stats.points, stats.features, stats.outputs, stats.calls) == (5, 3, 6, 6)
    assert stats.misses == {str(rate): 0 for rate in CONTROL_RATES_HZ}


@pytest.fixture
def clock(monkeypatch):
    """A clock that moves only when a test says so: real ones make timed tests."""
    now = [0]
    monkeypatch.setattr("rovsim.evaluation.latency.perf_counter_ns", lambda: now[0])
    return now


def test_slow_calls_are_misses_at_the_rates_they_miss(clock):
    pauses = iter([0.0] + [0.0, 0.0, 0.0, 0.005] * 5)  # 5 ms: too late for 250 Hz, not for 100 Hz

    def call(row):
        clock[0] += int(1e9 * next(pauses))
        return row

    stats = time_calls(call, QUERIES, calls=20, warmup=1, points=1)
    assert stats.misses == {"50": 0, "100": 0, "250": 5, "1000": 5}
    assert stats.p99_us == stats.p999_us == stats.max_us == 5e3
    assert stats.median_us == 0


def test_time_is_bounded(clock):
    def call(row):
        clock[0] += 10_000_000
        return row

    stats = time_calls(call, QUERIES, calls=10**6, warmup=1, points=1, seconds=0.05)
    assert stats.calls == 6
    assert time_calls(call, QUERIES, calls=9, warmup=0, points=1, seconds=0.0).calls == 1
    before = clock[0]
    time_calls(call, QUERIES, calls=1, warmup=10**6, points=1, seconds=0.5)
    assert clock[0] - before == 7 * 10_000_000  # a tenth of half a second, and one call


def test_the_collector_rests_during_the_calls_and_is_put_back():
    during = []
    assert gc.isenabled()
    time_calls(lambda row: during.append(gc.isenabled()) or row, QUERIES, 3, 2, points=1)
    assert during == [True, True, False, False, False]
    assert gc.isenabled()
    answers = iter([QUERIES[:1]])
    with pytest.raises(StopIteration):
        time_calls(lambda row: next(answers), QUERIES, 3, 1, points=1)
    assert gc.isenabled()
