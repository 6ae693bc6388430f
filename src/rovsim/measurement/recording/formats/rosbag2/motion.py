"""Read the motion in a bag: poses, and channels of other topics."""

from pathlib import Path

import numpy as np

from rovsim.core.errors import BadInput, nearest
from rovsim.measurement.campaign_file import Mocap, Topics
from rovsim.measurement.recording.attitudes import check_unit_length, finite_rows, unit_quaternions
from rovsim.measurement.recording.channels import Channel, measured
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.formats.rosbag2.bag import Bag, TopicSamples, opened
from rovsim.measurement.recording.formats.rosbag2.messages import TopicReader, pose, topic_readers
from rovsim.measurement.recording.readers import FileAxes, MocapReader
from rovsim.measurement.recording.signature import FileSignature, starts_with

POSE_TYPES = ("PoseStamped", "PoseWithCovarianceStamped", "TransformStamped", "Odometry")


def read_bag(path: Path, mocap: Mocap) -> Export:
    """Read the topics that `mocap.topics` and `mocap.body` name.

    Raises:
        BadInput: no bag, no such topic, or messages of an unknown type.
    """
    with opened(path, by="mocap.format: rosbag2") as bag:
        topics = mocap.topics or Topics()
        pose_topic = _pose_topic(bag, mocap, topics)
        channels: dict[str, Channel] = {}
        notes: list[str] = []
        for key, reader in topic_readers(mocap).items():
            topic = getattr(topics, key)
            if topic and topic != pose_topic:
                samples = bag.read(topic, f"mocap.topics.{key}", reader.numbers, reader.expected)
                channels |= _channels(samples, reader)
                notes += samples.notes
        if pose_topic is None:
            return Export.of_channels(channels, notes=tuple(notes))
        channels.pop("attitude", None)  # it is part of the poses
        return _poses(bag, pose_topic, channels, tuple(notes))


def _pose_topic(bag: Bag, mocap: Mocap, topics: Topics) -> str | None:
    """The topic of full poses; None where the campaign names topics of other channels alone."""
    stated = topics.pose or topics.odometry or mocap.body
    if stated:
        return stated
    if mocap.topics is not None:
        return None
    candidates = [
        topic
        for topic, kind in bag.topics.items()
        if kind.endswith(tuple(f"/{p}" for p in POSE_TYPES))
    ]
    if len(candidates) == 1:
        return candidates[0]
    raise BadInput(
        f"{len(candidates)} topics of poses: {', '.join(candidates) or 'none'}",
        where=bag.path,
        expected="the topic to read as 'mocap.body', or 'mocap.topics'",
        remedy="Name one." if candidates else nearest("", bag.topics),
    )


def _poses(bag: Bag, topic: str, channels: dict[str, Channel], notes: tuple[str, ...]) -> Export:
    samples = bag.read(topic, "mocap.body", pose, "a pose: position and orientation")
    position = samples.value[:, :3]
    attitude, valid = unit_quaternions(samples.value[:, 3:])
    valid &= finite_rows(position)
    source = f"{bag.path}, topic {topic}"
    doubts = check_unit_length(samples.value[:, 3:], lambda row: f"{source}, message {row + 1}")
    notes = (*samples.notes, *notes, *doubts)
    return Export(samples.time, position, attitude, valid, channels=channels, notes=notes)


def _channels(samples: TopicSamples, reader: TopicReader) -> dict[str, Channel]:
    values = {kind: samples.value[:, columns] for kind, columns in reader.channels.items()}
    if "attitude" in values:
        attitude, valid = unit_quaternions(values["attitude"])
        values["attitude"] = np.where(valid[:, None], attitude, np.nan)
    return {kind: measured(samples.time, value) for kind, value in values.items()}


MOCAP_READER = MocapReader(
    "rosbag2",
    "a ROS 2 bag",
    read_bag,
    (
        FileSignature(starts_with(b"SQLite format 3\0"), "a ROS 2 bag (sqlite3)", (".db3",)),
        FileSignature(starts_with(b"\x89MCAP"), "a ROS 2 bag (MCAP)", (".mcap",)),
    ),
    axes=FileAxes(usual=("z_up", "flu"), reason="guess: what ROS means by default (REP 103)"),
    folder=True,
    options={"topics": "topics of a ROS 2 bag"},
)
