"""What the motion capture reports: laws of the view, and replay and training behind it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rovsim.core.rotations import exp, log, matrix, multiply, normalized
from rovsim.dynamics.effects.sensing import MarkerMisalignment, MarkerOffset, WorldTilt
from rovsim.measurement.signals.chain import SignalSettings, filter_and_differentiate
from rovsim.measurement.signals.filter import Butterworth
from rovsim.simulation.replay import replay, simulate
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from worlds import at_rest, model, motion, sticks

places = arrays(float, 3, elements=st.floats(-1, 1))
states = arrays(float, 13, elements=st.floats(-1, 1)).filter(lambda s: np.linalg.norm(s[3:7]) > 0.1)
OPEN = SimulationSettings(signals=SignalSettings(filter=Butterworth(cutoff=40.0)))


def seen(offset, turn, tilt):
    """A model whose motion capture is wrong in all three ways."""
    return model(
        WorldTilt(roll=tilt[0], pitch=tilt[1]),
        MarkerMisalignment(roll=turn[0], pitch=turn[1], yaw=turn[2]),
        MarkerOffset(x=offset[0], y=offset[1], z=offset[2]),
    )


BAD = seen([0.1, -0.05, 0.2], [0.05, 0.1, -0.2], [0.03, -0.04])


@given(state=states, offset=places, turn=places, tilt=places)
def test_seen_and_turned_back_is_the_truth(state, offset, turn, tilt):
    state[3:7] = normalized(state[3:7])
    view = seen(offset, turn, tilt).mocap_view
    np.testing.assert_allclose(view.inverse.states(view.states(state)), state, atol=1e-12)
    np.testing.assert_allclose(view.inverse.twist @ view.twist, np.eye(6), atol=1e-12)


@given(state=states, offset=places, turn=places, tilt=places)
def test_a_pose_is_seen_as_the_contract_says(state, offset, turn, tilt):
    """p = W (p_CO + R offset), R = W R exp(turn): written out with matrices."""
    state[3:7] = normalized(state[3:7])
    W, R, T = (matrix(q) for q in (exp(np.array([*tilt[:2], 0])), state[3:7], exp(turn)))
    found = seen(offset, turn, tilt).mocap_view.poses(state[:7])
    np.testing.assert_allclose(found[:3], W @ (state[:3] + R @ offset), atol=1e-12)
    np.testing.assert_allclose(matrix(found[3:]), W @ R @ T, atol=1e-12)


def test_a_view_that_changes_nothing_gives_back_the_same_array():
    state = np.random.default_rng(0).normal(size=(5, 13))
    view = seen(np.zeros(3), np.zeros(3), np.zeros(3)).mocap_view
    assert view.states(state) is state
    assert view.inverse.poses(state) is state
    assert view.twists(state) is state


def driven(world, seconds=4.0):
    """A run as an ideal motion capture with the model's faults reports it."""
    start = at_rest()
    start[3:7] = multiply(exp(np.array([0.0, 0.0, 0.6])), start[3:7])
    start[7:] = [0.2, 0.1, -0.1, 0.1, 0.2, -0.2]
    run = motion(0.6 * sticks(7, 1), seconds=seconds, start=start)
    true = simulate(world, run, [(0, len(run.time) - 1, start)], ReplaySettings())[0]
    shown = world.mocap_view.states(true)
    nu, nu_dot = filter_and_differentiate(shown[:, :7], 0.01, OPEN.signals)
    usable = (run.time > 0.2) & (run.time < seconds - 0.2)
    return true, replace(
        run, eta=shown[:, :7], nu=nu, nu_dot=nu_dot, state_nu=shown[:, 7:], usable=usable
    )


def test_the_twist_is_the_derivative_of_the_reported_pose():
    _, run = driven(BAD)
    inside = run.usable
    assert np.sqrt(np.mean((run.nu - run.state_nu)[inside] ** 2)) < 5e-4


def test_replay_predicts_what_is_reported():
    _, run = driven(BAD)
    wrong = replay(model(), run, OPEN).horizons["2"]
    compared = 0
    for prediction in replay(BAD, run, OPEN).horizons.values():
        both = run.usable & np.isfinite(prediction.eta[:, 0])
        np.testing.assert_allclose(prediction.eta[both], run.eta[both], atol=1e-9)
        compared += np.sum(both)
    assert compared > 0
    assert np.nanmax(np.abs(wrong.eta - run.eta)) > 0.02


def test_a_residual_learns_in_true_axes():
    """Behind the right view nothing is left to learn, and the features are the true motion."""
    true, run = driven(BAD)
    found = sample_run(BAD, run, OPEN)
    blind = sample_run(model(), run, OPEN)
    np.testing.assert_allclose(
        log(multiply(found.attitude * [1, -1, -1, -1], true[found.index, 3:7])), 0, atol=1e-9
    )
    assert np.sqrt(np.mean((found.nu - true[found.index, 7:]) ** 2)) < 5e-4
    inner = (found.index > 100) & (found.index < 300)  # clear of the filter's ends
    assert np.sqrt(np.mean(found.a_res[inner] ** 2)) < 0.1 * np.sqrt(np.mean(blind.a_res**2))


def test_binned_recordings_are_turned_back_too():
    _, run = driven(BAD)
    time = run.time[:-1:10]
    means = np.add.reduceat(run.state_nu[:-1], np.arange(0, 400, 10)) / 10
    bins = replace(
        run,
        time=time,
        eta=run.eta[:-1:10],
        nu=means,
        nu_dot=0 * means,
        usable=run.usable[:-1:10],
        state_nu=run.state_nu[:-1:10],
        binned=True,
        end=float(run.time[-1]),
    )
    found = replay(BAD, bins, OPEN).horizons["2"]
    known = bins.usable & np.isfinite(found.nu[:, 0])
    assert known.sum() > 10
    error = np.sqrt(np.mean((found.nu - means)[known] ** 2, axis=0))
    assert error == pytest.approx(np.zeros(6), abs=0.02)  # samples are 10 ms apart, bins 100 ms
    blind = replay(model(), bins, OPEN).horizons["2"]
    assert np.max(np.sqrt(np.mean((blind.nu - means)[known] ** 2, axis=0)) / error) > 3
