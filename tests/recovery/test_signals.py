"""Planted outliers are found, honest motion is kept, and the true velocity comes back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovsim.core import rotations
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.chain import SignalSettings, clean
from rovsim.measurement.signals.outliers import Hampel, VelocityGate, find_outliers

RATE, NOISE, ANGLE_NOISE = 100.0, 0.5e-3, 2e-3


def truth(t, speed=0.6, rate=1.5, hz=0.25):
    """Poses and nu: surge and heave along a turning body, speeds up to `speed` and `rate`."""
    w = 2 * np.pi * hz
    yaw, yaw_rate = rate / w * np.sin(w * t), rate * np.cos(w * t)
    p = np.stack([speed / w * np.sin(w * t), 0.1 * t, speed / w / 2 * np.cos(w * t)], axis=1)
    p_dot = np.stack([speed * np.cos(w * t), 0.1 + 0 * t, -speed / 2 * np.sin(w * t)], axis=1)
    c, s = np.cos(yaw), np.sin(yaw)
    v = np.stack([c * p_dot[:, 0] + s * p_dot[:, 1], c * p_dot[:, 1] - s * p_dot[:, 0]], axis=1)
    nu = np.column_stack([v, p_dot[:, 2], 0 * t, 0 * t, yaw_rate])
    return np.concatenate([p, rotations.from_euler(0 * t, 0 * t, yaw)], axis=1), nu


def noisy(eta, rng):
    turn = rotations.exp(ANGLE_NOISE * rng.normal(size=(len(eta), 3)))
    position = eta[:, :3] + NOISE * rng.normal(size=(len(eta), 3))
    return np.concatenate([position, rotations.multiply(eta[:, 3:], turn)], axis=1)


def record(time, eta, found=None, nu=None, rate=RATE):
    found = np.ones(len(time), bool) if found is None else found
    eta = np.where(found[:, None], eta, np.nan)
    commands = Commands(time[:1], np.zeros((1, 8)), "thruster")
    run = RunInfo("3dof-1", "3dof", "train")
    return Recording(run, Site.unknown(), time, eta[:, :3], eta[:, 3:], found, commands, rate, nu)


def swap_markers(eta, at, length, size, turn, rng):
    """Displace `length` frames from `at` by about `size` m and `turn` rad, each differently."""
    k = slice(at, at + length)
    count = len(eta[k])
    way = rng.normal(size=(2, count, 3))
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    eta[k, :3] += size * rng.uniform(1, 1.5, (count, 1)) * way[0]
    eta[k, 3:] = rotations.multiply(eta[k, 3:], rotations.exp(turn * way[1]))
    return np.arange(at, at + count)


@pytest.mark.parametrize("method", [VelocityGate(), Hampel()], ids=lambda m: m.kind)
@settings(deadline=None, max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    size=st.floats(0.05, 1.0),
    turn=st.floats(0.2, 1.0),
    lengths=st.lists(st.integers(1, 4), min_size=1, max_size=6),
)
def test_swapped_markers_are_found_and_nothing_else(method, seed, size, turn, lengths):
    rng = np.random.default_rng(seed)
    t = np.arange(1000) / RATE
    eta = noisy(truth(t)[0], rng)
    found = np.ones(len(t), bool)
    found[500:520] = False
    planted = np.zeros(len(t), bool)
    # the ends too; only the gate can judge the first frames after a dropout
    places = [0, 300, 520 if method.kind == "velocity_gate" else 600, 700, 800, 1000 - lengths[-1]]
    for at, length in zip(places, lengths, strict=False):
        planted[swap_markers(eta, at, length, size, turn, rng)] = True
    mask = find_outliers(record(t, eta, found), method)
    np.testing.assert_array_equal(np.flatnonzero(mask), np.flatnonzero(planted))


@settings(deadline=None, max_examples=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_frames_that_jut_out_by_as_much_as_a_step_take_no_good_ones_with_them(seed):
    """Of single frames some are within reach of one side alone: a quarter of a run went."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 30.0, 1.0 / RATE)
    eta = noisy(truth(t)[0], rng)
    off = 20 + 48 * np.arange(60) + rng.integers(0, 20, 60)  # never two in a row
    eta[off, :3] += rng.normal(scale=0.012, size=(60, 3))
    rejected = find_outliers(record(t, eta), VelocityGate())
    assert not rejected[np.setdiff1d(np.arange(len(t)), off)].any()


