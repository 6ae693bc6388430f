"""Find motions in ROS 2 bags."""

import re
from pathlib import Path
from typing import Iterator

from rovsim.core.errors import BadInput
from rovsim.intake.survey.contents import Contents, Track
from rovsim.measurement.campaign_file import Mocap, Topics
from rovsim.measurement.recording.candidates import FoundCommands
from rovsim.measurement.recording.formats.rosbag2.bag import opened
from rovsim.measurement.recording.formats.rosbag2.motion import POSE_TYPES, read_bag
from rovsim.measurement.recording.formats.rosbag2.topic_names import (
    GOALS,
    short_type,
    tell_of_unread,
)

# Key of `mocap.topics` -> message types, regex of topics preferred, regex of topics never taken.
CHANNEL_TOPICS = {
    "imu": (("Imu",), "data$", "raw"),
    "depth": (("FluidPressure",), "static|depth|bar", "diff"),
    "velocity": (
        ("DVL", "TwistStamped", "TwistWithCovarianceStamped"),
        "dvl",
        "wind|gps|cmd|mocap",
    ),
    "battery": (("BatteryState",), "battery", "$^"),
}

NO_POSES_NOTE = (
    "Transforms on {} are not read: write the vehicle's to a topic of PoseStamped or "
    "TransformStamped, and record that."
)


def look_into_bag(path: Path, commands: FoundCommands) -> Contents:
    """Find out which topics of a bag tell of motion, and read each.

    Args:
        path: of the bag.
        commands: that were found in it.

    Raises:
        BadInput: it is no bag, or holds neither motion nor commands.
    """
    notes = [*commands.notes]
    with opened(path, by="rovsim init") as bag:
        topics = bag.topics
    poses = _pose_topics(topics)
    channels = {key: topic for key in CHANNEL_TOPICS if (topic := _channel(topics, key))}
    tracks = tuple(_tracks(path, poses, notes))
    if not tracks and channels:
        tracks = tuple(_of_channels(path, channels, notes))
    elif channels:
        listed = ", ".join(f"{key}: {topic}" for key, topic in channels.items())
        notes.append(f"{path.name}: the bag also holds {listed}; 'mocap.topics' would read them.")
    if not tracks and (unread := tell_of_unread(topics, "", "TFMessage", NO_POSES_NOTE)):
        notes.append(unread)
    if tracks or commands.candidates:
        return Contents(
            path,
            "rosbag2",
            tracks,
            commands.candidates,
            notes=tuple(notes),
            unknown=commands.unknown,
        )
    raise BadInput(
        f"no topic of motion or of commands among {len(topics)}",
        where=path,
        expected=f"{', '.join(POSE_TYPES)}, Imu, pressure, or outputs to thrusters",
        remedy=" ".join([*notes, commands.unknown]).strip() or "Record these topics as well.",
    )


def _pose_topics(topics: dict[str, str]) -> list[str]:
    """List topics that hold poses of the vehicle, Odometry last."""
    poses = [
        t for t, kind in topics.items() if short_type(kind) in POSE_TYPES and not GOALS.search(t)
    ]
    alone = [t for t in poses if short_type(topics[t]) != "Odometry"]
    stems = {t.rsplit("/", 1)[0] for t in alone}
    # Odometry in the namespace of a pose repeats that pose
    return alone + [t for t in poses if t not in alone and t.rsplit("/", 1)[0] not in stems]


def _channel(topics: dict[str, str], key: str) -> str | None:
    """Return the topic to read for a key of `mocap.topics`; None where the bag has none."""
    types, preferred, excluded = CHANNEL_TOPICS[key]
    candidates = [
        topic
        for topic, kind in topics.items()
        if short_type(kind) in types
        and not re.search(excluded, topic, re.I)
        and not GOALS.search(topic)
    ]
    if key == "velocity":
        candidates = [
            t for t in candidates if re.search(preferred, t, re.I) or short_type(topics[t]) == "DVL"
        ]
    candidates.sort(key=lambda topic: not re.search(preferred, topic, re.I))
    return candidates[0] if candidates else None


def _tracks(path: Path, topics: list[str], notes: list[str]) -> Iterator[Track]:
    """Read the motion of each topic of poses; notes tell of those that cannot be read."""
    for topic in topics:
        mocap = Mocap(format="rosbag2", body=topic, world_axes="z_up", body_axes="flu")
        try:
            yield Track.of(topic, read_bag(path, mocap), path)
        except BadInput as error:
            notes.append(f"{topic} is not read: {error.found}.")


def _of_channels(path: Path, beside: dict[str, str], notes: list[str]) -> Iterator[Track]:
    """Read the motion of a bag without poses from its sensors, by key of `mocap.topics`."""
    mocap = Mocap(format="rosbag2", world_axes="z_up", body_axes="flu", topics=Topics(**beside))
    try:
        yield Track.of("", read_bag(path, mocap), path, beside)
    except BadInput as error:
        notes.append(f"{', '.join(beside.values())}: {error.found}.")
