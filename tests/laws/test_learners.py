"""Laws of what learners do before they learn: how many neighbours, which targets to believe."""

import numpy as np
import pytest

from rovsim.learning.gaussian import GaussianSettings, huberize
from rovsim.learning.learners.knn import best_k


def rows(noise, count=600, seed=3):
    """A smooth residual of two features, measured with noise."""
    rng = np.random.default_rng(seed)
    X = rng.uniform(-1.0, 1.0, (count, 2))
    Y = np.tile(np.sin(3.0 * X[:, :1]) + X[:, 1:], (1, 6))
    return X, Y, Y + noise * rng.normal(size=Y.shape)


@pytest.mark.parametrize("weights", ["uniform", "distance"])
def test_noise_asks_for_many_neighbours_and_none_for_few(weights):
    X, _, exact = rows(0.0)
    assert best_k(X, exact, weights) <= 5
    X, _, noisy = rows(2.0)
    assert best_k(X, noisy, weights) >= 20


def test_few_rows_leave_no_choice():
    X, _, Y = rows(0.1, count=4)
    assert 1 <= best_k(X, Y, "uniform") <= 4


def test_far_off_targets_come_back_to_their_neighbours():
    X, true, Y = rows(0.1, count=3000)
    spoilt = np.arange(0, 3000, 30)
    Y[spoilt] += 5.0
    found = huberize(X, Y, GaussianSettings(kind="any"))
    assert np.max(np.abs(found - true)[spoilt]) < 1.0
    fine = np.setdiff1d(np.arange(3000), spoilt)
    changed = np.abs(found - Y)[fine] > 0.0
    assert changed.mean() < 0.02


def test_targets_are_left_alone_when_asked():
    X, _, Y = rows(1.0)
    np.testing.assert_array_equal(huberize(X, Y, GaussianSettings(kind="any", huberized=None)), Y)
    few = huberize(X[:10], Y[:10], GaussianSettings(kind="any"))
    np.testing.assert_array_equal(few, Y[:10])
