"""What a force nobody named might vary with: the functions that the remainder is held against."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

from rovsim.core.rotations import from_euler, matrix
from rovsim.diagnosis.structure.regressors import tabulate
from rovsim.estimation.observer.sandwich import find_inflation

COUNT, PERIOD = 400, 0.05


@pytest.fixture(scope="module")
def run():
    """A level vehicle that turns while it goes about a tank."""
    t = PERIOD * np.arange(COUNT)
    state = np.zeros((COUNT, 13))
    state[:, :3] = np.column_stack([np.sin(0.4 * t), np.cos(0.7 * t), 0.2 * np.sin(0.3 * t)])
    state[:, 3:7] = [from_euler(0.0, 0.0, yaw) for yaw in 2.0 * np.sin(0.5 * t)]
    state[:, 7:] = np.random.default_rng(1).normal(size=(COUNT, 6))
    motion = SimpleNamespace(state=state, time=t)
    rows = np.array([[0, COUNT]])
    return SimpleNamespace(
        motion=motion,
        innovation_samples=np.arange(COUNT),
        period=PERIOD,
        time=t,
        innovation_segments=rows,
    )


@pytest.mark.parametrize(("on", "along"), [(0, 0), (0, 1), (1, 0), (1, 1)])
def test_what_varies_with_place_in_the_tank_is_among_them_on_the_axes_of_the_body(run, on, along):
    """Water that streams north or east, faster in one place: its push on surge and on sway."""
    table, past = tabulate(run), 4  # readings: functions are those of 0.2 s before
    at = np.clip(np.arange(COUNT) - past, 0, None)
    state = run.motion.state[at]
    place = state[:, along] - np.mean(state[:, along])
    names = [name for name in table if name.startswith("place along") and "heading" in name]
    functions = np.stack([table[name] for name in names])
    for axis in (0, 1):
        push = matrix(state[:, 3:7])[:, on, axis] * place
        left = push - functions.T @ np.linalg.lstsq(functions.T, push, rcond=None)[0]
        assert np.abs(left).max() < 1e-9


def shares(kept, seed, lasting):
    """How often chance seems to explain more of a slow column than 3.84 (1 in 20)."""
    random = np.random.default_rng(seed)
    blocks, found = np.repeat(np.arange(30), 40), []
    for _ in range(300):
        column, target = (lfilter([1.0], [1.0, -k], random.normal(size=1200)) for k in kept)
        target = target / target.std()
        power = column @ column
        factor = column @ target / power
        left = column * (target - factor * column)
        spread = find_inflation(left, power, blocks) if lasting else 1.0
        found.append(factor**2 * power / spread > 3.84)
    return np.mean(found)


def test_what_errs_for_long_does_not_seem_to_vary_with_what_changes_slowly():
    assert shares((0.9, 0.9), 1, lasting=False) > 0.3
    assert shares((0.9, 0.9), 1, lasting=True) < 0.1


def test_white_noise_is_judged_as_before():
    assert shares((0.9, 0.0), 2, lasting=True) == pytest.approx(0.05, abs=0.03)
