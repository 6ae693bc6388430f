"""Turn logged values into commands, whatever file they came from."""

from dataclasses import replace
from typing import Callable

import numpy as np
from numpy import ndarray as Array

from rovsim.core import pwm
from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.run import Commands, Logged
from rovsim.measurement.campaign_file import CommandLog, LoggedKind
from rovsim.measurement.recording.attitudes import finite_rows
from rovsim.measurement.recording.exports import CommandExport
from rovsim.measurement.recording.readers import COMMAND_KINDS
from rovsim.measurement.recording.repairs import CommandRepairs

# Beyond 1100 .. 1900 us a speed controller gives no more; beyond 800 .. 2200 us no servo signal is
# valid.
UNIT_RANGES = {
    "pwm": (800.0, 2200.0, "pulses of 800 to 2200 us"),
    "normalized": (-1.05, 1.05, "commands in [-1, 1]"),
    "demand": (-1.05, 1.05, "demands in [-1, 1], or pulses of 800 to 2200 us in all columns"),
    "wrench": (-np.inf, np.inf, "a finite wrench in N, N m"),
}

MAX_PERCENT, MAX_PULSE_OFFSET_US = 105.0, 700.0  # how far percent, and pulses less 1500 us, reach

Locate = Callable[[int, int], str]  # where the value in (line, column) stands, for people


def as_commands(
    time: Array,
    value: Array,
    log: CommandLog,
    locate: Locate,
    repairs: CommandRepairs | None = None,
    *,
    pulses: bool = False,
    notes: tuple[str, ...] = (),
) -> CommandExport:
    """Turn logged values into commands; lines with a NaN are left out and counted.

    Args:
        time: (m,) s.
        value: (m, c), the columns of the log, followed by its auxiliary ones.
        log: what the columns mean.
        locate: says where a value stands, for errors.
        repairs: those that were made before.
        pulses: whether the values are pulses in us although the log says otherwise, as for a
            demand from a radio.
        notes: sentences about the file.

    Raises:
        BadInput: values that no such command can have.
    """
    unit = "pwm" if pulses else log.kind
    value, extra = value[:, : len(log.names)], value[:, len(log.names) :]
    _check_range(value, log, unit, locate)
    complete = finite_rows(value)
    value, clipped = _normalized(value[complete], log, unit)
    repairs = replace(repairs or CommandRepairs(), dropped=int(np.sum(~complete)), clipped=clipped)
    auxiliary = {
        name: Logged(time[np.isfinite(column)], column[np.isfinite(column)])
        for name, column in zip(log.auxiliary, extra.T, strict=False)
    }
    return CommandExport(time[complete], value, COMMAND_KINDS[log.kind], repairs, notes, auxiliary)


def are_pulses(value: Array) -> bool:
    """Whether numbers of any shape are pulses in us: there are some, all within the valid range.

    NaN and the numbers that stand for no pulse do not count.
    """
    low, high, _ = UNIT_RANGES["pwm"]
    pulses = value[np.isfinite(value) & ~pwm.absent(value)]
    return bool(len(pulses) and pulses.min() >= low and pulses.max() <= high)


def within(value: Array, kind: LoggedKind) -> bool:
    """Whether a column can be commands of a kind, by the size of its numbers."""
    if kind == "pwm":
        return are_pulses(value)
    low, high = UNIT_RANGES[kind][:2]
    finite = value[np.isfinite(value)]
    return bool(len(finite) and finite.min() >= low and finite.max() <= high)


def _check_range(value: Array, log: CommandLog, unit: str, locate: Locate) -> None:
    low, high, expected = UNIT_RANGES[unit]
    beyond = ((value < low) | (value > high)) & ~np.array(log.turned)
    invalid = np.argwhere(beyond | np.isinf(value))
    if invalid.size:
        line, column = (int(k) for k in invalid[0])
        raise BadInput(
            f"the value {value[line, column]:g} ({len(invalid)} such cells)",
            where=locate(line, column),
            expected=f"{expected}, as 'commands.kind: {log.kind}' says",
            remedy=f"{_hint(value, log)}Correct 'commands.kind' in campaign.yaml, or that value.",
        )


def _hint(value: Array, log: CommandLog) -> str:
    """Sentence on the unit that the values (m, c) may have by their size; empty if unknown."""
    entries = value[:, ~np.array(log.turned)]
    entries = entries[~np.isnan(entries)]
    if not np.isfinite(entries).all() or not entries.size:
        return ""
    low, high = float(entries.min()), float(entries.max())
    unit = guess_unit(low, high)
    return f"By their size ({low:g} to {high:g}) they may be {unit}. " if unit else ""


def guess_unit(low: float, high: float) -> str:
    """Say what commands from `low` to `high` may be and how to convert them; empty if unknown."""
    if low >= UNIT_RANGES["pwm"][0] and high <= UNIT_RANGES["pwm"][1]:
        return "pulses in us, kind pwm"
    size = max(-low, high)
    if size <= UNIT_RANGES["normalized"][1]:
        return "shares, kind normalized or demand"
    if low >= 1e-3 * UNIT_RANGES["pwm"][0] and high <= 1e-3 * UNIT_RANGES["pwm"][1]:
        return "pulses in ms: times 1000 they are of kind pwm"
    if size <= MAX_PERCENT:
        return (
            "percent: divide them by 100, then they are shares; or newtons: divide them by the "
            "thrust at full command, or add them up to a wrench on the vehicle"
        )
    if low < 0.0 and size <= MAX_PULSE_OFFSET_US:
        return (
            "pulses less 1500 us: add 1500; or revolutions per minute: convert them to shares "
            "from -1 to 1"
        )
    if low < 0.0:
        return "revolutions per minute: convert them to shares from -1 to 1"
    return ""


def _normalized(value: Array, log: CommandLog, unit: str) -> tuple[Array, int]:
    """Convert values (m, c) to what the model takes, and count the lines that exceeded [-1, 1].

    Commands and demands are limited to [-1, 1]; wrenches (N, N m) and angles (rad) are not.
    """
    angles = value * log.signs
    if unit == "pwm":
        value = pwm.to_commands(value)
    value = value * log.signs
    if log.per_axis:
        value = _all_axes(value, log.axis_numbers)
    if log.kind == "wrench":
        return value, 0
    is_angle = np.zeros(value.shape[1], bool) if log.per_axis else np.array(log.turned)
    beyond = (np.abs(value) > 1.0) & ~is_angle
    clipped = np.clip(value, -1.0, 1.0)
    if is_angle.any():
        clipped = np.where(is_angle, angles, clipped)
    return clipped, int(np.sum(beyond.any(axis=1)))


def _all_axes(value: Array, axes: list[int]) -> Array:
    """Put the columns of `axes` into all six axes (m, 6), surge to yaw; others get zero."""
    full = np.zeros((len(value), len(AXES)))
    full[:, axes] = value
    return full


def as_logged(commands: Commands, log: CommandLog) -> np.ndarray:
    """Values (m, c) with which a log would record these commands: the inverse of `as_commands`."""
    value = commands.value[:, log.axis_numbers] if log.per_axis else commands.value
    signed = value * log.signs
    if log.kind != "pwm":
        return signed
    return np.where(log.turned, signed, pwm.to_pulses(signed))
