"""The smooth force that is left: as close to the truth as its own model can come."""

import numpy as np
import pytest

from rovsim.diagnosis.equations.disturbance import smooth_stretch
from rovsim.diagnosis.observer.axis_kernels import POSE
from rovsim.diagnosis.observer.kalman import AxisMotion, AxisNoise, design_filter

PERIOD, NOISE, COUNT = 0.05, AxisNoise(0.1, 1.0, 1e-3), 4000


@pytest.fixture(scope="module")
def told():
    """A disturbance (n,) drawn from the model, and what its smoother tells of it."""
    f = design_filter(POSE, PERIOD, AxisMotion(0.5), NOISE)
    rng, n = np.random.default_rng(2), len(f.C)
    x, seen, truth, white = np.zeros(n), np.zeros(n), np.empty(COUNT), np.empty(COUNT)
    kick = NOISE.level * np.sqrt(1.0 - f.decay**2)
    for k in range(COUNT):
        x = f.F @ x
        x[2] += kick * rng.normal()
        truth[k] = x[2]
        seen = f.F @ seen
        e = f.C @ (x - seen) + NOISE.reading * rng.normal()
        seen = seen + f.gain * e
        white[k] = e / np.sqrt(f.variance)
    return truth, white, smooth_stretch(white, f, PERIOD, NOISE.level, NOISE.memory)


def test_the_innovations_are_white(told):
    _, white, _ = told
    assert np.std(white) == pytest.approx(1.0, abs=0.05)
    assert abs(np.mean(white[1:] * white[:-1])) < 0.05


def test_a_disturbance_is_found_in_its_place_and_size(told):
    truth, _, found = told
    error = found - truth
    assert np.std(error) < 0.45 * NOISE.level  # a filter, without later readings, has 0.65 of it
    assert np.corrcoef(found, truth)[0, 1] > 0.9
    later = [np.mean((found - np.roll(truth, k)) ** 2) for k in (-4, -2, 0, 2, 4)]
    assert int(np.argmin(later)) == 2  # neither early nor late
    assert abs(np.mean(error * found)) < 0.1 * np.var(found)  # what is left cannot be told