def test_a_body_held_swapped_for_a_moment_is_found_whole():
    """The same displacement for 0.2 s: half as far as the body could travel in that time."""
    rng = np.random.default_rng(5)
    t = np.arange(600) / RATE
    eta = noisy(truth(t)[0], rng)
    eta[300:320, :3] += [0.1, 0.05, 0.0]
    mask = find_outliers(record(t, eta), VelocityGate())
    np.testing.assert_array_equal(np.flatnonzero(mask), np.arange(300, 320))


@pytest.mark.parametrize("method", [VelocityGate(), Hampel()], ids=lambda m: m.kind)
@settings(deadline=None, max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    speed=st.floats(0, 1.2),
    rate=st.floats(0, 4.0),
    hz=st.floats(0.1, 0.8),
    dropped=st.floats(0, 0.3),
)
def test_fast_honest_motion_is_kept(method, seed, speed, rate, hz, dropped):
    rng = np.random.default_rng(seed)
    t = np.arange(1000) / RATE
    found = rng.random(len(t)) >= dropped
    mask = find_outliers(record(t, noisy(truth(t, speed, rate, hz)[0], rng), found), method)
    assert not mask.any()


@settings(deadline=None, max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    camera=st.sampled_from([8.0, 10.0, 20.0, 25.0]),
    speed=st.floats(0, 1.2),
    rate=st.floats(0, 4.0),
    hz=st.floats(0.1, 0.8),
    jitter=st.floats(0, 0.1),
    dropped=st.floats(0, 0.2),
)
def test_fast_honest_motion_is_kept_of_slow_cameras(seed, camera, speed, rate, hz, jitter, dropped):
    rng = np.random.default_rng(seed)
    t = (np.arange(600) + jitter * rng.uniform(-1, 1, 600)) / camera
    found = rng.random(len(t)) >= dropped
    eta = noisy(truth(t, speed, rate, hz)[0], rng)
    assert not find_outliers(record(t, eta, found, rate=camera), VelocityGate()).any()


@pytest.mark.parametrize("camera", [10.0, 20.0])
def test_a_vehicle_that_is_stopped_dead_is_kept(camera):
    t = np.arange(400) / camera
    eta = noisy(truth(t, speed=0.0, rate=0.0)[0], np.random.default_rng(3))
    for shift in (0.0, 0.3, 0.7):
        eta[:, 0] = np.minimum(1.4 * t, 1.4 * (10.0 + shift / camera))
        assert not find_outliers(record(t, eta, rate=camera), VelocityGate()).any()


@settings(deadline=None, max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    size=st.floats(0.08, 1.0),
    turn=st.floats(0.0, 1.0),
    hz=st.floats(0.1, 0.4),
)
def test_a_jump_of_one_frame_is_found_of_slow_cameras(seed, size, turn, hz):
    """Below what the vehicle could travel in a step of 0.1 s, too."""
    rng = np.random.default_rng(seed)
    t = np.arange(400) / 10.0
    eta = noisy(truth(t, hz=hz)[0], rng)
    places = np.sort(rng.choice(np.arange(2, 66), 4, replace=False)) * 6
    for at in places:
        swap_markers(eta, at, 1, size, turn, rng)
    mask = find_outliers(record(t, eta, rate=10.0), VelocityGate())
    np.testing.assert_array_equal(np.flatnonzero(mask), places)


@pytest.mark.parametrize("lost", [3, 2, 1])
def test_a_good_frame_before_a_jump_and_a_dropout_is_kept(lost):
    t = np.arange(400) / 10.0
    eta = noisy(truth(t)[0], np.random.default_rng(4))
    eta[200, :3] += [0.0, 0.12, 0.0]
    found = np.arange(400) != 200 + lost
    mask = find_outliers(record(t, eta, found, rate=10.0), VelocityGate())
    assert set(np.flatnonzero(mask)) <= {200}


