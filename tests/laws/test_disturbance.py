"""The smooth force that is left: as close to the truth as its own model can come, and how fast."""

import numpy as np
import pytest
from scipy.signal import lfilter

from rovsim.diagnosis.equations.disturbance import smooth_stretch
from rovsim.diagnosis.equations.spectrum import SEGMENT_SECONDS, find_spectrum
from rovsim.estimation.kernels.axis import POSE
from rovsim.estimation.observer.kalman import AxisErrorDynamics, AxisNoise, design_filter

PERIOD, NOISE, COUNT = 0.05, AxisNoise(0.1, 1.0, 1e-3), 4000


TIME = PERIOD * np.arange(COUNT)  # s


def observe(truth):
    """Whitened innovations (n,) of a filter that reads what a push (n,) does, and its smoother."""
    f = design_filter(POSE, PERIOD, AxisErrorDynamics(0.5), NOISE)
    rng, n = np.random.default_rng(2), len(f.C)
    x, seen, white = np.zeros(n), np.zeros(n), np.empty(COUNT)
    for k in range(COUNT):
        x = f.F @ x
        x[2] = truth[k]
        seen = f.F @ seen
        e = f.C @ (x - seen) + NOISE.measurement_std * rng.normal()
        seen = seen + f.gain * e
        white[k] = e / np.sqrt(f.variance)
    return white, smooth_stretch(white, f, PERIOD, NOISE.disturbance_std, NOISE.correlation_time)


@pytest.fixture(scope="module")
def told():
    """A disturbance (n,) drawn from the model, and what its smoother tells of it."""
    fade = np.exp(-PERIOD / NOISE.correlation_time)
    std = NOISE.disturbance_std * np.sqrt(1.0 - fade**2)
    kicks = std * np.random.default_rng(1).normal(size=COUNT)
    truth = lfilter([1.0], [1.0, -fade], kicks)
    return truth, *observe(truth)


def test_the_innovations_are_white(told):
    _, white, _ = told
    assert np.std(white) == pytest.approx(1.0, abs=0.05)
    assert abs(np.mean(white[1:] * white[:-1])) < 0.05


def test_a_disturbance_is_found_in_its_place_and_size(told):
    truth, _, found = told
    error = found - truth
    # a filter, without later readings, has 0.65 of it
    assert np.std(error) < 0.45 * NOISE.disturbance_std
    assert np.corrcoef(found, truth)[0, 1] > 0.9
    later = [np.mean((found - np.roll(truth, k)) ** 2) for k in (-4, -2, 0, 2, 4)]
    assert int(np.argmin(later)) == 2  # neither early nor late
    assert abs(np.mean(error * found)) < 0.1 * np.var(found)  # what is left cannot be told


def along(axis, force):
    """A force (n,) on one axis, as (n, 6)."""
    return np.outer(force, np.eye(6)[axis])


def test_a_push_that_swings_has_its_peak_where_it_swings():
    """3 N at 0.2 Hz, read by cameras: through the smoother the peak stays, and nearly its size."""
    swing = 3.0 * NOISE.disturbance_std * np.sin(2.0 * np.pi * 0.2 * TIME)
    found = find_spectrum([along(1, observe(swing)[1])], PERIOD)
    peak = np.argmax(found.density[:, 1])
    assert found.frequency[peak] == pytest.approx(0.2)
    step = found.frequency[1]
    near = found.density[peak - 2 : peak + 3, 1].sum() * step
    assert near == pytest.approx(np.var(swing), rel=0.2)
    low, high = found.find_band(1)
    assert 0.1 <= low <= 0.2 <= high <= 0.3
    assert not found.density[:, [0, 2, 3, 4, 5]].any()


def test_a_white_force_is_flat_and_as_strong_as_it_was_made():
    rng = np.random.default_rng(4)
    std, count = 2.0, round(40 * SEGMENT_SECONDS / PERIOD)  # N
    runs = [along(0, std * rng.normal(size=n)) for n in (count, count // 2)]
    found = find_spectrum(runs, PERIOD)
    inner = found.density[2:-2, 0]  # not where the mean was taken out, nor at half the rate
    halves = [half.mean() for half in np.array_split(inner, 2)]
    np.testing.assert_allclose(halves, 2.0 * std**2 * PERIOD, rtol=0.05)
    assert np.std(inner) < 0.2 * np.mean(inner)
    assert found.find_band(0) == pytest.approx((0.1 * 10.0, 0.9 * 10.0), rel=0.1)


def test_a_longer_run_counts_more_and_a_push_that_lasts_does_not():
    count = round(10 * SEGMENT_SECONDS / PERIOD)
    still, swings = np.zeros(count), np.sin(2.0 * np.pi * 0.5 * PERIOD * np.arange(3 * count))
    runs = [along(5, still + 4.0), along(5, swings + 4.0), along(5, np.ones(20))]
    found = find_spectrum(runs, PERIOD)
    assert np.sum(found.density[:, 5]) * found.frequency[1] == pytest.approx(0.75 * 0.5, rel=0.01)
    assert found.density[0, 5] < 1e-9
