"""Take numbers out of messages by their fields, so that custom types with the same fields work."""

from dataclasses import dataclass
from typing import Any, Mapping

import numpy as np

from rovsim.core.rotations import from_euler
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.formats.rosbag2.bag import Numbers

GRAVITY = 9.80665  # m/s2, ISO 80000-3: standard acceleration of free fall
UNKNOWN = float("nan")


@dataclass(frozen=True)
class TopicReader:
    """How a topic is read.

    Attributes:
        numbers: takes the numbers out of a message.
        channels: which of these numbers each kind of channel consists of.
        expected: what the messages should be, for errors.
    """

    numbers: Numbers
    channels: Mapping[str, slice]
    expected: str


def pose(message: Any) -> list[float]:
    """Position and quaternion (x, y, z, qw, qx, qy, qz) of a pose, odometry or transform."""
    position, q = _pose(message)
    return [*_vector(position), q.w, q.x, q.y, q.z]


def topic_readers(mocap: Mocap) -> dict[str, TopicReader]:
    """How the topics of channels are read, by their key in `mocap.topics`."""
    return {
        "odometry": TopicReader(
            _twist, {"velocity": slice(0, 3), "rates": slice(3, 6)}, "a twist: linear and angular"
        ),
        "imu": TopicReader(
            _inertial,
            {"attitude": slice(0, 4), "rates": slice(4, 7), "specific_force": slice(7, 10)},
            "an Imu",
        ),
        "attitude": TopicReader(_attitude, {"attitude": slice(0, 4)}, "an attitude"),
        "depth": TopicReader(
            _depth_by(mocap), {"depth": slice(0, 1)}, "a FluidPressure, a number or a place"
        ),
        "velocity": TopicReader(
            _velocity, {"velocity": slice(0, 3)}, "a velocity: twist.linear, velocity or vector"
        ),
        "battery": TopicReader(_voltage, {"voltage": slice(0, 1)}, "a BatteryState"),
    }


def _twist(message: Any) -> list[float]:
    twist = _inner(message, "twist")
    return [*_vector(twist.linear), *_vector(twist.angular)]


def _velocity(message: Any) -> list[float]:
    """Velocity (u, v, w) along the body axes, m/s, of a twist, a vector or a Doppler log."""
    if getattr(message, "velocity_valid", True) is False:
        return [UNKNOWN] * 3
    for name in ("velocity", "vector"):
        if hasattr(message, name):
            return _vector(getattr(message, name))
    return _vector(_inner(message, "twist").linear)


def _attitude(message: Any) -> list[float]:
    """Quaternion (w, x, y, z) of an orientation, or of roll, pitch and yaw in rad."""
    for name in ("vector", "quaternion", "orientation"):
        message = getattr(message, name, message)
    if hasattr(message, "pose") or hasattr(message, "transform"):
        message = _pose(message)[1]
    if hasattr(message, "w"):
        return [message.w, *_vector(message)]
    return list(from_euler(*np.array(_vector(message))))


def _inertial(message: Any) -> list[float]:
    """Quaternion, rates and specific force (10) of an Imu; NaN for what it does not estimate.

    A covariance that starts with -1 says that there is no estimate (sensor_msgs/Imu).
    """
    q = message.orientation
    parts = {
        "orientation": [q.w, *_vector(q)],
        "angular_velocity": _vector(message.angular_velocity),
        "linear_acceleration": _vector(message.linear_acceleration),
    }
    return [
        UNKNOWN if getattr(message, f"{name}_covariance")[0] == -1.0 else number
        for name, numbers in parts.items()
        for number in numbers
    ]


def _depth_by(mocap: Mocap) -> Numbers:
    """Make the function that takes a depth (m) from a pressure, a number or the z of a point.

    Numbers are positive down; z is along the world axes of the file.
    """
    sensors, down = mocap.sensors, -1.0 if mocap.world_axes == "z_up" else 1.0
    weight = sensors.water_density * GRAVITY

    def numbers(message: Any) -> list[float]:
        if hasattr(message, "fluid_pressure"):
            return [(message.fluid_pressure - sensors.surface_pressure) / weight]
        for name in ("depth", "data"):
            if hasattr(message, name):
                return [getattr(message, name)]
        point = message.point if hasattr(message, "point") else _pose(message)[0]
        return [down * point.z]

    return numbers


def _voltage(message: Any) -> list[float]:
    return [message.voltage]


def _pose(message: Any) -> tuple[Any, Any]:
    """The parts of a message that hold its position and its orientation."""
    if hasattr(message, "transform"):
        return message.transform.translation, message.transform.rotation
    inner = _inner(message, "pose")
    return inner.position, inner.orientation


def _inner(message: Any, name: str) -> Any:
    """Follow fields of the same name inwards, as for a pose with covariance in odometry."""
    while hasattr(message, name):
        message = getattr(message, name)
    return message


def _vector(value: Any) -> list[float]:
    return [value.x, value.y, value.z]
