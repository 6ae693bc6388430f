"""Numbers of messages, by their fields: types of one's own are read where they have the same."""

from pathlib import Path
from typing import Any, Callable, NoReturn

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.readers import unit_quaternions
from rovsim.measurement.recording.rosbag2.bag import Messages

GRAVITY = 9.80665  # m/s2, ISO 80000-3: standard acceleration of free fall


def poses(found: Messages, path: Path) -> Array:
    """Position and quaternion (n, 7) of poses, odometry and transforms, as the message has them."""

    def numbers(message: Any) -> list[float]:
        place, turn = _pose(message)
        return [place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z]

    return _table(found, path, numbers, 7, "a pose: position and orientation")


def twists(found: Messages, path: Path) -> Array:
    """Linear and angular velocity (n, 6) of odometry or a twist, along the body's axes."""

    def numbers(message: Any) -> list[float]:
        twist = _inner(message, "twist")
        return [*_vector(twist.linear), *_vector(twist.angular)]

    return _table(found, path, numbers, 6, "a twist: linear and angular")


def velocities(found: Messages, path: Path) -> Array:
    """Velocity (n, 3) of a twist, a vector or a Doppler log, along the body's axes."""

    def numbers(message: Any) -> list[float]:
        if getattr(message, "velocity_valid", True) is False:
            return [np.nan] * 3
        for name in ("velocity", "vector"):
            if hasattr(message, name):
                return _vector(getattr(message, name))
        return _vector(_inner(message, "twist").linear)

    return _table(found, path, numbers, 3, "a velocity: twist.linear, velocity or vector")


def attitudes(found: Messages, path: Path) -> Array:
    """Quaternions (n, 4) of a quaternion, an orientation, or roll, pitch and yaw in rad."""

    def numbers(message: Any) -> list[float]:
        for name in ("vector", "quaternion", "orientation"):
            message = getattr(message, name, message)
        if hasattr(message, "pose") or hasattr(message, "transform"):
            message = _pose(message)[1]
        if not hasattr(message, "w"):
            return [*from_euler(*np.array(_vector(message)))]
        return [message.w, message.x, message.y, message.z]

    values, good = unit_quaternions(_table(found, path, numbers, 4, "an attitude"))
    return np.where(good[:, None], values, np.nan)


def inertial(found: Messages, path: Path) -> dict[str, Array]:
    """Attitude (n, 4), rates (n, 3) and specific force (n, 3) of an inertial unit.

    A covariance that starts with -1 says that there is no estimate (sensor_msgs/Imu).
    """

    def numbers(message: Any) -> list[float]:
        turn = message.orientation
        quaternion = [turn.w, turn.x, turn.y, turn.z]
        if message.orientation_covariance[0] == -1.0 or not 0.9 < np.hypot.reduce(quaternion) < 1.1:
            quaternion = [np.nan] * 4
        rates, force = _vector(message.angular_velocity), _vector(message.linear_acceleration)
        if message.angular_velocity_covariance[0] == -1.0:
            rates = [np.nan] * 3
        if message.linear_acceleration_covariance[0] == -1.0:
            force = [np.nan] * 3
        return [*quaternion, *rates, *force]

    values = _table(found, path, numbers, 10, "an Imu")
    return {"attitude": values[:, :4], "rates": values[:, 4:7], "specific_force": values[:, 7:]}


def depths(found: Messages, path: Path, mocap: Mocap) -> Array:
    """Depths (n, 1): of a pressure, of a number (positive down), or of a place's z."""
    sensors, down = mocap.sensors, -1.0 if mocap.world_axes == "z_up" else 1.0
    weight = sensors.water_density * GRAVITY

    def numbers(message: Any) -> list[float]:
        if hasattr(message, "fluid_pressure"):
            return [(message.fluid_pressure - sensors.surface_pressure) / weight]
        for name in ("depth", "data"):
            if hasattr(message, name):
                return [float(getattr(message, name))]
        place = message.point if hasattr(message, "point") else _pose(message)[0]
        return [down * place.z]

    return _table(found, path, numbers, 1, "a FluidPressure, a number or a place")


def voltages(found: Messages, path: Path) -> Array:
    """Voltages (n, 1) of a battery."""
    return _table(found, path, lambda message: [message.voltage], 1, "a BatteryState")


def _table(
    found: Messages, path: Path, numbers: Callable[[Any], list[float]], width: int, expected: str
) -> Array:
    try:
        rows = [numbers(message) for message in found.content]
        return np.array(rows, dtype=float).reshape(len(rows), width)
    except (AttributeError, TypeError, ValueError, IndexError):
        _refuse(found, path, expected)


def _refuse(found: Messages, path: Path, expected: str) -> NoReturn:
    raise BadInput(
        f"messages of the type {found.kind}",
        where=f"{path}, {found.topic}",
        expected=expected,
        remedy="Name another topic in 'mocap.topics', or republish it as a standard type.",
    )


def _pose(message: Any) -> tuple[Any, Any]:
    """Where a message says the position and the orientation are."""
    if hasattr(message, "transform"):
        return message.transform.translation, message.transform.rotation
    pose = _inner(message, "pose")
    return pose.position, pose.orientation


def _inner(message: Any, name: str) -> Any:
    """The pose in a pose with covariance in odometry, and the like."""
    while hasattr(message, name):
        message = getattr(message, name)
    return message


def _vector(value: Any) -> list[float]:
    return [value.x, value.y, value.z]
