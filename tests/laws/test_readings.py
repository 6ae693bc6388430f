"""Readings are groups of frames, steps lead from one to the next: nothing of either is lost."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flown import observed
from rovsim.dynamics.mocap_view import NO_CHANGE
from rovsim.simulation.drive import Drive
from rovsim.simulation.synthetic_tank.settings import Camera

STILL = {"bursts_per_minute": 0.0, "outliers_per_minute": 0.0}


@given(st.integers(2, 8), st.integers(0, 2**32 - 1))
def test_a_long_step_moves_a_mass_as_its_parts_do(parts, seed):
    """Velocity and place after it are those under a force that is steady over each part."""
    wrench = np.random.default_rng(seed).normal(size=(3 * parts, 6))
    fine = Drive(wrench, np.zeros((3 * parts, 8)), np.full((3 * parts, 6), np.nan), 1.0)
    long = fine.joined(parts)
    v, p = np.zeros(6), np.zeros(6)
    for k, force in enumerate(wrench):
        p, v = p + v / parts + 0.5 * force / parts**2, v + force / parts
        if k % parts == parts - 1:
            step = k // parts
            np.testing.assert_allclose(v, long.wrench[step], atol=1e-12)
            # of a line: half its mean, less a twelfth of what it grows by
            np.testing.assert_allclose(
                p, 0.5 * long.wrench[step] - long.ramp[step] / 12.0, atol=1e-12
            )
            v, p = np.zeros(6), np.zeros(6)


def test_a_drive_over_single_steps_stays_as_it_is():
    drive = Drive(np.ones((4, 6)), np.zeros((4, 8)), np.full((4, 6), np.nan), 1.0)
    assert drive.joined(1) is drive


def test_a_reading_is_the_pose_in_the_middle_of_its_frames(tmp_path):
    camera = Camera(position_noise=0.0, attitude_noise=0.0, **STILL)
    _, (run,) = observed(tmp_path, duration=8.0, camera=camera)
    readings = run.read(NO_CHANGE)
    assert run.group == 5
    first, last = run.spans[0]
    middle = run.frames[run.sample]
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
