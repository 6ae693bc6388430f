"""Filters, derivatives and bin means against motions whose answer is known on paper."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovsim.core import rotations
from rovsim.core.errors import BadInput
from rovsim.measurement.signals.binned import backward_difference, bin_means, edge_values
from rovsim.measurement.signals.chain import (
    SignalSettings,
    differentiated,
    filter_and_differentiate,
    filtered,
)
from rovsim.measurement.signals.differentiate import (
    Central,
    SavitzkyGolay,
    Spline,
    differentiate_eta,
)
from rovsim.measurement.signals.filter import Butterworth, Unfiltered, filter_eta
from rovsim.measurement.signals.filter import SavitzkyGolay as SavitzkyGolayFilter
from rovsim.measurement.signals.motion import Poses
from worlds import motion, sticks


class Sway:
    """All six axes move: p sinusoids, R = Rz(psi) Rx(phi); every derivative written out."""

    amplitude = np.array([0.4, 0.3, 0.2])
    pulse = np.array([2.0, 3.0, 2.5])
    phase = np.array([0.3, 1.0, 2.0])

    def eta(self, t):
        (psi, *_), (phi, *_) = self.psi(t), self.phi(t)
        p = self.amplitude * np.sin(self.pulse * t[:, None] + self.phase)
        q = rotations.multiply(
            rotations.from_euler(0 * t, 0 * t, psi), rotations.from_euler(phi, 0 * t, 0 * t)
        )
        return np.concatenate([p, q], axis=1)

    def psi(self, t):
        return 0.8 * t + 0.5 * np.sin(2 * t), 0.8 + np.cos(2 * t), -2 * np.sin(2 * t)

    def phi(self, t):
        return 0.6 * np.sin(3 * t), 1.8 * np.cos(3 * t), -5.4 * np.sin(3 * t)

    def nu(self, t):
        (psi, dpsi, ddpsi), (phi, dphi, ddphi) = self.psi(t), self.phi(t)
        c, s = np.cos(phi), np.sin(phi)
        omega = np.stack([dphi, dpsi * s, dpsi * c], axis=1)
        omega_dot = np.stack(
            [ddphi, ddpsi * s + dpsi * dphi * c, ddpsi * c - dpsi * dphi * s], axis=1
        )
        angle = self.pulse * t[:, None] + self.phase
        v = self.into_body(psi, phi, self.amplitude * self.pulse * np.cos(angle))
        pull = self.into_body(psi, phi, -self.amplitude * self.pulse**2 * np.sin(angle))
        v_dot = pull - np.cross(omega, v)
        return np.concatenate([v, omega], axis=1), np.concatenate([v_dot, omega_dot], axis=1)

    @staticmethod
    def into_body(psi, phi, x):
        forward = np.cos(psi) * x[:, 0] + np.sin(psi) * x[:, 1]
        aside = np.cos(psi) * x[:, 1] - np.sin(psi) * x[:, 0]
        return np.stack(
            [
                forward,
                np.cos(phi) * aside + np.sin(phi) * x[:, 2],
                np.cos(phi) * x[:, 2] - np.sin(phi) * aside,
            ],
            axis=1,
        )


def error(method, dt, end=4.0):
    t = dt * np.arange(round(end / dt) + 1)
    inside = (t > 0.5) & (t < end - 0.5)
    nu, nu_dot = differentiate_eta(Sway().eta(t), dt, method)
    true_nu, true_nu_dot = Sway().nu(t)
    return np.abs(nu - true_nu)[inside].max(0), np.abs(nu_dot - true_nu_dot)[inside].max(0)


# Orders of accuracy away from the ends. At equidistant knots the first derivative of a cubic
# spline is of fourth order (de Boor 1978, ch. V), the second of second order.
@pytest.mark.parametrize(("method", "orders"), [(Spline(), (4, 2)), (Central(), (2, 2))])
def test_error_of_derivatives_falls_at_the_order_of_the_method(method, orders):
    for coarse, fine, order in zip(error(method, 0.04), error(method, 0.02), orders, strict=True):
        np.testing.assert_allclose(np.log2(coarse / fine), order, atol=0.35)


@pytest.mark.parametrize("method", [Spline(), Central(), SavitzkyGolay()])
def test_velocity_and_acceleration_of_a_motion_in_six_axes(method):
    nu, nu_dot = error(method, 0.01)
    # h^2 / 6 |x'''| and h^2 / 12 |x''''| at h = 0.01 s, |x'''| and |x''''| below 60 and 300 in
    # this motion; the 7-point parabola of savgol loses up to 10 times more
    assert nu.max() < 10 * 1e-4 / 6 * 60
    assert nu_dot.max() < 10 * 1e-4 / 12 * 300


@given(
    cone=st.floats(-1.5, 1.5),
    spin=st.floats(-4, 4),
    speed=st.floats(-1, 1),
)
def test_coning_at_a_constant_rate(cone, spin, speed):
    """A helix with a tilted body: constant nu, nu_dot = 0.

    Bounds: a cubic spline is off by h^3 / 24 |x''''| in the first and 3/8 h^2 |x''''| in the
    second derivative (Hall & Meyer 1976), with |q''''| = (spin / 2)^4; twice that in omega.
    """
    h, t = 0.01, 0.01 * np.arange(200)
    angle = spin * t
    q = rotations.multiply(
        rotations.from_euler(0 * t, 0 * t, angle), rotations.from_euler(cone + 0 * t, 0 * t, 0 * t)
    )
    p = np.stack([np.sin(angle), -np.cos(angle), speed * t], axis=1)
    nu, nu_dot = differentiate_eta(np.concatenate([p, q], axis=1), h, Spline())
    s, c = np.sin(cone), np.cos(cone)
    expected = [spin, speed * s, speed * c, 0, spin * s, spin * c]
    fourth = np.array([spin**4] * 3 + [2 * (spin / 2) ** 4] * 3)
    inside = slice(15, -15)
    assert np.all(np.abs(nu - expected)[inside] <= h**3 / 24 * fourth + 1e-9)
    # v' = R^T p'' - omega x v also takes up the errors of omega and v
    turning = h**3 / 24 * (fourth.max() * 2 * (np.abs(expected).max() + 1))
    assert np.all(np.abs(nu_dot)[inside] <= 3 / 8 * h**2 * fourth + turning + 1e-7)


@given(hz=st.floats(0.2, 8.0), order=st.integers(2, 4), phase=st.floats(0, 6))
def test_butterworth_has_its_gain_and_no_phase(hz, order, phase):
    dt, cutoff = 0.01, 5.0
    t = dt * np.arange(1000)
    wave = np.sin(2 * np.pi * hz * t + phase)
    # The bilinear transform maps f to tan(pi f dt) (Oppenheim & Schafer 2010, sec. 7.2.2).
    ratio = np.tan(np.pi * hz * dt) / np.tan(np.pi * cutoff * dt)
    gain = 1 / (1 + ratio ** (2 * order))
    out = Butterworth(cutoff=cutoff, order=order).smoothed(wave[:, None], dt)[:, 0]
    np.testing.assert_allclose(out[300:-300], gain * wave[300:-300], atol=1e-5)


@pytest.mark.parametrize("method", [Butterworth(), SavitzkyGolayFilter(), Unfiltered()])
@pytest.mark.parametrize("n", [50, 201])
def test_constant_acceleration_passes_the_filter_up_to_the_ends(method, n):
    t = 0.01 * np.arange(n)
    x = np.stack([1 + 0 * t, 0.7 * t, 0.5 * t**2], axis=1)
    np.testing.assert_allclose(method.smoothed(x, 0.01), x, atol=1e-6)


def test_a_filter_above_half_the_sampling_rate_is_refused():
    with pytest.raises(BadInput, match=r"below 4 Hz.*filter\.cutoff"):
        filter_eta(np.tile([0, 0, 0, 1.0, 0, 0, 0], (20, 1)), 1 / 8, Butterworth())


@pytest.mark.parametrize("method", [Butterworth(), SavitzkyGolayFilter(), Unfiltered()])
def test_cameras_of_ten_frames_a_second_pass_the_chain_as_it_is(method):
    """A motion of 0.3 Hz comes through, with the filter lowered to 0.4 of the rate."""
    still, time = motion(sticks(2, rows=40), seconds=2.0), 0.1 * np.arange(200)
    eta = np.tile(still.eta[:1], (200, 1))
    eta[:, 0] = 0.5 * np.sin(2.0 * np.pi * 0.3 * time)
    slow = Poses(still.run, still.site, time, eta, np.ones(200, bool), still.commands)
    chain = SignalSettings(filter=method)
    found = differentiated(filtered(slow, chain), chain)
    speed = 0.3 * np.pi * np.cos(2.0 * np.pi * 0.3 * time)
    assert found.usable.sum() > 190
    np.testing.assert_allclose(found.nu[found.usable, 0], speed[found.usable], atol=0.02)


@settings(deadline=None, max_examples=10)
@given(seed=st.integers(0, 2**32 - 1))
def test_noise_in_velocity_and_acceleration_is_what_theory_says(seed):
    """White noise of standard deviation s at rate F leaves s sqrt(2/F int (2 pi f)^2k G^2 df)."""
    rate, n, noise = 100.0, 20000, np.repeat([0.5e-3, 2e-3], 3)
    e = noise * np.random.default_rng(seed).normal(size=(n, 6))
    eta = np.concatenate([e[:, :3], rotations.exp(e[:, 3:])], axis=1)
    nu, nu_dot = filter_and_differentiate(eta, 1 / rate, SignalSettings())
    f = np.linspace(0, rate / 2, 5000)[:-1]
    gain = 1 / (1 + (np.tan(np.pi * f / rate) / np.tan(np.pi * 5 / rate)) ** 6)
    for k, found in ((1, nu), (2, nu_dot)):
        expected = noise * np.sqrt(2 / rate * np.trapezoid(((2 * np.pi * f) ** k * gain) ** 2, f))
        # about 2 x 5 Hz x 200 s = 2000 independent values: 1.6 % standard error
        np.testing.assert_allclose(found[50:-50].std(axis=0), expected, rtol=0.08)


def test_noise_of_half_a_millimetre_leaves_3_mm_per_s():
    """The numbers the default cut-off is chosen by (brick wall: 2 pi s sqrt(2 fc^3 / 3 F))."""
    brick_wall = 2 * np.pi * 0.5e-3 * np.sqrt(2 * 5**3 / (3 * 100))
    e = 0.5e-3 * np.random.default_rng(3).normal(size=(20000, 1))
    smooth = Butterworth().smoothed(e, 0.01)
    nu = Spline().derivatives(smooth, 0.01)[0]
    assert 0.8 * brick_wall < nu.std() < brick_wall


@given(
    seed=st.integers(0, 2**32 - 1),
    degree=st.integers(0, 1),
    n=st.integers(1, 12),
)
def test_bin_means_are_exact_for_straight_lines_whatever_the_samples(seed, degree, n):
    rng = np.random.default_rng(seed)
    edges = np.cumsum(rng.uniform(0.05, 0.3, n + 1))
    time = np.unique(np.concatenate([[0.0, edges[-1] + 0.1], rng.uniform(0, edges[-1], 30)]))
    c = rng.normal(size=(2, 6)) * (np.arange(2) <= degree)[:, None]
    nu = c[0] + c[1] * time[:, None]
    expected = c[0] + c[1] * (0.5 * (edges[1:] + edges[:-1]))[:, None]
    np.testing.assert_allclose(bin_means(time, nu, edges), expected, atol=1e-9)


def test_bin_means_of_a_parabola_are_off_by_the_trapezoid_rule_only():
    time, edges = 0.01 * np.arange(101), np.array([0.0, 0.13, 0.405, 1.0])
    nu = np.repeat(time[:, None] ** 2, 6, axis=1)
    exact = np.diff(edges**3) / 3 / np.diff(edges)
    # h^2 / 12 |f''|
    np.testing.assert_allclose(bin_means(time, nu, edges)[:, 0], exact, atol=1e-4 / 6 + 1e-12)


def test_bins_that_are_not_covered_have_no_mean():
    means = bin_means(np.array([0.0, 1.0]), np.ones((3, 2, 6)), np.array([-0.5, 0.0, 1.0, 1.5]))
    assert means.shape == (3, 3, 6)
    assert np.isnan(means[:, [0, 2]]).all()
    np.testing.assert_allclose(means[:, 1], 1.0)


@given(seed=st.integers(0, 2**32 - 1), n=st.integers(3, 20))
def test_edge_values_of_parabolas_are_exact(seed, n):
    rng = np.random.default_rng(seed)
    edges = np.concatenate([[0.0], np.cumsum(rng.uniform(0.1, 0.3, n))])
    c = rng.normal(size=(3, 2))
    integral = sum(c[k] * edges[:, None] ** (k + 1) / (k + 1) for k in range(3))
    means = np.diff(integral, axis=0) / np.diff(edges)[:, None]
    expected = sum(c[k] * edges[:-1, None] ** k for k in range(3))
    np.testing.assert_allclose(edge_values(edges, means), expected, atol=1e-8)


def test_backward_difference():
    time = np.array([0.0, 0.1, 0.3])
    nu = np.repeat(np.array([[1.0], [2.0], [0.0]]), 6, axis=1)
    nu_dot = backward_difference(nu, time)
    assert np.isnan(nu_dot[0]).all()
    np.testing.assert_allclose(nu_dot[1:, 0], [10.0, -10.0])
