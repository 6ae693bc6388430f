"""Find motions and commands in ROS 2 bags."""

import re
from pathlib import Path
from typing import Any, Callable, Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.pwm import PILOT_CHANNELS, absent
from rovsim.intake.survey.contents import CommandCandidate, Contents, LoggedKind, Track
from rovsim.intake.survey.csv_commands import within
from rovsim.measurement.campaign_file import Mocap, Topics
from rovsim.measurement.recording.formats.rosbag2.bag import Bag, TopicSamples, opened
from rovsim.measurement.recording.formats.rosbag2.commands import (
    MANUAL_FIELDS,
    PULSE_TYPES,
    read_stick,
)
from rovsim.measurement.recording.formats.rosbag2.motion import POSE_TYPES, read_bag
from rovsim.measurement.recording.tidying import tidy_export

# Topics that say where the vehicle should be, or where something else is: never read.
GOALS = re.compile(r"goal|waypoint|setpoint|initialpose|target|desired|landing|mission|gp_", re.I)
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
# Message types of commands, in order of preference: what was sent to the thrusters comes first.
COMMAND_TYPES = (
    "RCOut",
    "MultiArray",
    "Wrench",
    "WrenchStamped",
    "ManualControl",
    "OverrideRCIn",
    "RCIn",
)

NO_POSES_NOTE = (
    "Transforms on {} are not read: write the vehicle's to a topic of PoseStamped or "
    "TransformStamped, and record that."
)
NO_COMMANDS_NOTE = (
    "{} says how fast the vehicle should be, and not what was sent to its thrusters: record RCOut, "
    "a MultiArray, a Wrench or ManualControl as well"
)


def look_into_bag(path: Path) -> Contents:
    """Find out which topics of a bag tell of motion and of commands, and read each.

    Raises:
        BadInput: it is no bag, or holds neither motion nor commands.
    """
    notes: list[str] = []
    with opened(path, by="rovsim init") as bag:
        topics = bag.topics
        drives = tuple(_drives(bag, notes))
    poses = _pose_topics(topics)
    channels = {key: topic for key in CHANNEL_TOPICS if (topic := _channel(topics, key))}
    tracks = tuple(_tracks(path, poses, notes))
    if not tracks and channels:
        tracks = tuple(_of_channels(path, channels, notes))
    elif channels:
        listed = ", ".join(f"{key}: {topic}" for key, topic in channels.items())
        notes.append(f"{path.name}: the bag also holds {listed}; 'mocap.topics' would read them.")
    if not tracks:
        notes += _unread(topics, "", "TFMessage", NO_POSES_NOTE)
    command_notes = (
        () if drives else _unread(topics, "cmd|command|teleop", "Twist.*", NO_COMMANDS_NOTE)
    )
    if tracks or drives:
        return Contents(
            path, "rosbag2", tracks, drives, notes=tuple(notes), unknown=" ".join(command_notes)
        )
    notes += command_notes
    raise BadInput(
        f"no topic of motion or of commands among {len(topics)}",
        where=path,
        expected=f"{', '.join(POSE_TYPES)}, Imu, pressure, or outputs to thrusters",
        remedy=" ".join(notes) or "Record these topics as well.",
    )


def _unread(topics: dict[str, str], named: str, kind: str, sentence: str) -> tuple[str, ...]:
    """Make a sentence on topics that rovsim does not read, if there are any.

    Args:
        topics: message type by topic.
        named: regex that is searched for in a topic's name.
        kind: regex of the whole short message type.
        sentence: the sentence, with {} for the topics.
    """
    matches = [
        topic
        for topic, name in topics.items()
        if re.search(named, topic, re.I) and re.fullmatch(kind, _short(name))
    ]
    return (sentence.format(", ".join(matches)),) if matches else ()


def _pose_topics(topics: dict[str, str]) -> list[str]:
    """List topics that hold poses of the vehicle, Odometry last."""
    poses = [t for t, kind in topics.items() if _short(kind) in POSE_TYPES and not GOALS.search(t)]
    alone = [t for t in poses if _short(topics[t]) != "Odometry"]
    stems = {t.rsplit("/", 1)[0] for t in alone}
    # Odometry in the namespace of a pose repeats that pose
    return alone + [t for t in poses if t not in alone and t.rsplit("/", 1)[0] not in stems]


def _short(kind: str) -> str:
    return kind.rsplit("/", 1)[-1]


def _channel(topics: dict[str, str], key: str) -> str | None:
    """Return the topic to read for a key of `mocap.topics`; None where the bag has none."""
    types, preferred, excluded = CHANNEL_TOPICS[key]
    candidates = [
        topic
        for topic, kind in topics.items()
        if _short(kind) in types
        and not re.search(excluded, topic, re.I)
        and not GOALS.search(topic)
    ]
    if key == "velocity":
        candidates = [
            t for t in candidates if re.search(preferred, t, re.I) or _short(topics[t]) == "DVL"
        ]
    candidates.sort(key=lambda topic: not re.search(preferred, topic, re.I))
    return candidates[0] if candidates else None


def _tracks(path: Path, topics: list[str], notes: list[str]) -> Iterator[Track]:
    """Read the motion of each topic of poses; notes tell of those that cannot be read."""
    for topic in topics:
        mocap = Mocap(format="rosbag2", body=topic, world_axes="z_up", body_axes="flu")
        try:
            yield Track(topic, tidy_export(read_bag(path, mocap), path))
        except BadInput as error:
            notes.append(f"{topic} is not read: {error.found}.")


