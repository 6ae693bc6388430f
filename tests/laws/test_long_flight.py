"""A flight in the tank holds what is asked for, and is the same however much of it is held."""

import tracemalloc

import numpy as np

from rovsim.core import gauss_markov
from rovsim.dynamics.catalogue import built_in
from rovsim.simulation.synthetic_tank import true_run
from rovsim.simulation.synthetic_tank.campaign import true_model
from rovsim.simulation.synthetic_tank.settings import TankSettings, Turbulence
from rovsim.simulation.synthetic_tank.true_run import Flight, every_step, fly_run
from rovsim.simulation.synthetic_tank.turbulence import draw_turbulence

HIDDEN = [
    {"effect": "input_delay", "parameters": {"delay": 0.11}},
    {"effect": "fluid_memory", "parameters": {"coefficient": 5.0, "time_constant": 0.5}},
]


def fly(seconds, choose):
    settings = TankSettings(duration=seconds, effects=HIDDEN)
    model = true_model(settings, built_in())
    return fly_run(model, settings, Flight("6dof"), np.random.default_rng(3), choose)


def frames(total, step):
    return np.arange(0, total + 1, 10)


def test_pushes_in_parts_are_those_of_the_whole():
    settings, steps, h = Turbulence(), 1000, 1e-3
    whole, parts = np.random.default_rng(1), np.random.default_rng(1)
    level = np.repeat([settings.force, settings.moment], 3)
    expected = gauss_markov.draw(steps, h / settings.time_constant, whole) * level
    found = np.concatenate(list(draw_turbulence(settings, steps, h, parts, rows=300)))
    np.testing.assert_array_equal(found, expected)
    assert parts.random() == whole.random()  # and what is drawn next is the same


def test_frames_are_those_of_the_whole_flight(monkeypatch):
    whole = fly(4.0, every_step)
    monkeypatch.setattr(true_run, "TICKS_PER_DRAW", 7)
    part = fly(4.0, frames)
    np.testing.assert_array_equal(part.state, whole.state[::10])
    np.testing.assert_array_equal(part.time, whole.time[::10])
    np.testing.assert_array_equal(part.at(np.array([30, 10])), whole.state[[30, 10]])
    np.testing.assert_array_equal(part.commands.value, whole.commands.value)


def test_memory_follows_the_frames_and_not_the_steps(monkeypatch):
    monkeypatch.setattr(true_run, "TICKS_PER_DRAW", 10)
    fly(1.0, frames)  # whatever is made once
    tracemalloc.start()
    flown = fly(20.0, frames)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 0.5 * flown.total * flown.state[0].nbytes
