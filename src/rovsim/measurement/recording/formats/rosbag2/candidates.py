"""Find the topics of a bag that may be commands."""

from pathlib import Path
from typing import Any, Callable, Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.measurement.campaign_file import LoggedKind
from rovsim.measurement.recording.candidates import CommandCandidate, FoundCommands
from rovsim.measurement.recording.commands import within
from rovsim.measurement.recording.formats.rosbag2.bag import Bag, opened
from rovsim.measurement.recording.formats.rosbag2.commands import (
    COMMAND_TYPES,
    MANUAL_FIELDS,
    PULSE_TYPES,
    read_stick,
)
from rovsim.measurement.recording.formats.rosbag2.topic_names import (
    GOALS,
    short_type,
    tell_of_unread,
)
from rovsim.measurement.recording.pulse_candidates import from_outputs, from_radio

NO_COMMANDS_NOTE = (
    "{} says how fast the vehicle should be, and not what was sent to its thrusters: record RCOut, "
    "a MultiArray, a Wrench or ManualControl as well"
)


def find_commands(path: Path) -> FoundCommands:
    """Find the topics of a bag that may be commands, and read each.

    Raises:
        BadInput: it is no bag.
    """
    notes: list[str] = []
    with opened(path, by="rovsim init") as bag:
        candidates = tuple(_candidates(bag, notes))
        topics = bag.topics
    if candidates:
        return FoundCommands(candidates, tuple(notes))
    unread = tell_of_unread(topics, "cmd|command|teleop", "Twist.*", NO_COMMANDS_NOTE)
    return FoundCommands((), tuple(notes), unread)


def _candidates(bag: Bag, notes: list[str]) -> Iterator[CommandCandidate]:
    """Read what may be commands, by `COMMAND_TYPES`; notes tell of what cannot be read."""
    ranks = {
        topic: rank
        for topic, kind in bag.topics.items()
        if (rank := _rank(kind)) < len(COMMAND_TYPES) and not GOALS.search(topic)
    }
    for topic in sorted(ranks, key=ranks.__getitem__):
        try:
            candidate = _candidate(bag, topic)
            if candidate.columns:
                yield candidate
        except BadInput as error:
            notes.append(f"{topic} is not read: {error.found}.")


def _rank(kind: str) -> int:
    """Return the position of a type in `COMMAND_TYPES`, its length where it is no command."""
    ranks = [k for k, name in enumerate(COMMAND_TYPES) if short_type(kind).endswith(name)]
    return min(ranks, default=len(COMMAND_TYPES))


def _candidate(bag: Bag, topic: str) -> CommandCandidate:
    kind, message = bag.first(topic, "commands.topic")
    name = short_type(kind)
    if name in PULSE_TYPES:
        return _of_pulses(bag, topic, name, len(message.channels))
    if "Wrench" in name:
        time, value = _numbers(bag, topic, _forces)
        reason = f"messages of the type {name}"
        return CommandCandidate("rosbag2", tuple(AXES), time, value, "wrench", reason, topic)
    if name == "ManualControl":
        time, value = _numbers(
            bag, topic, lambda message: [read_stick(message, axis) for axis in MANUAL_FIELDS]
        )
        reason = "the pilot's sticks (ManualControl)"
        return CommandCandidate(
            "rosbag2", tuple(MANUAL_FIELDS), time, value, "demand", reason, topic
        )
    time, value = _numbers(bag, topic, _padded("data", len(message.data)))
    columns = tuple(f"t{k + 1}" for k in range(value.shape[1]))
    logged_kind, meaning = _kind(value)
    return CommandCandidate(
        "rosbag2", columns, time, value, logged_kind, f"{name}: {meaning}", topic
    )


def _of_pulses(bag: Bag, topic: str, name: str, count: int) -> CommandCandidate:
    """Read `count` channels of pulses, in messages of a type that is called `name`."""
    samples = bag.read(topic, "commands.topic", _padded("channels", count), "pulses")
    if name == "RCOut":
        reason = "outputs to thrusters (RCOut), in their order"
        return from_outputs("rosbag2", samples.time, samples.value, reason, topic)
    reason = "the pilot's radio by ArduSub's order of channels"
    return from_radio("rosbag2", samples.time, samples.value, reason, topic)


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
    meanings: dict[LoggedKind, str] = {"pwm": "pulses in us", "normalized": "within -1 and 1"}
    for kind, meaning in meanings.items():
        if within(value.ravel(), kind):
            return kind, meaning
    return None, f"numbers from {np.nanmin(value):.4g} to {np.nanmax(value):.4g}"
