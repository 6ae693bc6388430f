"""Readings are groups of frames, steps lead from one to the next: nothing of either is lost."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import worlds
from flown import observed
from rovsim.core.run import Commands
from rovsim.diagnosis.structure.residual import split_by_axis
from rovsim.diagnosis.structure.unknown_thrust import find_different, find_jumps, find_lost_commands
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.thrusters import ThrusterDeadband
from rovsim.dynamics.mocap_view import NO_CHANGE
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.observed_run import prepare_run
from rovsim.simulation.drive import Actuation, Drives, JoinedSteps
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.synthetic_tank.settings import Camera

STILL = {"bursts_per_minute": 0.0, "outliers_per_minute": 0.0}


@given(st.lists(st.integers(1, 8), min_size=1, max_size=4), st.integers(0, 2**32 - 1))
def test_a_long_step_moves_a_mass_as_its_parts_do(counts, seed):
    """Velocity and place after it are those under a force that is steady over each part."""
    count = np.array(counts)
    wrench = np.random.default_rng(seed).normal(size=(count.sum(), 6))
    none = np.zeros((len(wrench), 0))
    mean, growth = Actuation(wrench, none, none, none, none).joined(JoinedSteps.of(count))
    for step, forces in enumerate(np.split(wrench, np.cumsum(count)[:-1])):
        v, p = np.zeros(6), np.zeros(6)
        for force in forces / len(forces):
            p, v = p + (v + 0.5 * force) / len(forces), v + force
        np.testing.assert_allclose(v, mean.wrench[step], atol=1e-12)
        # of a line: half its mean, less a twelfth of what it grows by
        np.testing.assert_allclose(
            p, 0.5 * mean.wrench[step] - growth.wrench[step] / 12.0, atol=1e-12
        )


def test_steps_end_where_bins_end():
    """Bins of any length; a step is as near to 50 ms as they allow."""
    time = np.cumsum(np.random.default_rng(3).uniform(0.03, 0.3, 200))
    still = worlds.motion(worlds.sticks())
    rows = np.repeat(still.state[:1], len(time), axis=0)
    bins = replace(
        still,
        time=time,
        eta=rows[:, :7],
        nu=rows[:, 7:],
        nu_dot=rows[:, 7:],
        state_nu=rows[:, 7:],
        usable=np.ones(len(time), bool),
        binned=True,
        end=time[-1] + 0.1,
    )
    run = prepare_run(bins, bins, ReplaySettings(), built_in(), np.ones(6, bool))
    np.testing.assert_allclose(run.edges[run.reading_steps], time, atol=0.005)
    fine = np.round((run.edges - time[0]) / 0.01)[run.reading_steps]
    np.testing.assert_array_equal(fine, np.round((time - time[0]) / 0.01))
    assert np.all(np.diff(run.edges) < 0.08)


def test_lines_that_were_lost_while_commands_changed_are_known_to_be(tmp_path):
    base, (run,) = observed(tmp_path, duration=8.0, camera=Camera(**STILL))
    time = 0.02 * np.arange(400)
    still, ramp = np.zeros(200), np.full(200, 0.01)
    value = np.cumsum(np.concatenate([still, ramp]))[:, None]

    def find(kept, late=0.0):
        commands = Commands(time[kept] + late, value[kept], "thruster")
        motion = replace(run.motion, commands=commands)
        return find_lost_commands(
            replace(run, motion=motion, edges=run.edges + late), base.thrust_path
        )

    kept = np.isin(np.arange(400), (100, 300, 390), invert=True)
    found = find(kept)
    np.testing.assert_allclose(run.edges[0] + found, [[5.98, 6.02], [7.78, 7.82]])
    np.testing.assert_allclose(find(kept, 3.0), found)  # of a clock that was not set
    assert not len(find(np.ones(400, bool)))
    uneven = np.random.default_rng(0).uniform(size=400) < 0.5
    assert len(find(uneven)) <= 0.05 * uneven.sum()


def test_what_a_lost_line_may_do_is_the_change_of_thrust_over_the_inertia(tmp_path):
    base, (run,) = observed(tmp_path, duration=8.0, camera=Camera(**STILL))
    lost = np.array([[2.0, 2.04], [5.0, 5.04]])
    light = find_jumps(run, base, lost)
    heavy = find_jumps(run, base + AddedMass(heave=base.M[2, 2]), lost)  # twice as heavy
    assert light.shape == (2, 6)
    assert np.all(light[:, 2] > 0.01)
    np.testing.assert_allclose(heavy[:, 2], 0.5 * light[:, 2], rtol=0.02)


@pytest.mark.parametrize("at", [6.004, 6.026, 6.043])
def test_what_thrusters_did_under_a_lost_line_is_not_held_against_a_model(tmp_path, at):
    """Wherever between two readings it was lost, and commands were turned round."""
    base, (run,) = observed(tmp_path, duration=12.0, camera=Camera(**STILL))
    log = run.motion.commands
    turned = np.where(log.time[:, None] - run.edges[0] < at, log.value, -log.value)
    kept = np.arange(len(log.time)) != np.argmax(log.time - run.edges[0] >= at)
    logs = replace(log, value=turned), replace(log, time=log.time[kept], value=turned[kept])
    fine = np.linspace(run.edges[0], run.edges[-1], int(run.substeps.sum()) + 1)
    drives = [Drives(one, fine, "held", run.substeps) for one in logs]
    motions = [replace(run.motion, commands=one) for one in logs]
    each = zip(motions, drives, strict=True)
    told, lossy = (replace(run, motion=own, drives=driven) for own, driven in each)
    bank = FilterBank.design([told], base, FIRST_NOISE)
    other = replace(bank, runs=(lossy,))
    e = [other.innovations(base)[0] - bank.innovations(base)[0]]
    seen = SimpleNamespace(e=e, J=[np.empty((0, *e[0].shape))])
    found = SimpleNamespace(linearised=seen, noise=FIRST_NOISE, hypothesis=Hypothesis(base))
    left = np.stack([one.white[0] for one in split_by_axis(found, other)])
    assert np.linalg.norm(left) < 0.2 * np.linalg.norm(other.whiten(e, FIRST_NOISE))


def test_near_the_edge_of_a_deadband_nobody_knows_whether_a_thruster_turned(tmp_path):
    base, (run,) = observed(tmp_path, duration=20.0)
    narrow, wide = (base + ThrusterDeadband(width=width) for width in (0.08, 0.085))
    found = find_different(run, narrow, wide)
    begins, ends = found.T
    assert len(found)
    assert np.all(begins < ends)
    assert np.all(ends[:-1] < begins[1:])
    command = run.motion.commands
    near = ((np.abs(command.value) > 0.08) & (np.abs(command.value) <= 0.085)).any(axis=1)
    at = command.time[near] - run.edges[0]
    at = at[(at > 0.0) & (at < run.edges[-1] - run.edges[0])]
    held = at[:, None] + np.array([0.0, 0.02])  # the line holds until the next
    shown = [((begins < b) & (ends > a)).any() for a, b in held]
    assert len(at)
    assert np.mean(shown) > 0.99
    assert np.sum(ends - begins) < 0.5 * (run.edges[-1] - run.edges[0])
    assert not len(find_different(run, wide, wide))


def test_a_reading_is_the_pose_in_the_middle_of_its_frames(tmp_path):
    camera = Camera(position_noise=0.0, attitude_noise=0.0, **STILL)
    _, (run,) = observed(tmp_path, duration=8.0, camera=camera)
    readings = run.read(NO_CHANGE)
    assert run.group == 5
    first, last = run.segments[0]
    middle = run.frames[run.reading_samples]
    np.testing.assert_allclose(readings[first:last, :7], middle[first:last, :7], atol=3e-5)
    curve = np.mean(run.frames[: 5 * len(middle), 0].reshape(-1, 5), axis=1) - middle[:, 0]
    error = readings[:, 0] - middle[:, 0]
    assert np.std(error[first:last]) < 0.5 * np.std(curve[first:last])


def test_the_noise_of_a_reading_is_that_of_a_mean(tmp_path):
    runs = []
    for noise in (0.0, 2e-3):
        camera = Camera(position_noise=noise, attitude_noise=0.0, **STILL)
        runs.append(observed(tmp_path / str(noise), duration=8.0, camera=camera)[1][0])
    still, noisy = (run.read(NO_CHANGE)[20:-20, :3] for run in runs)
    assert np.std(noisy - still) == pytest.approx(2e-3 / np.sqrt(5), rel=0.15)
