"""Body velocities beside poses: means from line to line, values at the lines, or nobody can say."""

from itertools import pairwise

import numpy as np
import pytest

from rovsim.core import rotations
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.quality.assessment import assess
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.recording.repairs import Anomalies

FINE = 0.001  # s: steps of the truth


def truth():
    """Times, places with angles, and body velocities of a swim that turns in yaw."""
    t = np.arange(0.0, 60.0, FINE)
    yaw = 1.2 * np.sin(0.5 * t)
    v = np.stack([0.4 * np.sin(0.9 * t), 0.3 * np.cos(1.3 * t), 0.1 * np.sin(0.7 * t)], axis=1)
    q = rotations.from_euler(0 * t, 0 * t, yaw)
    place = np.cumsum(rotations.rotate(q, v), axis=0) * FINE
    rates = np.stack([0 * t, 0 * t, 0.6 * np.cos(0.5 * t)], axis=1)
    return t, np.column_stack([place, yaw]), np.hstack([v, rates])


def over(values, edges):
    """Means of values between the edges, which count samples."""
    return np.stack([values[a:b].mean(axis=0) for a, b in pairwise(edges)])


def doubts(edges, poses, velocities, noise=1e-3):
    t, pose, nu = truth()
    at = edges[:-1]
    pose = over(pose, edges) if poses == "mean" else pose[at]
    nu = over(nu, edges) if velocities == "mean" else nu[at]
    pose = pose + noise * np.random.default_rng(1).normal(size=pose.shape)
    q = rotations.from_euler(0 * pose[:, 3], 0 * pose[:, 3], pose[:, 3])
    found = np.ones(len(at), bool)
    recording = Recording(
        RunInfo("one", "6dof", "train"),
        Site.unknown(),
        t[at],
        pose[:, :3],
        q,
        found,
        Commands(t[:1], np.zeros((1, 8)), "thruster"),
        10.0,
        nu,
    )
    return [x for x in assess(recording, Anomalies()).doubts if "velocity: instant" in x]


EVEN = np.arange(0, 60_000, 100)
UNEVEN = np.cumsum(np.random.default_rng(2).choice([100, 200], 350))


@pytest.mark.parametrize("edges", [EVEN, UNEVEN], ids=["even", "uneven"])
def test_values_at_the_lines_are_told_from_means_to_the_next(edges):
    assert not doubts(edges, "instant", "mean")
    assert len(doubts(edges, "instant", "instant")) == 1


def test_means_of_poses_and_velocities_alike_are_seen_where_steps_differ():
    assert not doubts(UNEVEN, "mean", "mean")


def test_nothing_is_said_where_noise_hides_it_or_steps_are_few():
    assert not doubts(EVEN, "instant", "instant", noise=0.1)
    assert not doubts(EVEN[:40], "instant", "instant")