@settings(deadline=None, max_examples=10)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_velocity_comes_back_to_within_the_noise_that_theory_leaves(seed):
    """Outliers, dropouts and jittered stamps in, sound velocities out.

    Theory for white noise through the default filter: 5.1 /s times the noise (tests/laws), so
    2.5 mm/s and 10 mrad/s.
    """
    rng = np.random.default_rng(seed)
    t = np.sort(np.arange(3000) / RATE + rng.uniform(-0.002, 0.002, 3000))
    eta = noisy(truth(t)[0], rng)
    found = np.ones(len(t), bool)
    for start, length in zip(range(100, 2900, 400), (1, 3, 5, 8, 30, 50, 7), strict=True):
        found[start : start + length] = False
        swap_markers(eta, start + 150, 2, 0.1, 0.4, rng)
    motion = clean(record(t, eta, found), SignalSettings())
    assert len(motion.segments()) == 3
    error = (motion.nu - truth(motion.time)[1])[motion.usable]
    rms = np.sqrt(np.mean(error**2, axis=0))
    # plus bridged gaps and margins; a standard error of 4 % from 28 s of 5 Hz noise
    assert rms[:3].max() < 1.2 * 5.1 * NOISE
    assert rms[3:].max() < 1.2 * 5.1 * ANGLE_NOISE
    start = [first for first, _ in motion.segments()]
    off = np.abs(motion.nu - truth(motion.time)[1])[start]
    assert off[:, :3].max() < 6 * 5.1 * NOISE
    assert off[:, 3:].max() < 6 * 5.1 * ANGLE_NOISE


@settings(deadline=None, max_examples=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_states_between_bin_means_are_the_instantaneous_ones(seed):
    rng = np.random.default_rng(seed)
    edges = np.concatenate([[0.0], np.cumsum(rng.choice([0.1, 0.2], 200))])
    fine = np.arange(0, edges[-1] + 0.0005, 0.001)
    eta, nu = truth(fine)

    def means(x):
        area = np.concatenate([[0 * x[0]], np.cumsum(0.5 * (x[1:] + x[:-1]), axis=0)]) * 0.001
        at = np.stack([np.interp(edges, fine, column) for column in area.T], axis=1)
        return np.diff(at, axis=0) / np.diff(edges)[:, None]

    found = np.ones(200, bool)
    found[80] = False
    motion = clean(record(edges[:-1], means(eta), found, means(nu)), SignalSettings())
    true_eta, true_nu = truth(motion.time)
    # lost: the rows at the start and the end, the missing one, and the one after it
    assert motion.segments() == [(1, 80), (82, 199)]
    # A cubic spline is off by h^3 / 24 |x''''| in its derivative (Hall & Meyer 1976), x' the
    # velocity here; the second edge of a not-a-knot spline may be off by twice that.
    third = nu
    for _ in range(3):
        third = np.gradient(third, fine, axis=0, edge_order=2)
    bound = 0.2**3 / 24 * np.abs(third[10:-10]).max()
    deep = motion.usable.copy()
    deep[[1, 2, 3, 4, 76, 77, 78, 79, 82, 83, 84, 85, 195, 196, 197, 198]] = False
    error = np.abs(motion.state_nu - true_nu)
    assert error[deep].max() < bound
    assert error[motion.usable].max() < 2 * bound
    # poses: the same with smaller derivatives; shortening of the mean quaternion is scaled out
    assert np.abs(motion.eta - true_eta)[motion.usable].max() < 2 * bound
    np.testing.assert_allclose(
        motion.nu_dot[1:], np.diff(motion.nu, axis=0) / np.diff(motion.time)[:, None]
    )


def test_rows_beside_missing_bins_are_not_usable():
    time = np.delete(0.15 * np.arange(40), [20, 21, 22])
    nu = np.ones((37, 6))
    motion = clean(record(time, truth(time)[0], None, nu), SignalSettings())
    assert motion.segments() == [(1, 19), (21, 36)]
    assert motion.end == pytest.approx(time[-1] + 0.15)
