"""Velocities that nobody measured go on from one replay to the next."""

from dataclasses import replace

import numpy as np
import pytest

from rovsim.measurement.signals.measured import Measured
from rovsim.simulation.replay import replay, simulate
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from worlds import at_rest, model, motion, sticks

ROTATIONS = np.array([False] * 3 + [True] * 3)
TIME = 8.0


def swum():
    """A model, and its own motion under sticks from rest, of which rotations were read."""
    world, run = model(), motion(sticks(3, 4), seconds=TIME)
    path = simulate(world, run, [(0, len(run.time) - 1, at_rest())], ReplaySettings())[0]
    every = np.ones((len(path), 6), bool)
    measured = Measured(
        np.zeros(3, bool), np.ones(1, bool), ROTATIONS, ROTATIONS, every, np.array([20.0])
    )
    nu = np.where(ROTATIONS, path[:, 7:], 0.0)
    run = replace(run, eta=path[:, :7], nu=nu, state_nu=nu, measured=measured)
    return world, run, path


def test_a_perfect_model_is_perfect_where_only_rotations_were_measured():
    world, run, path = swum()
    count = 200
    firsts = range(0, len(run.time) - count, count)
    assert np.abs(path[firsts[-1], 7:10]).max() > 0.05  # it swims when the last one starts
    starts = [(k, count, run.state[k]) for k in firsts]
    for k, found in zip(firsts, simulate(world, run, starts, ReplaySettings()), strict=True):
        np.testing.assert_allclose(found, path[k : k + count + 1], atol=1e-9)


def test_what_was_measured_is_started_from_as_measured():
    world, run, _ = swum()
    whole = replace(run, measured=None)
    starts = [(0, 100, run.state[0]), (400, 100, run.state[400])]
    found = simulate(world, whole, starts, ReplaySettings())[1]
    np.testing.assert_array_equal(found[0], run.state[400])


def test_windows_of_the_comparison_profit():
    world, run, path = swum()
    found = replay(world, run, SimulationSettings().only(2.0), open_loop=False)
    nu = found.horizons["2"].nu
    assert np.nanmax(np.abs(nu[:, :3] - path[:, 7:10])) == pytest.approx(0.0, abs=0.02)
