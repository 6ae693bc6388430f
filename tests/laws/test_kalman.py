"""The filters of the diagnosis: their equations, and what they make of what they are told."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import solve_discrete_are
from scipy.signal import lfilter

from rovsim.estimation.kernels.axis import (
    MIN_DRIVING_VARIANCE,
    MIN_NOISE_SHARE,
    POSE,
    characteristic,
    filter_kept,
    misfit,
    sum_of_squares,
)
from rovsim.estimation.observer.kalman import AxisErrorDynamics, AxisNoise, design_filter
from rovsim.estimation.observer.noise import Noise, RunFilters
from rovsim.estimation.observer.noise_fit import fit_noise

H = 0.01
noises = st.tuples(
    st.booleans(),
    st.floats(0.0, 5.0),
    st.floats(0.003, 0.3),
    st.floats(0.2, 3.0),
    st.floats(1e-4, 1e-2),
)


def rung(f, h, disturbance_std, correlation_time, measurement_std, n, seed):
    """Readings (n,) of the very process that a filter is made for."""
    random = np.random.default_rng(seed)
    x = np.zeros(len(f.C))
    driving = disturbance_std * np.sqrt(1.0 - f.decay**2)
    y = np.empty(n)
    for k in range(n):
        y[k] = f.C @ x + measurement_std * random.normal()
        x = f.F @ x
        x[-1] += driving * random.normal()
    return y


def innovations(f, y):
    """What a filter cannot foresee of readings."""
    x, e = np.zeros(len(f.C)), np.empty(len(y))
    for k, one in enumerate(y):
        e[k] = one - f.C @ x
        x = f.F @ (x + f.gain * e[k])
    return e


@given(noises)
def test_the_riccati_equation_is_solved_as_by_the_general_solver(noise):
    binned, d, disturbance_std, correlation_time, measurement_std = noise
    own = AxisNoise(disturbance_std, correlation_time, measurement_std)
    f = design_filter(binned, H, AxisErrorDynamics(d), own)
    n, r = len(f.C), measurement_std**2
    Q = MIN_NOISE_SHARE * r * np.eye(n)
    Q[-1, -1] = (
        disturbance_std**2 * (1.0 - np.exp(-2.0 * H / correlation_time)) + MIN_DRIVING_VARIANCE
    )
    P = solve_discrete_are(f.F.T, f.C[:, None], Q, np.array([[r]]))
    assert f.variance == pytest.approx(f.C @ P @ f.C + r, rel=1e-6)
    np.testing.assert_allclose(f.gain, P @ f.C / (f.C @ P @ f.C + r), rtol=1e-4, atol=1e-9)


@given(noises)
def test_a_filter_is_stable_and_its_poles_are_its_eigenvalues(noise):
    f = design_filter(noise[0], H, AxisErrorDynamics(noise[1]), AxisNoise(*noise[2:]))
    A = f.F @ (np.eye(len(f.C)) - np.outer(f.gain, f.C))
    assert np.abs(np.linalg.eigvals(A)).max() < 1.0
    np.testing.assert_allclose(f.denominator, np.poly(A), atol=1e-9)
    np.testing.assert_allclose(characteristic(A), f.denominator, atol=1e-12)


@given(st.floats(0.0, 20.0), st.floats(-5.0, 40.0), st.floats(0.005, 0.4))
def test_an_axis_goes_on_as_its_differential_equation_says(damping, stiffness, h):
    def rates(t, x):
        return [x[1], 0.7 - damping * x[1] - stiffness * x[0]]

    expected = solve_ivp(rates, (0.0, h), [0.2, -0.5], rtol=1e-9, atol=1e-12).y[:, -1]
    moved = AxisErrorDynamics(damping, stiffness).over(h) @ [0.2, -0.5, 0.7]
    np.testing.assert_allclose(moved[:2], expected, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("binned", [False, True])
def test_innovations_of_one_filter_become_those_of_another(binned):
    h = 0.16 if binned else H
    old = design_filter(binned, h, AxisErrorDynamics(1.0), AxisNoise(0.2, 0.5, 1e-3))
    new = design_filter(binned, h, AxisErrorDynamics(1.0), AxisNoise(0.05, 1.5, 2e-3))
    y = rung(new, h, 0.05, 1.5, 2e-3, 4000, 3)
    np.testing.assert_allclose(
        lfilter(*new.whitening(old), innovations(old, y)), innovations(new, y), atol=1e-9
    )


def test_the_right_filter_leaves_white_noise_of_the_variance_it_says():
    f = design_filter(False, H, AxisErrorDynamics(1.0), AxisNoise(0.05, 1.0, 1e-3))
    e = innovations(f, rung(f, H, 0.05, 1.0, 1e-3, 40000, 1))[500:]
    assert np.var(e) == pytest.approx(f.variance, rel=0.03)
    for lag in (1, 3, 10, 50):
        assert abs(np.mean(e[lag:] * e[:-lag]) / np.var(e)) < 0.02


@pytest.mark.parametrize("binned", [False, True])
def test_a_push_shows_in_the_innovations_as_the_response_says(binned):
    h = 0.16 if binned else H
    f = design_filter(binned, h, AxisErrorDynamics(1.0), AxisNoise(0.05, 1.0, 1e-3))
    push = np.where(np.arange(400) % 90 < 30, 0.3, -0.1)
    x, y = np.zeros(len(f.C)), np.empty(len(push))
    moved = AxisErrorDynamics(1.0).over(h)
    B = np.array([h, 0.0]) if binned else np.array([*moved[:2, 2], 0.0])
    for k, a in enumerate(push):  # felt over the step before the reading
        x = f.F @ x + B * a
        y[k] = f.C @ x
    b, a = f.response
    expected = innovations(f, y) / np.sqrt(f.variance)
    np.testing.assert_allclose(lfilter(b, a, np.append(push, 0.0))[1:], expected, atol=1e-9)


def test_spans_are_filtered_by_themselves_and_only_kept_ones_written():
    random = np.random.default_rng(0)
    b, a = random.normal(size=(6, 4)), np.column_stack([np.ones(6), np.full((6, 3), 0.1)])
    e, spans = random.normal(size=(2, 6, 50)), np.array([[0, 20], [20, 50]])
    kept, scale = random.random(50) > 0.4, np.arange(1.0, 7.0)
    out = np.empty((2, 6, kept.sum()))
    filter_kept(b, a, e, spans, kept, np.ones((e.shape[2], 6), bool), scale, out)
    for i in range(6):
        parts = [lfilter(b[i], a[i], e[1, i, p:q]) for p, q in spans]
        whole = np.concatenate(parts)[kept]
        np.testing.assert_allclose(out[1, i], whole * scale[i], atol=1e-12)
        total, _ = sum_of_squares(b[i], a[i], e[1, i], spans, kept, np.ones(50, bool))
        assert total == pytest.approx(whole @ whole)


def test_what_is_not_shown_is_passed_over():
    """A filter goes on from one value that is shown to the next, whatever lies between."""
    random = np.random.default_rng(1)
    b, a = random.normal(size=(6, 4)), np.column_stack([np.ones(6), np.full((6, 3), 0.1)])
    e, spans, kept = random.normal(size=(1, 6, 60)), np.array([[0, 60]]), np.arange(60) > 9
    shown = random.random((60, 6)) > 0.5
    out = np.empty((1, 6, 50))
    filter_kept(b, a, e, spans, kept, shown, np.ones(6), out)
    for i in range(6):
        there = shown[:, i]
        expected = np.zeros(60)
        expected[there] = lfilter(b[i], a[i], e[0, i, there])
        np.testing.assert_allclose(out[0, i], expected[kept], atol=1e-12)
        _, count = sum_of_squares(b[i], a[i], e[0, i], spans, kept, there)
        assert count == np.sum(there & kept)


@pytest.mark.parametrize(
    ("disturbance_std", "measurement_std"), [(1e-300, 1e-3), (0.1, 1e-300), (1e200, 1e-3)]
)
def test_a_noise_that_cannot_be_ends_no_search(disturbance_std, measurement_std):
    """A search may ask for it on its way."""
    motion, usual = AxisErrorDynamics(0.5), AxisNoise(0.1, 1.0, 1e-3)
    f, every = design_filter(POSE, H, motion, usual), np.ones(500, bool)
    e = np.sqrt(f.variance) * np.random.default_rng(0).normal(size=500)

    def cost(noise):
        squares, log, count = misfit(
            np.array(noise),
            POSE,
            H,
            motion.over(H, POSE),
            f.denominator,
            f.noise_denominator,
            e,
            np.array([[0, 500]]),
            every,
            every,
        )
        return squares + count * log

    other = usual._replace(disturbance_std=disturbance_std, measurement_std=measurement_std)
    assert not cost(other) < cost(usual)


def observed(start, y):
    """Innovations of readings y (n,) on every axis, found with filters that suit a noise."""
    n, error_dynamics = len(y), [AxisErrorDynamics(1.0)] * 6
    axes = enumerate(error_dynamics)
    filters = tuple(design_filter(POSE, H, own, start.of_axis(i)) for i, own in axes)
    found = RunFilters(filters, np.full(6, H), np.full(n, H))
    run = SimpleNamespace(
        axis_periods=np.full(6, H),
        reading_kinds=np.full(6, POSE),
        innovation_mask=np.ones((n, 6), bool),
        motion=SimpleNamespace(binned=False),
        innovation_segments=np.array([[0, n]]),
        settled=np.arange(n) > 100,
        group=1,
    )
    return [np.array([innovations(f, y) for f in found.filters])], [run], [found], error_dynamics


def test_the_noise_of_made_innovations_is_found():
    true = AxisNoise(0.04, 1.0, 1.5e-3)
    y = rung(design_filter(POSE, H, AxisErrorDynamics(1.0), true), H, *true[:3], 20000, 7)
    start = Noise(np.full(6, 0.1), np.full(6, 0.5), np.full(6, 5e-4))
    noise, _ = fit_noise(*observed(start, y), start)
    np.testing.assert_allclose(noise.measurement_std, true.measurement_std, rtol=0.03)
    np.testing.assert_allclose(noise.disturbance_std, true.disturbance_std, rtol=0.25)
    assert np.all((noise.correlation_time > 0.6) & (noise.correlation_time < 1.7))


@pytest.mark.parametrize("with_bias", [False, True])
def test_beside_slow_errors_some_noise_is_left_from_frame_to_frame(with_bias):
    """Without any no filter can be told from another: what it forgets it would have to know."""
    slow, lasting = 2e-4, 0.1
    motion = design_filter(POSE, H, AxisErrorDynamics(1.0), AxisNoise(0.01, 1.0, 1e-4))
    keep = np.exp(-H / lasting)
    drawn = np.random.default_rng(8).normal(size=8000)
    errors = lfilter([slow * np.sqrt(1.0 - keep**2)], [1.0, -keep], drawn)
    y = rung(motion, H, 0.01, 1.0, 0.0, 8000, 7) + errors
    sixfold = (np.full(6, one) for one in (0.03, 0.5, 1e-4, slow, lasting))
    start = Noise(*sixfold)
    noise, _ = fit_noise(*observed(start, y), start, with_bias)
    assert np.all(noise.measurement_std > 0.05 * noise.bias_std)
