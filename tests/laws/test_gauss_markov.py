"""Noise that lasts: exact at the instants, however long the steps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.core import gauss_markov


@given(st.floats(1e-3, 3.0), st.integers(1, 9))
def test_many_steps_spread_as_much_as_one(step, count):
    alone, whole = gauss_markov.decay(step), gauss_markov.decay(count * step)
    kept = np.prod([alone] * count)
    spread = sum((1.0 - alone**2) * alone ** (2 * k) for k in range(count))
    assert kept == pytest.approx(whole)
    assert spread == pytest.approx(1.0 - whole**2)


def test_it_is_the_same_in_columns_and_in_rows():
    random = np.random.default_rng(0)
    a, normal, begin = gauss_markov.decay(0.3), random.normal(size=(50, 6)), random.normal(size=6)
    columns = gauss_markov.propagate(a, normal, begin)
    rows = gauss_markov.propagate(np.full((50, 6), a), normal, begin)
    np.testing.assert_array_equal(columns, rows)
    own = gauss_markov.propagate(np.full(6, a), normal, begin)
    np.testing.assert_array_equal(columns, own)


def test_it_is_stationary_and_forgets_within_its_time():
    step, lag = 0.1, 10
    drawn = gauss_markov.draw(200_000, step, np.random.default_rng(1))
    assert np.var(drawn, axis=0) == pytest.approx(np.ones(6), rel=0.05)
    like = np.mean(drawn[lag:] * drawn[:-lag], axis=0)
    assert like == pytest.approx(np.full(6, np.exp(-lag * step)), abs=0.03)


def test_a_mean_varies_less_the_shorter_the_noise_lasts():
    step, block = 0.1, 100
    drawn = gauss_markov.draw(1_000_000, step, np.random.default_rng(2))
    means = drawn.reshape(-1, block, 6).mean(axis=1)
    ratio = np.full(6, 1.0 / (step * block))
    assert np.var(means, axis=0) == pytest.approx(gauss_markov.variance_of_mean(ratio), rel=0.05)
