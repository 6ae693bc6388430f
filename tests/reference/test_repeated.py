"""Poses that repeat the one before: the vehicle rests, the camera is slow, or the body is lost."""

import numpy as np
import pytest

from recordings import write_lines
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.formats.csv import read_csv
from rovsim.measurement.recording.tidying import tidy_export

MOCAP = Mocap(format="csv", world_axes="ned", body_axes="frd")
NAMES = "time_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad"


def swim(rate, seconds=40.0, noise=0.0):
    """Times (n,) and poses (n, 6): rest until 8 s and from 32 s on, and a turning point at 20 s."""
    t = np.arange(round(seconds * rate)) / rate
    s = np.clip((t - 8.0) / 24.0, 0.0, 1.0)
    way = 3.0 * np.sin(np.pi * s) ** 2  # starts, turns and ends without a step in its speed
    pose = way[:, None] * [1.0, 0.4, 0.1, 0.02, 0.03, 0.5] + 0.1
    return t, pose + noise * np.random.default_rng(1).normal(size=pose.shape)


def tidied(tmp_path, t, pose, digits=6):
    rows = (",".join(f"{x:.{digits}f}" for x in row) for row in pose)
    lines = [NAMES, *(f"{a:.4f},{row}" for a, row in zip(t, rows, strict=True))]
    path = write_lines(tmp_path / "a.csv", lines)
    return tidy_export(read_csv(path, MOCAP), path)


@pytest.mark.parametrize("rate", [10, 100])
@pytest.mark.parametrize("digits", [2, 3, 4, 6, 12])
@pytest.mark.parametrize("noise", [0.0, 2e-4, 1e-3])
def test_a_vehicle_at_rest_is_seen_whatever_the_digits(tmp_path, rate, digits, noise):
    found = tidied(tmp_path, *swim(rate, noise=noise), digits)
    assert len(found.time) == 40 * rate
    # coarse digits with a noise of a few of them may repeat a single frame and then jump
    assert np.mean(~found.tracked) <= (0.001 if noise and digits < 4 else 0.0)
    assert not found.notes or noise


@pytest.mark.parametrize("noise", [0.0, 5e-4])
def test_a_pose_that_is_sent_on_while_the_vehicle_moves_was_not_seen(tmp_path, noise):
    t, pose = swim(100, noise=noise)
    lost = np.zeros(len(t), bool)
    for first, frames in ((1200, 20), (1500, 60), (2400, 8), (2700, 30)):
        pose[first : first + frames] = pose[first - 1]
        lost[first : first + frames] = True
    found = tidied(tmp_path, t, pose)
    np.testing.assert_array_equal(~found.tracked, lost)
    assert found.notes[0].startswith("118 frames repeat the pose before them to the last digit")


def test_a_recording_that_ends_with_a_lost_body(tmp_path):
    t, pose = swim(100, noise=5e-4)
    pose[2700:] = pose[2699]
    np.testing.assert_array_equal(tidied(tmp_path, t, pose).tracked, np.arange(len(t)) < 2700)


@pytest.mark.parametrize(("rate", "camera"), [(100, 50), (100, 10), (100, 40), (50, 15)])
def test_a_camera_slower_than_its_log(tmp_path, rate, camera):
    """Each of its poses once, at the first line that holds it, also while the vehicle rests."""
    t, pose = swim(rate)
    taken = np.floor(t * camera + 1e-6).astype(int)
    first = np.searchsorted(taken, taken)
    found = tidied(tmp_path, t, pose[first])
    assert found.tracked.all()
    moving = (t > 9.0) & (t < 19.0)  # beyond, poses may repeat by themselves
    own = np.unique(first[moving & (t[first] > 9.0)])
    np.testing.assert_allclose(found.time[(found.time > 9.0) & (found.time < 19.0)], t[own])
    assert np.diff(found.time).max() < 2.0 / camera + 1e-9
    assert found.rate is None
    assert found.notes[0].endswith("lines or so: the camera is slower than the log.")


def test_a_fast_log_of_a_slow_camera_loses_frozen_poses_as_well(tmp_path):
    t, pose = swim(100, noise=5e-4)
    held = pose[np.arange(len(t)) // 4 * 4]
    held[1600:1640] = held[1599]
    found = tidied(tmp_path, t, held)
    assert (~found.tracked).sum() == 10
    assert len(found.time) == 1000


def test_a_depth_with_few_digits_beside_the_poses_stays(tmp_path):
    t, pose = swim(50, noise=5e-4)
    depth = np.round(1.0 + 0.1 * pose[:, :1], 1)
    rows = np.hstack([t[:, None], pose, depth])
    lines = [f"{NAMES},depth_m", *(",".join(f"{x:.6f}" for x in row) for row in rows)]
    path = write_lines(tmp_path / "a.csv", lines)
    found = tidy_export(read_csv(path, MOCAP), path)
    assert found.tracked.all()
    assert len(found.channels["depth"].time) == len(t)
