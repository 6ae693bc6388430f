"""Noise of cameras that err for a while, at uneven times, or not in every frame is no filter."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovsim.core import gauss_markov
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.low_pass import LowPass
from rovsim.estimation.observer.camera import fit_smoothing
from rovsim.estimation.observer.camera_noise import describe_noise

FRAMES, PERIOD = 12_000, 0.01  # two minutes
WHITE = 1.0


def draw(random, ratio, memory, uneven=0.0, lost=0.0):
    """Poses (n, 6) of a vehicle at rest, put on the clock from `uneven` stamps s, some `lost`."""
    poses = WHITE * random.normal(size=(FRAMES, 6))
    poses += ratio * WHITE * gauss_markov.draw(FRAMES, PERIOD / memory, random)
    clock = PERIOD * np.arange(FRAMES)
    stamps = np.sort(clock + random.uniform(-uneven, uneven, FRAMES))
    seen = random.random(FRAMES) >= lost
    return np.stack([np.interp(clock, stamps[seen], column[seen]) for column in poses.T], axis=1)


def told(poses):
    """What their noise tells."""
    return fit_smoothing([describe_noise(np.diff(poses, 2, axis=0).T, PERIOD)])


@settings(max_examples=10)
@given(
    st.floats(0.0, 6.0),
    st.floats(0.02, 3.0),
    st.floats(0.0, 0.004),
    st.floats(0.0, 0.2),
    st.integers(0, 99),
)
def test_no_filter_is_seen_where_there_is_none(ratio, memory, uneven, lost, seed):
    assert told(draw(np.random.default_rng(seed), ratio, memory, uneven, lost)) is None


@pytest.mark.parametrize(
    ("cutoff", "ratio", "uneven"),
    [
        (4.0, 0.0, 0.0),
        (8.0, 0.0, 0.0),
        (16.0, 0.0, 0.0),
        (8.0, 0.0, 0.002),
        (16.0, 0.0, 0.002),
        (8.0, 3.0, 0.0),
        (16.0, 3.0, 0.0),
    ],
)
def test_a_filter_is_seen_and_its_cutoff_left_open(cutoff, ratio, uneven):
    smooth = LowPass(PoseFilter(cutoff=cutoff).time_constants())
    poses = draw(np.random.default_rng(5), ratio, 1.0, uneven)
    found = told(smooth.smooth(poses, PERIOD))
    assert found is not None
    assert found.lowest <= cutoff <= found.highest
    if not ratio and not uneven:
        assert abs(found.cutoff - cutoff) < max(4.0 * found.std, 0.03 * cutoff)
