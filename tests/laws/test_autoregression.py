"""Axes that drive each other: what their past foretells is taken away, and nothing else."""

from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.estimation.observer.autoregression import MIN_COUPLING, Stretches, fit_autoregression
from rovsim.estimation.observer.innovations import ErrorDynamics

LENGTHS = (1500, 2500)
SWAY, YAW = 1, 5


def stretches(shown=None):
    """One run of two unbroken stretches, of which nothing is left out."""
    stops = np.cumsum(LENGTHS)
    n = stops[-1]
    run = SimpleNamespace(
        innovation_segments=np.column_stack([stops - LENGTHS, stops]),
        time=np.arange(n),
        settled=np.ones(n, bool),
        innovation_mask=np.ones((n, 6), bool) if shown is None else shown,
    )
    return Stretches.of([run])


def driven(strength, seed=0):
    """Innovations (6, n): yaw follows the sway of one reading before, and pushes it two later."""
    z = np.random.default_rng(seed).normal(size=(6, sum(LENGTHS)))
    first = stretches().first
    for t in range(2, z.shape[1]):
        if t - 2 >= first[t]:
            z[YAW, t] += strength * z[SWAY, t - 1]
            z[SWAY, t] -= strength * z[YAW, t - 2]
    return z


def foretold(z, i, j, lag):
    """Correlation of axis i with axis j some readings before, in standard errors."""
    a, b = z[i, lag:], z[j, :-lag]
    return abs(a @ b) / np.sqrt((a @ a) * (b @ b) / len(a))


def test_what_the_past_foretells_is_gone():
    z = driven(0.2)
    past, lr_statistic = fit_autoregression([z], stretches())
    white = past.whiten(z, stretches())
    assert foretold(z, YAW, SWAY, 1) > 10.0
    assert foretold(z, SWAY, YAW, 2) > 10.0
    for i in range(6):
        for j in range(6):
            for lag in (1, 2, 3):
                assert foretold(white, i, j, lag) < 3.5
    np.testing.assert_allclose(white.std(axis=1), 1.0, rtol=0.01)
    foretold_share = 0.2**2  # of the variance of each of the two axes
    assert lr_statistic == pytest.approx(2 * sum(LENGTHS) * np.log(1.0 + foretold_share), rel=0.5)


def test_what_is_drawn_twice_counts_once():
    z = driven(0.2)
    once, lr_statistic = fit_autoregression([z], stretches())
    twice, same = fit_autoregression([z, z], stretches())
    np.testing.assert_allclose(twice.weights, once.weights, atol=1e-12)
    assert same == pytest.approx(lr_statistic)


def test_where_nothing_is_foretold_little_is_gained():
    """Chance gives one, in twice the log likelihood, for each of the ninety weights."""
    z = driven(0.0)
    _, lr_statistic = fit_autoregression([z], stretches())
    assert 45.0 < lr_statistic < 150.0


def test_it_looks_back_and_only_within_a_stretch():
    z = driven(0.2)
    past, _ = fit_autoregression([z], stretches())
    white = past.whiten(z, stretches())
    other = z.copy()
    other[:, LENGTHS[0] - 5 : LENGTHS[0]] += 9.0
    difference = np.abs(past.whiten(other, stretches()) - white)
    changed = np.flatnonzero((difference > 1e-9).any(axis=0))
    assert changed.min() == LENGTHS[0] - 5
    assert changed.max() == LENGTHS[0] - 1


def test_what_nobody_reads_stays_nothing():
    shown = np.ones((sum(LENGTHS), 6), bool)
    shown[::3, SWAY] = False
    z = np.where(shown.T, driven(0.2), 0.0)
    past, _ = fit_autoregression([z], stretches(shown))
    white = past.whiten(np.stack([z, z]), stretches(shown))
    assert not white[:, SWAY, ::3].any()
    assert white[0, SWAY, 1::3].all()


def test_subsystems_do_not_meet():
    past, _ = fit_autoregression([driven(0.2)], stretches())
    assert past.weights[YAW, SWAY].any()
    assert not past.weights[::2, 1::2].any()
    assert not past.weights[1::2, ::2].any()


def test_axes_are_coupled_if_each_drives_the_other_all_the_time():
    damping, stiffness = np.diag([1.0, 1.0, 1.0, 2.0, 2.0, 2.0]), np.zeros((6, 6))
    damping[YAW, SWAY] = 2.0
    assert ErrorDynamics(damping, np.abs(damping), stiffness).coupling == 0.0
    damping[SWAY, YAW] = -0.5
    assert ErrorDynamics(damping, np.abs(damping), stiffness).coupling == pytest.approx(1.0)
    assert MIN_COUPLING < 1.0
    to_and_fro = 1.6 * np.abs(damping)
    assert ErrorDynamics(damping, to_and_fro, stiffness).coupling == 0.0
