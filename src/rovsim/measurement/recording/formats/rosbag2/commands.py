"""Read commands of a bag: pulses, arrays, wrenches, joysticks, or fields of any message."""

import re
from pathlib import Path
from typing import Any, Callable, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core import pwm
from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput, nearest
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands import as_commands
from rovsim.measurement.recording.exports import CommandExport
from rovsim.measurement.recording.formats.rosbag2.bag import Bag, TopicSamples, opened

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
PULSE_TYPES = ("RCOut", "OverrideRCIn", "RCIn")
# MAVLink MANUAL_CONTROL as ArduSub takes it: x, y, r in -1000 .. 1000, z in 0 .. 1000 and up
MANUAL_FIELDS: Mapping[str, tuple[str, int, int]] = {
    "surge": ("x", 0, 1000),
    "sway": ("y", 0, 1000),
    "heave": ("z", 500, -500),
    "yaw": ("r", 0, 1000),
}
WRENCH_FIELDS = dict(
    zip(AXES, [f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"], strict=True)
)

Get = Callable[[Any], float]


def read_commands(path: Path, log: CommandLog) -> CommandExport:
    """Read the topic `commands.topic`, by default the only one that looks like commands.

    A column is a field (`thrust.port`, `data[0]`), or ends in the number of its value, from 1
    (`t1`, `SERVO3`, `RC5`), or is an axis. Columns with other names are the values in order.

    Raises:
        BadInput: no bag, no such topic or column, or values no such command can have.
    """
    with opened(path, by="commands.format: rosbag2") as bag:
        topic = log.topic or _only_topic(bag)
        kind, sample = bag.first(topic, "commands.topic")
        getters = [_getter(kind, sample, log, k, f"{path}, {topic}") for k in range(len(log.names))]
        samples = bag.read(
            topic,
            "commands.topic",
            lambda message: [_number(getter, message) for getter in getters],
            "numbers in these fields",
        )

    def place(line: int, column: int) -> str:
        return f"{path}, {samples.topic}, message {line + 1}, column '{log.names[column]}'"

    pulses = samples.kind.endswith(PULSE_TYPES) and log.kind != "wrench"
    value, notes = _without_pulse(samples) if pulses else (samples.value, ())
    notes = (*samples.notes, *notes)
    return as_commands(samples.time, value, log, place, pulses=pulses, notes=notes)


def read_stick(message: Any, axis: str) -> float:
    """Deflection of a stick, in [-1, 1], from a ManualControl message."""
    field, center, span = MANUAL_FIELDS[axis]
    return float((getattr(message, field) - center) / span)


def _only_topic(bag: Bag) -> str:
    likely = [t for t, kind in bag.topics.items() if any(word in kind for word in COMMAND_TYPES)]
    if len(likely) == 1:
        return likely[0]
    raise BadInput(
        f"{len(likely)} topics that look like commands: {', '.join(likely) or 'none'}",
        where=bag.path,
        expected="the topic to read as 'commands.topic'",
        remedy="Name one." if likely else nearest("", bag.topics),
    )


def _without_pulse(samples: TopicSamples) -> tuple[Array, tuple[str, ...]]:
    """Replace values (m, c) of 0 and 65535, which mean "no pulse"; with sentences about them.

    An output without pulses is a thruster at rest; an input without pulses is missing.
    """
    if not samples.kind.endswith("RCOut"):
        return pwm.of_inputs(samples.value), ()
    value, notes = pwm.of_outputs(samples.value)
    return value, tuple(f"{samples.topic}: {note}" for note in notes)


def _getter(kind: str, first: Any, log: CommandLog, k: int, where: str) -> Get:
    """Make the function that takes column k out of a message.

    Args:
        kind: type of the messages.
        first: the first of them.
        log: names and axes of the columns.
        k: index of the column.
        where: the topic, for errors.
    """
    name = log.names[k]
    axis = log.axes[k] if log.axes else name
    if kind.endswith("ManualControl") and axis in MANUAL_FIELDS:
        return lambda message: read_stick(message, axis)
    inner = getattr(first, "wrench", first)
    if hasattr(inner, "force") and axis in WRENCH_FIELDS:
        return _walk(("wrench." if inner is not first else "") + WRENCH_FIELDS[axis])
    if re.fullmatch(r"[A-Za-z]\w*([.[].*)?", name) and hasattr(first, re.split(r"[.[]", name)[0]):
        return _walk(name)
    arrays = [f for f in getattr(first, "__dataclass_fields__", {}) if _is_array(first, f)]
    number = re.search(r"(\d+)$", name)
    if len(arrays) == 1:
        return _walk(f"{arrays[0]}[{int(number[1]) - 1 if number else k}]")
    fields = ", ".join(getattr(first, "__dataclass_fields__", {}))
    raise BadInput(
        f"no value for the column '{name}' in {kind} (fields {fields})",
        where=where,
        expected="columns that are fields of the message, such as 'data[0]' or 'thrust.port'",
        remedy="Correct 'commands.columns'.",
    )


def _is_array(message: Any, field: str) -> bool:
    return isinstance(getattr(message, field), np.ndarray)


def _walk(name: str) -> Get:
    """Make the function that follows fields and indices from 0, such as `a.b[2].c`."""
    steps = re.findall(r"(\w+)|\[(\d+)\]", name)

    def get(message: Any) -> float:
        for field, index in steps:
            message = message[int(index)] if index else getattr(message, field)
        return float(message)

    return get


def _number(get: Get, message: Any) -> float:
    """Take a number out of a message; NaN where an array is too short."""
    try:
        return get(message)
    except IndexError:
        return float("nan")
