"""Noise of a process, judged on stretches that were left out."""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.signal import lfilter

from rovsim.learning.cross_validation import FOLDS, NOISE_FACTORS, noise_factor, split_rows
from rovsim.learning.posterior_variance import rbf


@pytest.fixture
def rows():
    rng = np.random.default_rng(0)
    Z = lfilter([0.1], [1, -0.9], rng.normal(size=(300, 3)), axis=0)
    return Z / Z.std(0), rng


def missed(K, error, outputscale, noise):
    """Squared errors of every stretch, foretold by a process that never saw it."""
    total = 0.0
    for out in split_rows(len(K)):
        kept = np.setdiff1d(np.arange(len(K)), out)
        S = outputscale * K[np.ix_(kept, kept)] + noise * np.eye(len(kept))
        foretold = outputscale * K[np.ix_(out, kept)] @ np.linalg.solve(S, error[:, kept].T)
        total += np.sum((error[:, out].T - foretold) ** 2)
    return total


@pytest.mark.parametrize("memory", [0.0, 0.95])
def test_the_factor_is_the_one_a_refit_without_each_stretch_prefers(rows, memory):
    Z, rng = rows
    disturbance = lfilter([1.0], [1, -memory], rng.normal(size=(2, 300)), axis=1)
    error = np.sin(Z[:, :2].T) + disturbance / disturbance.std()
    K = rbf(Z, Z, np.full(3, 0.5))
    best = min(NOISE_FACTORS, key=lambda f: missed(K, error, 1.0, 0.1 * f))
    assert noise_factor(*eigh(K), error, 1.0, 0.1) == best
    assert best > 1.0  # the noise given was a tenth of the truth


def test_what_is_right_is_left_alone(rows):
    Z, rng = rows
    K = rbf(Z, Z, np.full(3, 1.0))
    f = np.linalg.cholesky(K + 1e-9 * np.eye(300)) @ rng.normal(size=300)
    error = f[None] + 0.3 * rng.normal(size=300)
    assert noise_factor(*eigh(K), error, 1.0, 0.09) in NOISE_FACTORS[:2]


def test_every_row_is_left_out_once_however_few():
    for rows in (1, 3, 10, 37):
        assert np.array_equal(np.concatenate(list(split_rows(rows))), np.arange(rows))
        assert len(list(split_rows(rows))) == min(rows, FOLDS)
