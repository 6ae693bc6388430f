"""A run stepped one command at a time is the run that is replayed; so is a run in a batch."""

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.fluid_memory import FluidMemory
from rovsim.dynamics.effects.thrusters import ThrusterLag, VoltageSag
from rovsim.learning.learner import learner_settings, train
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.stepper import Stepper, rollouts
from worlds import at_rest, model, motion, sticks

KNN = learner_settings({"kind": "knn"})


def learnt(world):
    """The model with a residual of random targets."""
    from dataclasses import replace

    rng = np.random.default_rng(0)
    X, Y = rng.normal(size=(50, 12)), 0.1 * rng.normal(size=(50, 6))
    return replace(world, residual=train(X, Y, KNN, seed=0, control="6dof"))


WORLDS = {
    "nominal": model(),
    "lag": model(ThrusterLag(time_constant=0.15)),
    "delay": model(InputDelay(delay=0.0234)),  # takes effect inside a step
    "sag and memory": model(VoltageSag(fraction=0.4), FluidMemory(coefficient=40, time_constant=1)),
    "residual": learnt(model(ThrusterLag(time_constant=0.1))),
}


@pytest.mark.parametrize("name", WORLDS)
def test_stepping_is_replaying(name):
    world, run = WORLDS[name], motion(sticks(1, 40))
    replayed = simulate(world, run, [(0, 200, at_rest())], ReplaySettings())[0]
    stepper, state = Stepper(world, duration=2.0), at_rest()
    for k in range(200):
        line = np.searchsorted(run.commands.time, k * 0.01 + 1e-9, "right") - 1
        state = stepper.step(state, run.commands.value[line], 0.01)
        np.testing.assert_allclose(state, replayed[k + 1], rtol=0, atol=1e-12)


def test_a_long_step_is_divided_and_a_reset_forgets():
    stepper, command = Stepper(WORLDS["lag"]), sticks()[0]
    state = at_rest()
    for _ in range(5):
        state = stepper.step(state, command, 0.01)
    stepper.reset()
    np.testing.assert_allclose(stepper.step(at_rest(), command, 0.05), state, atol=1e-13)


def test_stepping_leaves_the_given_state_alone():
    state = at_rest()
    Stepper(model()).step(state, sticks()[0], 0.01)
    np.testing.assert_array_equal(state, at_rest())


def test_rollouts_are_the_steps_of_each_model_from_each_state():
    worlds = [model(ThrusterLag(time_constant=t)) for t in (0.05, 0.2)]
    starts = np.stack([at_rest(), at_rest() + 0.1 * (np.arange(13) == 8)])
    commands = sticks(2, 30)
    found = rollouts(worlds, starts, commands, 0.01, "thruster")
    for m, world in enumerate(worlds):
        for s, state in enumerate(starts):
            stepper = Stepper(world)
            for k, command in enumerate(commands):
                state = stepper.step(state, command, 0.01)
                np.testing.assert_allclose(found[m, s, k + 1], state, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("command", "dt"),
    [(np.zeros(6), 0.01), (np.zeros(8), 0.0), (np.zeros(8), np.nan), (np.full(8, np.nan), 0.01)],
)
def test_unusable_steps_are_refused(command, dt):
    with pytest.raises(BadInput, match=r"Stepper\.step"):
        Stepper(model()).step(at_rest(), command, dt)


def test_a_sag_per_run_needs_a_run_and_one_per_second_does_not():
    per_run, per_second = model(VoltageSag(fraction=0.4)), model(VoltageSag(rate=0.2))
    with pytest.raises(BadInput, match="voltage_sag is given per run"):
        Stepper(per_run)
    with pytest.raises(BadInput, match="voltage_sag is given per run"):
        rollouts([model(), per_run], at_rest()[None], sticks(), 0.01, "thruster")
    stepped = np.tile(at_rest(), (2, 1))
    for k, one in enumerate((Stepper(per_run, duration=2.0), Stepper(per_second))):
        for command in sticks(3, 50):
            stepped[k] = one.step(stepped[k], command, 0.01)
    np.testing.assert_allclose(stepped[0], stepped[1], rtol=0, atol=1e-12)
    assert np.abs(stepped[0] - at_rest()).max() > 1e-3


def test_what_cannot_be_stepped_is_refused():
    with pytest.raises(BadInput, match="before they are given"):
        Stepper(model(InputDelay(delay=-0.1)))
    worlds = [model(), learnt(model())]
    with pytest.raises(BadInput, match="same residual"):
        rollouts(worlds, at_rest()[None], sticks(), 0.01, "thruster")
