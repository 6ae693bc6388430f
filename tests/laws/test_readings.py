"""Readings are groups of frames, steps lead from one to the next: nothing of either is lost."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import worlds
from flown import observed
from rovsim.diagnosis.structure.unknown_thrust import find_different
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.thrusters import ThrusterDeadband
from rovsim.dynamics.mocap_view import NO_CHANGE
from rovsim.estimation.observer.observed_run import prepare_run
from rovsim.estimation.observer.steps import GROUP_SECONDS, MAX_LOST, choose_group_seconds
from rovsim.estimation.observer.train_runs import prepare_train
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.motion import Poses
from rovsim.simulation.drive import Actuation, JoinedSteps
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


def shaken(motion, axis, alpha, hz):
    """The same motion, with one axis that oscillates by `alpha` m/s2 or rad/s2."""
    nu_dot = np.zeros_like(motion.nu_dot)
    nu_dot[:, axis] = alpha * np.sin(2.0 * np.pi * hz * motion.time)
    return replace(motion, nu_dot=nu_dot)


@given(st.integers(0, 5), st.floats(0.05, 30.0), st.floats(0.3, 3.0))
def test_the_mean_of_a_group_loses_little_of_a_fast_motion(axis, alpha, hz):
    still = worlds.motion(worlds.sticks())
    still = replace(still, usable=np.ones(len(still.time), bool))
    seconds = choose_group_seconds(shaken(still, axis, alpha, hz))
    lost = alpha / np.sqrt(2.0) * seconds**2 / 24.0
    assert lost < 1.1 * max(MAX_LOST[axis], alpha * 0.02**2 / 24.0)
    assert seconds == GROUP_SECONDS or lost > 0.6 * MAX_LOST[axis]


def test_hits_do_not_make_readings_shorter():
    still = worlds.motion(worlds.sticks())
    hits = shaken(still, 3, 100.0, 1.0)
    hits.nu_dot[np.arange(len(hits.time)) % 10 > 0] = 0.0
    assert choose_group_seconds(hits) == GROUP_SECONDS
    assert choose_group_seconds(shaken(still, 3, 100.0, 1.0)) < GROUP_SECONDS
    assert (
        choose_group_seconds(replace(hits, usable=np.zeros(len(hits.time), bool))) == GROUP_SECONDS
    )


def test_the_fastest_run_sets_the_readings_of_all(tmp_path):
    """Their noise is compared, so they have to be means of equally many frames."""
    _, (run,) = observed(tmp_path, duration=20.0, camera=Camera(**STILL))
    stage = Poses(
        run.motion.run,
        run.motion.site,
        run.motion.time,
        run.frames[:, :7],
        run.motion.usable,
        run.motion.commands,
    )
    fast = shaken(run.motion, 3, 15.0, 1.2)
    both = Runs({"a": run.motion, "b": fast}, {"a": stage, "b": stage}, dict(a="train", b="train"))
    free = np.ones(6, bool)
    prepared = prepare_train(both, ReplaySettings(), built_in(), free)
    assert [r.group for r in prepared.runs] == [3, 3]
    slow = Runs({"a": run.motion}, {"a": stage}, {"a": "train"})
    assert prepare_train(slow, ReplaySettings(), built_in(), free).runs[0].group == 5
    less = prepare_train(both, ReplaySettings(), built_in(), free, most=39.0)
    assert less.seconds < 25.0  # as many readings as of 39 s of slow motion, and not more
