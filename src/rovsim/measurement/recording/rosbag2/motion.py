"""What a bag holds of the motion: poses, and channels of other topics."""

from pathlib import Path
from typing import Mapping

from numpy import ndarray as Array

from rovsim.core.errors import BadInput, nearest
from rovsim.measurement.campaign_file import Mocap, Topics
from rovsim.measurement.recording.channels import Channel, measured
from rovsim.measurement.recording.readers import (
    Export,
    finite_rows,
    mocap_reader,
    unit_quaternions,
)
from rovsim.measurement.recording.rosbag2 import messages
from rovsim.measurement.recording.rosbag2.bag import Bag, Messages, opened

POSES = ("PoseStamped", "PoseWithCovarianceStamped", "TransformStamped", "Odometry")


@mocap_reader("rosbag2")
def read_bag(path: Path, mocap: Mocap) -> Export:
    """Read the topics that `mocap.topics` and `mocap.body` name.

    Raises:
        BadInput: no bag, no such topic, or messages of which nobody knows the type.
    """
    with opened(path, by="mocap.format: rosbag2") as bag:
        topics = mocap.topics or Topics()
        pose = _pose_topic(bag, mocap, topics)
        given = {
            key: bag.messages(topic, f"mocap.topics.{key}")
            for key, topic in dict(topics).items()
            if topic and topic != pose
        }
        channels = {
            kind: channel
            for key, found in given.items()
            for kind, channel in _channels(key, found, bag, mocap).items()
        }
        notes = tuple(note for found in given.values() for note in found.notes)
        if pose is None:
            return Export.of_channels(channels, notes=notes)
        channels.pop("attitude", None)  # it is part of the poses
        return _poses(bag, bag.messages(pose, "mocap.body"), channels, notes)


def _pose_topic(bag: Bag, mocap: Mocap, topics: Topics) -> str | None:
    """The topic of full poses; None where the campaign names topics of other channels alone."""
    named = topics.pose or topics.odometry or mocap.body
    if named:
        return named
    if mocap.topics is not None:
        return None
    found = [
        topic for topic, kind in bag.topics.items() if kind.endswith(tuple(f"/{p}" for p in POSES))
    ]
    if len(found) == 1:
        return found[0]
    raise BadInput(
        f"{len(found)} topics of poses: {', '.join(found) or 'none'}",
        where=bag.path,
        expected="the topic to read as 'mocap.body', or 'mocap.topics'",
        remedy="Name one." if found else nearest("", bag.topics),
    )


def _poses(
    bag: Bag, found: Messages, channels: Mapping[str, Channel], notes: tuple[str, ...]
) -> Export:
    values = messages.poses(found, bag.path)
    attitude, seen = unit_quaternions(values[:, 3:])
    position = values[:, :3]
    seen &= finite_rows(position)
    notes = (*found.notes, *notes)
    return Export(found.time, position, attitude, seen, channels=channels, notes=notes)


def _channels(key: str, found: Messages, bag: Bag, mocap: Mocap) -> dict[str, Channel]:
    """Channels of the topic that `mocap.topics` gives for `key`."""
    values = CHANNELS[key](found, bag.path, mocap)
    return {kind: measured(found.time, value) for kind, value in values.items()}


def _depth(found: Messages, path: Path, mocap: Mocap) -> dict[str, Array]:
    return {"depth": messages.depths(found, path, mocap)}


def _odometry(found: Messages, path: Path, mocap: Mocap) -> dict[str, Array]:
    twist = messages.twists(found, path)
    return {"velocity": twist[:, :3], "rates": twist[:, 3:]}


def _velocity(found: Messages, path: Path, mocap: Mocap) -> dict[str, Array]:
    return {"velocity": messages.velocities(found, path)}


def _attitude(found: Messages, path: Path, mocap: Mocap) -> dict[str, Array]:
    return {"attitude": messages.attitudes(found, path)}


def _imu(found: Messages, path: Path, mocap: Mocap) -> dict[str, Array]:
    return messages.inertial(found, path)


def _battery(found: Messages, path: Path, mocap: Mocap) -> dict[str, Array]:
    return {"voltage": messages.voltages(found, path)}


CHANNELS = {
    "odometry": _odometry,
    "imu": _imu,
    "attitude": _attitude,
    "depth": _depth,
    "velocity": _velocity,
    "battery": _battery,
}