def _of_channels(path: Path, beside: dict[str, str], notes: list[str]) -> Iterator[Track]:
    """Read the motion of a bag without poses from its sensors, by key of `mocap.topics`."""
    mocap = Mocap(format="rosbag2", world_axes="z_up", body_axes="flu", topics=Topics(**beside))
    try:
        yield Track("", tidy_export(read_bag(path, mocap), path), beside)
    except BadInput as error:
        notes.append(f"{', '.join(beside.values())}: {error.found}.")


def _drives(bag: Bag, notes: list[str]) -> Iterator[CommandCandidate]:
    """Read what may be commands, by `COMMAND_TYPES`; notes tell of what cannot be read."""
    outputs = [
        t for t in bag.topics if _place(bag.topics[t]) < len(COMMAND_TYPES) and not GOALS.search(t)
    ]
    for topic in sorted(outputs, key=lambda topic: _place(bag.topics[topic])):
        try:
            drive = _drive(bag, topic)
            if drive.columns:
                yield drive
        except BadInput as error:
            notes.append(f"{topic} is not read: {error.found}.")


def _place(kind: str) -> int:
    """Return the position of a type in `COMMAND_TYPES`, its length where it is no command."""
    ranks = [k for k, name in enumerate(COMMAND_TYPES) if _short(kind).endswith(name)]
    return min(ranks, default=len(COMMAND_TYPES))


def _drive(bag: Bag, topic: str) -> CommandCandidate:
    kind, message = bag.first(topic, "commands.topic")
    name = _short(kind)
    if name in PULSE_TYPES:
        pulses = bag.read(
            topic, "commands.topic", _padded("channels", len(message.channels)), "pulses"
        )
        return _outputs(pulses) if name == "RCOut" else _pilot(pulses)
    if "Wrench" in name:
        return CommandCandidate(
            "rosbag2",
            tuple(AXES),
            *_numbers(bag, topic, _forces),
            "wrench",
            f"messages of the type {name}",
            topic,
        )
    if name == "ManualControl":
        time, value = _numbers(
            bag, topic, lambda m: [read_stick(m, axis) for axis in MANUAL_FIELDS]
        )
        return CommandCandidate(
            "rosbag2",
            tuple(MANUAL_FIELDS),
            time,
            value,
            "demand",
            "the pilot's sticks (ManualControl)",
            topic,
        )
    time, value = _numbers(bag, topic, _padded("data", len(message.data)))
    columns = tuple(f"t{k + 1}" for k in range(value.shape[1]))
    logged_kind, meaning = _kind(value)
    return CommandCandidate(
        "rosbag2", columns, time, value, logged_kind, f"{name}: {meaning}", topic
    )


def _padded(field: str, count: int) -> Callable[[Any], list[float]]:
    """Make a function that takes `count` numbers of a message's array, NaN where it holds fewer."""
    return lambda m: [
        *map(float, getattr(m, field)[:count]),
        *[np.nan] * (count - len(getattr(m, field))),
    ]


def _forces(message: Any) -> list[float]:
    inner = getattr(message, "wrench", message)
    return [getattr(part, axis) for part in (inner.force, inner.torque) for axis in "xyz"]


def _numbers(bag: Bag, topic: str, numbers: Callable) -> tuple[Array, Array]:
    samples = bag.read(topic, "commands.topic", numbers, "numbers")
    return samples.time, samples.value


def _kind(value: Array) -> tuple[LoggedKind | None, str]:
    """Tell the kind of an array of numbers by their size, None where unknown; and why."""
    for kind, meaning in (("pwm", "pulses in us"), ("normalized", "within -1 and 1")):
        if within(value.ravel(), kind):  # type: ignore[arg-type]
            return kind, meaning  # type: ignore[return-value]
    return None, f"numbers from {np.nanmin(value):.4g} to {np.nanmax(value):.4g}"


def _given(samples: TopicSamples) -> Array:
    """Mark the channels (c,) that ever carried a pulse."""
    return (~absent(samples.value) & np.isfinite(samples.value)).any(axis=0)


def _outputs(samples: TopicSamples) -> CommandCandidate:
    numbers = np.flatnonzero(_given(samples)) + 1
    columns = tuple(f"SERVO{k}" for k in numbers)
    return CommandCandidate(
        "rosbag2",
        columns,
        samples.time,
        samples.value[:, numbers - 1],
        "pwm",
        "outputs to thrusters (RCOut), in their order",
        samples.topic,
    )


def _pilot(samples: TopicSamples) -> CommandCandidate:
    active = _given(samples)
    columns = [
        c for c in PILOT_CHANNELS if (k := _channel_number(c)) <= len(active) and active[k - 1]
    ]
    value = samples.value[:, [_channel_number(c) - 1 for c in columns]]
    return CommandCandidate(
        "rosbag2",
        tuple(columns),
        samples.time,
        value,
        "demand",
        "the pilot's radio by ArduSub's order of channels",
        samples.topic,
        tuple(PILOT_CHANNELS[c] for c in columns),
    )


def _channel_number(column: str) -> int:
    return int(column.lstrip("-RC"))
