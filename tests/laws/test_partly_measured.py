"""Runs of which parts were measured: what was not counts nowhere, alone or beside other runs."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numba import njit
from scipy.spatial.transform import Rotation

from rovsim.core.axes import AXES
from rovsim.dynamics.effects.damping import QuadraticDamping
from rovsim.dynamics.engine.observer import along_body
from rovsim.evaluation.error_metrics import ErrorSums, subtract
from rovsim.evaluation.growth import GrowthScore
from rovsim.evaluation.ladder import score_step
from rovsim.evaluation.score_collector import ScoreCollector
from rovsim.measurement.signals.measured import Measured
from rovsim.simulation.replay import replay, simulate
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from worlds import at_rest, model, motion, sticks

ROTATIONS = np.array([False] * 3 + [True] * 3)
READ, UNREAD = AXES[3:], AXES[:3]
HORIZONS = SimulationSettings().only(2.0, 5.0)


def flown(seed: int, turns_alone: bool):
    """A test run of a model under sticks, and how a wrong model replays it."""
    truth, run = model(), motion(sticks(seed, 6), seconds=12.0)
    path = simulate(truth, run, [(0, len(run.time) - 1, at_rest())], ReplaySettings())[0]
    run = replace(run, run=replace(run.run, split="test"), eta=path[:, :7])
    nu, measured = path[:, 7:], None
    if turns_alone:
        every = np.ones((len(path), 6), bool)
        measured = Measured(
            np.zeros(3, bool), np.ones(1, bool), ROTATIONS, ROTATIONS, every, np.array([20.0])
        )
        nu = np.where(ROTATIONS, nu, 0.0)
    slope = np.gradient(nu, run.time, axis=0)
    run = replace(run, nu=nu, state_nu=nu, nu_dot=slope, measured=measured)
    wrong = truth + QuadraticDamping(surge=40.0, sway=40.0, yaw=2.0)
    return run, replay(wrong, run, HORIZONS, open_loop=False)


@pytest.fixture(scope="module")
def runs():
    return [flown(3, turns_alone=False), flown(5, turns_alone=True)]


def errors(run, replayed):
    return subtract(run, replayed.horizons["2"])


def test_a_run_without_velocities_takes_nothing_from_those_of_another(runs):
    whole, both = ErrorSums.of(errors(*runs[0])).metrics(), score_step("wrong", runs)
    assert both.windows_2s is not None
    for axis in UNREAD:
        assert both.velocity_mae[axis] == pytest.approx(whole.velocity_mae[axis])
        assert both.acceleration_rmse[axis] == pytest.approx(whole.acceleration_rmse[axis])
    together = np.concatenate([errors(*one).nu[:, 5] for one in runs])
    assert both.velocity_mae["yaw"] == pytest.approx(np.abs(together).mean())


def test_of_a_run_without_velocities_only_turns_are_scored(runs):
    metrics, step = ErrorSums.of(errors(*runs[1])).metrics(), score_step("wrong", runs[1:])
    assert all(metrics.velocity_rmse[axis] is None for axis in UNREAD)
    assert all(metrics.velocity_rmse[axis] > 0.0 for axis in READ)
    assert (metrics.position_rmse_m, metrics.attitude_rmse_rad is None) == (None, False)
    assert step.windows_2s is not None


def test_the_growth_of_the_error_is_that_of_measured_axes(runs):
    def grown(some):
        score = GrowthScore(5.0)
        for run, replayed in some:
            score.add(run, replayed.horizons["5"])
        return score.curve.velocity_rmse

    alone, whole, both = grown(runs[1:]), grown(runs[:1]), grown(runs)
    for axis in UNREAD:
        assert set(alone[axis]) == {None}
        assert both[axis] == pytest.approx(whole[axis])
    assert both["yaw"] != pytest.approx(whole["yaw"])
    assert max(alone["yaw"]) > 0.01


@pytest.mark.parametrize("horizons", [(0.5, 2.0), (2.0, 5.0), (2.0, 4.0, 8.0)])
def test_the_growth_of_the_error_is_seen_in_the_longest_windows(runs, horizons):
    motion, _ = runs[0]
    settings = SimulationSettings().only(*horizons)
    replayed = replay(model(), motion, settings)
    scored = ScoreCollector(["nominal"], settings.replay.longest)
    scored.add_replay(motion, replayed)
    seen = scored.growth.models["nominal"].horizon_s
    assert seen[-1] == pytest.approx(max(horizons))
    assert max(np.diff(seen)) == pytest.approx(max(0.2, max(horizons) / 25))
    assert (
        ScoreCollector.of([motion], {"nominal": {motion.run.id: replayed}}).growth == scored.growth
    )


@njit
def turned_to_body(v, q, measured):
    """As kernels call it."""
    return along_body(v, q, measured)


angles = st.floats(-np.pi, np.pi)


@given(st.lists(st.floats(-3.0, 3.0), min_size=6, max_size=6), st.tuples(angles, angles, angles))
def test_a_correction_stays_where_it_is_in_the_world_however_far_a_vehicle_tilts(v, euler):
    """Upside down, a depth that is too small says that the vehicle moves up along its own heave."""
    assume(abs(np.cos(euler[1])) > 1e-3)  # where it looks straight up it has no heading
    # a pitch beyond a right angle is another heading
    yaw = euler[0] + np.pi * (np.cos(euler[1]) < 0.0)
    R, level = Rotation.from_euler("ZYX", euler), Rotation.from_euler("Z", yaw)
    q = tuple(R.as_quat(scalar_first=True))
    partly, whole = np.array([0.0, 0.0, 1.0, 1.0, 1.0]), np.array([1.0, 1.0, 1.0, 1.0, 0.0])
    turned = turned_to_body(tuple(v), q, partly)
    np.testing.assert_allclose(R.apply(turned[:3]), level.apply(v[:3]), atol=1e-6)
    np.testing.assert_array_equal(turned[3:], v[3:])
    np.testing.assert_array_equal(turned_to_body(tuple(v), q, whole), v)
