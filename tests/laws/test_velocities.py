"""Velocities and rates beside poses: those of the same motion pass, all others are told."""

import re

import numpy as np
import pytest

from rovsim.core.rotations import conjugate, from_euler, log, multiply, rotate, unrotate
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.quality.usability import usable_reason
from rovsim.measurement.quality.velocity_conventions import doubt_velocities
from rovsim.measurement.recording.channels import Channel
from rovsim.measurement.recording.recording import Recording

RATE = 50.0
TIME = np.arange(0.0, 30.0, 1.0 / RATE)
POSITION = np.stack([np.sin(0.7 * TIME), np.cos(0.5 * TIME), 0.3 * np.sin(0.9 * TIME)], axis=1)
ATTITUDE = from_euler(0.3 * np.sin(0.8 * TIME), 0.3 * np.cos(0.6 * TIME), 0.4 * TIME)
LINEAR = unrotate(ATTITUDE, np.gradient(POSITION, TIME, axis=0))
STEP = log(multiply(conjugate(ATTITUDE[:-1]), ATTITUDE[1:])) * RATE
ANGULAR = np.vstack([STEP, STEP[-1:]])
TURN = np.array([1.0, -1.0, -1.0])


def recorded(linear=LINEAR, angular=ANGULAR, *, channels=False):
    """A recording with these velocities, m/s and rad/s, means or channels of their own."""
    commands = Commands(np.empty(0), np.empty((0, 6)), "wrench")
    noise = 0.02 * np.random.default_rng(3).normal(size=(len(TIME), 6))
    nu = np.hstack([linear, angular]) + noise
    own = {"velocity": Channel(TIME, nu[:, :3]), "rates": Channel(TIME, nu[:, 3:])}
    run, found = RunInfo("a", "6dof", "train"), np.ones(len(TIME), bool)
    return Recording(
        run,
        Site.unknown(),
        TIME,
        POSITION,
        ATTITUDE,
        found,
        commands,
        RATE,
        None if channels else nu,
        own if channels else {},
    )


@pytest.mark.parametrize("channels", [False, True])
@pytest.mark.parametrize(
    ("linear", "angular", "said"),
    [
        (LINEAR, ANGULAR, []),
        (1.2 * LINEAR, 0.85 * ANGULAR, []),  # a sensor's scale
        (100.0 * LINEAR, ANGULAR, ["velocities are 99.9 times .* cm/s, not m/s"]),
        (LINEAR, np.rad2deg(ANGULAR), ["rates are 57.* times .* deg/s, not rad/s"]),
        (LINEAR, 3.0 * ANGULAR, [r"rates are 3.* times .* are they rad/s\?"]),
        (rotate(ATTITUDE, LINEAR), ANGULAR, ["velocities lie along the axes of the world"]),
        (LINEAR * TURN, ANGULAR * TURN, ["velocities .* sign of y and z", "rates .* y and z"]),
        (LINEAR[::-1], ANGULAR, ["velocities do not fit the poses"]),
    ],
)
def test_what_contradicts_the_poses_is_told(linear, angular, said, channels):
    found = list(doubt_velocities(recorded(linear, angular, channels=channels)))
    assert len(found) == len(said)
    assert all(re.search(a, b) for a, b in zip(said, found, strict=True)), found


@pytest.mark.parametrize("channels", [False, True])
def test_a_run_faster_than_any_vehicle_is_not_used(channels):
    assert usable_reason(recorded(channels=channels)) is None
    fast = recorded(angular=60.0 * ANGULAR, channels=channels)
    assert "are they deg/s?" in str(usable_reason(fast))
    fast = recorded(linear=200.0 * LINEAR, channels=channels)
    assert "are they mm/s?" in str(usable_reason(fast))
