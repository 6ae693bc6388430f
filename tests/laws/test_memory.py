"""The water's memory: exact filter, second order, and windows that know the past."""

from dataclasses import replace

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.dynamics.effects.current import Current
from rovsim.dynamics.effects.damping import LinearDamping
from rovsim.dynamics.effects.fluid_memory import SQUARED_ARM, FluidMemory
from rovsim.dynamics.low_pass import LowPass
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.measurement.signals.filter import Butterworth
from rovsim.simulation.initial_memory import measured_memory
from rovsim.simulation.replay import replay, simulate
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from worlds import at_rest, model, motion, sticks

OPEN = SimulationSettings(signals=SignalSettings(filter=Butterworth(cutoff=40.0)))
WAKE = FluidMemory(coefficient=20.0, time_constant=0.6)
WATER = Current(north=0.1)


def test_the_filter_is_exact_for_lines():
    """m of nu = 1 + 2 t, zero at the start: 1 + 2 (t - T) + (2 T - 1) exp(-t / T)."""
    t, T = np.arange(0, 3, 0.25), 0.7
    exact = 1 + 2 * (t - T) + (2 * T - 1) * np.exp(-t / T)
    lines = (1 + 2 * t)[:, None]
    smooth = LowPass((T,)).smooth(lines, 0.25, first=np.zeros((1, 1)), straight=True)
    np.testing.assert_allclose(smooth[:, 0], exact, atol=1e-12)


def moved(world, step=0.01, seconds=6.0, commands=None):
    start = at_rest()
    start[7:] = [0.3, 0.1, -0.1, 0.1, 0.2, -0.2]
    run = motion(sticks(7, 30) if commands is None else commands, seconds=seconds, start=start)
    count = len(run.time) - 1
    path = simulate(world, run, [(0, count, start)], ReplaySettings(step=step))[0]
    return replace(run, eta=path[:, :7], nu=path[:, 7:], state_nu=path[:, 7:])


def test_a_step_is_of_second_order():
    world, steady = model(WAKE, WATER), 0.5 * sticks(3, 1)
    ends = [moved(world, h, 2.0, steady).nu[-1] for h in (0.01, 0.005, 0.0025, 0.000625)]
    errors = [np.abs(end - ends[-1]).max() for end in ends[:-1]]
    assert errors[0] < 1e-5
    assert errors[0] / errors[1] > 3.5


def test_long_forgotten_water_is_drag_and_long_remembered_water_none():
    """T to infinity: linear damping by c. T to 0: m follows at once, and no force is left."""
    drag = {axis: 20.0 for axis in ("surge", "sway", "heave")}
    drag |= {axis: 20.0 * SQUARED_ARM for axis in ("roll", "pitch", "yaw")}
    slow, fast = (moved(model(FluidMemory(coefficient=20.0, time_constant=T))) for T in (1e6, 0.01))
    np.testing.assert_allclose(slow.nu, moved(model(LinearDamping(**drag))).nu, atol=1e-4)
    plain = moved(model()).nu
    assert np.abs(fast.nu - plain).max() < 0.2 * np.abs(slow.nu - plain).max()


def test_the_measured_memory_is_the_integrated_one_and_windows_start_from_it():
    world = model(WAKE, WATER)
    run = moved(world)
    found = replay(world, run, OPEN)
    for prediction in found.horizons.values():
        known = np.isfinite(prediction.eta[:, 0])
        assert known.any()
        np.testing.assert_allclose(prediction.eta[known], run.eta[known], atol=1e-5)
    gap = run.usable.copy()
    gap[250:260] = False
    m = measured_memory(world, run, run.time)
    unseen = np.where(gap[:, None], run.state_nu, np.nan)
    bridged = measured_memory(world, replace(run, usable=gap, state_nu=unseen), run.time)
    assert 0 < np.abs(m - bridged).max() < 0.02
    fine = replace(
        run,
        time=run.time[::3],
        eta=run.eta[::3],
        state_nu=run.state_nu[::3],
        usable=run.usable[::3],
    )
    np.testing.assert_allclose(measured_memory(world, fine, run.time[::3]), m[::3], atol=5e-3)


def test_training_sees_the_remembered_water():
    world = model(WAKE, WATER)
    steady = moved(world, commands=0.5 * sticks(3, 1))
    rate = np.gradient(steady.nu, 0.01, axis=0)
    run = replace(steady, nu_dot=rate)
    clear = slice(50, -50)
    left = [np.abs(sample_run(w, run, OPEN).a_res[clear]).max() for w in (world, model(WATER))]
    assert left[0] < 0.05 * left[1]


def test_two_memories_are_refused_and_none_remembers_nothing():
    twice = model(WAKE, WAKE)
    assert not twice.possible
    with pytest.raises(BadInput, match="2 effects with a fluid memory"):
        _ = twice.constants
    assert measured_memory(model(FluidMemory()), moved(model()), np.zeros(1)).size == 0


def test_what_is_left_out_of_a_comparison_is_remembered():
    """A stretch that is kept apart begins in water that the rest of the run has set moving."""
    world = model(WAKE)
    run = moved(world)
    late = replace(run, usable=run.usable & (run.time > 3.0))
    whole, part = (measured_memory(world, one, run.time) for one in (run, late))
    np.testing.assert_array_equal(part, whole)
