"""The likeliest sizes of parts of a noise: slope, curvature, and no cost is less."""

from unittest.mock import patch

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import approx_fprime, minimize

from rovsim.estimation.kernels.whittle import evaluate, least_misfit, solve, take_step

FREQUENCY = np.linspace(5.0, 48.0, 60)  # Hz
WHITE = np.ones_like(FREQUENCY)
OTHERS = np.array([(FREQUENCY / 5.0) ** -4, 1.0 / (1.0 + (FREQUENCY / 12.0) ** 2)])
LOW, HIGH = np.log([1e-8, 1e-8]), np.log([1e8, 1e8])
sizes = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)).map(np.array)
seeds = st.integers(0, 999)


def spectrum(sizes, seed, count=80):
    """Mean of `count` periodograms of a noise of these log sizes beside white."""
    mean = WHITE + np.exp(sizes) @ OTHERS
    return mean * np.random.default_rng(seed).gamma(count, 1.0 / count, len(mean))


def cost(x, power):
    """Whittle's, by its definition, at the likeliest scale."""
    mean = WHITE + np.exp(x) @ OTHERS
    mean = mean * np.mean(power / mean)
    return np.sum(np.log(mean) + power / mean) - len(power)


@given(sizes, sizes, seeds)
def test_slope_and_curvature_are_those_of_the_cost(true, at, seed):
    power = spectrum(true, seed)
    found, slope, _ = evaluate.py_func(at, power, WHITE, OTHERS)
    assert np.isclose(found, cost(at, power))
    assert np.allclose(slope, approx_fprime(at, cost, 1e-6, power), atol=1e-4)
    mean = (WHITE + np.exp(at) @ OTHERS) * 2.0
    _, none, curvature = evaluate.py_func(at, mean, WHITE, OTHERS)  # what is expected
    assert np.allclose(none, 0.0, atol=1e-9)
    for k, row in enumerate(curvature):
        bend = approx_fprime(
            at, lambda x, k=k: evaluate.py_func(x, mean, WHITE, OTHERS)[1][k], 1e-6
        )
        assert np.allclose(row, bend, atol=1e-4)


@given(st.lists(sizes, min_size=1, max_size=3), seeds)
def test_no_library_finds_less(true, seed):
    power = np.array([spectrum(one, seed + i) for i, one in enumerate(true)])
    found = least_misfit(power, WHITE, OTHERS, LOW, HIGH)
    bounds = list(zip(LOW, HIGH, strict=True))
    least = sum(
        minimize(cost, one, (own,), bounds=bounds).fun for one, own in zip(true, power, strict=True)
    )
    assert found < least + 1e-6


@given(st.lists(st.booleans(), min_size=4, max_size=4), seeds)
def test_what_is_not_free_stays_and_the_rest_takes_the_whole_step(free, seed):
    random, free = np.random.default_rng(seed), np.array(free)
    root, slope = random.normal(size=(6, 4)), random.normal(size=4)
    curvature = root.T @ root
    with patch("rovsim.estimation.kernels.whittle.solve", solve.py_func):
        step = take_step.py_func(slope, curvature, 0.0, free)
    assert np.all(step[~free] == 0.0)
    assert np.allclose((curvature @ step)[free], -slope[free])
