"""Pairs of many runs: as they are while memory holds them, spread over all runs beyond."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from rovsim.dynamics.learned.settings import FeatureSettings
from rovsim.learning.pairs import Gathered
from rovsim.simulation.samples import Samples

FEATURES = FeatureSettings(blocks=("velocity",))


def samples(rows: int, first: int) -> Samples:
    """A run whose rows are numbered, in what it looks at and in what it should predict."""
    number = np.repeat(first + np.arange(rows, dtype=float)[:, None], 6, axis=1)
    return Samples(np.arange(rows), number, number[:, :4], number, number, -number)


@given(st.lists(st.integers(1, 60), min_size=1, max_size=9), st.integers(8, 80))
def test_no_more_rows_than_memory_holds_and_none_apart_from_its_target(lengths, most):
    gathered, first = Gathered(FEATURES, seed=1, most=most), 0
    for k, rows in enumerate(lengths):
        gathered.take(str(k), samples(rows, first))
        first += rows
    X, Y = gathered.pairs
    assert gathered.rows == sum(lengths)
    assert gathered.runs == [str(k) for k in range(len(lengths))]
    assert np.array_equal(X, -Y)
    assert np.all(np.diff(X[:, 0]) > 0)
    if sum(lengths) <= most:
        assert len(X) == sum(lengths)
    else:
        assert len(lengths) <= len(X) <= max(most, len(lengths))


def test_the_rows_kept_are_spread_over_all_runs():
    gathered = Gathered(FEATURES, seed=1, most=300)
    for k in range(20):
        gathered.take(str(k), samples(100, 100 * k))
    shares = np.bincount((gathered.pairs[0][:, 0] // 100).astype(int), minlength=20)
    assert shares.min() == shares.max() == 13
