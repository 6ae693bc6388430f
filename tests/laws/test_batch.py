"""Every way into the engine meets the same physics, and models side by side do not touch."""

from dataclasses import replace

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.dynamics.effects.damping import QuadraticDamping
from rovsim.dynamics.effects.tether import TetherTension
from rovsim.dynamics.effects.thrusters import VoltageSag
from rovsim.estimation.observer.innovations import batch_of
from rovsim.estimation.observer.observed_run import prepare_run
from rovsim.estimation.observer.windows import Windows
from rovsim.evaluation.force_budget import balance_forces
from rovsim.measurement.signals.motion import Poses
from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.drive import Drives
from rovsim.simulation.measured_states import accelerate_as_measured, drive_as_measured
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from rovsim.simulation.stepper import Stepper, rollouts
from worlds import model, motion, sticks, tank

COMMAND = sticks(3, 1)
NU = [0.3, -0.2, 0.1, 0.2, 0.1, -0.3]
START = np.concatenate([[0.3, -0.2, 0.1], from_euler(0.2, -0.1, 0.7), NU])
WORLD = model(
    QuadraticDamping(surge=2.0, yaw=0.1),
    TetherTension(stiffness=7.0, slack_length=0.5, anchor_x=1.0, anchor_y=0.5, anchor_z=0.8),
    ConstantWrench(heave=-2.0),
)
SHORT = 1e-5  # s: over such a step the mean acceleration is the one at its start
RUN = motion(COMMAND, seconds=3.0, start=START, site=tank())


def expected():
    """Acceleration of the world at the start, under the command."""
    drive = drive_as_measured(WORLD, RUN, ReplaySettings())
    return accelerate_as_measured(WORLD, RUN, drive)[0]


def by_budget():
    found = balance_forces(WORLD, RUN, SimulationSettings())
    return np.linalg.solve(WORLD.body.M, sum(found.parts.values())[0])


def by_replay():
    fine = replace(RUN, time=SHORT * np.arange(3), **of_start(3))
    path = simulate(WORLD, fine, [(0, 2, START)], ReplaySettings(step=SHORT))[0]
    return (path[1, 7:] - START[7:]) / SHORT


def by_stepper():
    state = Stepper(WORLD, site=tank(), duration=3.0).step(START, COMMAND[0], SHORT)
    return (state[7:] - START[7:]) / SHORT


def by_heun():
    drive = Drives(RUN.commands, SHORT * np.arange(2), "held").of([WORLD])[0]
    path = Batch([WORLD], tank()).advance_by_heun(
        drive, np.zeros((1, 6)), START, np.zeros(6), 0.0, SHORT
    )
    return (path[0, 7:] - START[7:]) / SHORT


def by_observer():
    run = observed()
    drives, batch = run.replay_drives.of([WORLD]), batch_of([WORLD], run)
    return batch.accelerations(drives[0].at([0]), np.zeros(1), START[None], np.empty((0, 6)))[0]


def by_windows():
    """The windows of the diagnosis, whose first sample is one step of 10 ms away."""
    path = simulate(WORLD, RUN, [(0, 1, START)], ReplaySettings())[0]
    mean = (path[1, 7:] - START[7:]) / 0.01
    error = Windows(observed(), 0.5).compare([WORLD])[0, 0]
    return expected() + (error + RUN.nu[1] - START[7:]) / 0.01 - mean


def of_start(count):
    rows = np.repeat(START[None], count, axis=0)
    return {
        "eta": rows[:, :7],
        "nu": rows[:, 7:],
        "nu_dot": 0 * rows[:, 7:],
        "state_nu": rows[:, 7:],
        "usable": np.ones(count, bool),
    }


def observed():
    poses = Poses(RUN.run, RUN.site, RUN.time, RUN.eta, RUN.usable, RUN.commands)
    return prepare_run(poses, RUN, ReplaySettings(), built_in(), np.ones(6, bool))


@pytest.mark.parametrize(
    "way", [by_budget, by_replay, by_stepper, by_heun, by_observer, by_windows]
)
def test_every_way_gives_the_same_acceleration_at_the_same_state(way):
    np.testing.assert_allclose(way(), expected(), rtol=0, atol=2e-4)
    assert np.abs(expected()).min() > 0.01  # no axis agrees by being still


def test_models_side_by_side_move_as_each_would_alone():
    """In one engine for all their wrench effects, whoever else is there."""
    worlds = [model(), WORLD, model(ConstantWrench(surge=3.0)), model(QuadraticDamping(surge=5.0))]
    run, first = observed(), np.zeros(1, np.int64)
    drives = run.replay_drives.of(worlds)
    starts = Starts(np.tile(START, (len(worlds), 1, 1)), first, first + 100)
    together = batch_of(worlds, run).trajectories(drives, starts, run.grid - run.grid[0])
    for world, paths in zip(worlds, together, strict=True):
        alone = simulate(world, RUN, [(0, 100, START)], ReplaySettings())[0]
        np.testing.assert_allclose(paths[0], alone, rtol=0, atol=1e-12)


def test_an_inert_model_stays_inert_beside_others():
    inert, commands = replace(model(), inert=True), np.repeat(COMMAND, 20, axis=0)
    found = rollouts([inert, model()], START[None], commands, 0.01, "thruster")
    np.testing.assert_array_equal(found[0, 0, -1, 7:], START[7:])
    assert np.abs(found[1, 0, -1, 7:] - START[7:]).max() > 0.01


def test_models_with_another_residual_do_not_go_together():
    with pytest.raises(BadInput, match="same residual"):
        Batch([WORLD, replace(WORLD, residual=object())], tank())


def test_one_engine_serves_whatever_acts():
    pushed = model(ConstantWrench(surge=1.0))
    assert Batch([pushed], tank()).engine is Batch([model(), WORLD], tank()).engine
    assert Batch([model()], tank()).engine is not Batch([pushed], tank()).engine


def test_what_drives_models_alike_is_found_once():
    world, edges = model(), 0.01 * np.arange(5)
    pushed = world + ConstantWrench(surge=3.0)
    drives = Drives(RUN.commands, edges, "held")
    one, other = drives.of([world, pushed])
    assert one is other
    weaker = world + VoltageSag(fraction=0.2)
    assert drives.of([world, weaker])[1] is not one


def test_an_effect_that_is_called_by_its_address_pushes_as_one_that_is_compiled_in():
    """The engine holds each effect once; a second one of a kind is attached to it."""
    one, two = ConstantWrench(surge=2.0, yaw=0.1), ConstantWrench(surge=-0.5, heave=1.0)
    whole = ConstantWrench(surge=1.5, heave=1.0, yaw=0.1)
    paths = [
        simulate(model(*effects), RUN, [(0, 25, START)], ReplaySettings())[0]
        for effects in ((one, two), (whole,))
    ]
    np.testing.assert_allclose(*paths, atol=1e-12)
