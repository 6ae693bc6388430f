"""Commands in a csv file: `time_s` and the columns that the campaign names."""

from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.measurement.campaign import AXES, CommandLog
from rovsim.measurement.recording.readers import KIND, CommandExport, command_reader, finite_rows
from rovsim.measurement.recording.table import (
    Lines,
    column_places,
    csv_lines,
    numbers,
    times,
    without_cut_line,
)

# PWM = 1500 us + 400 us * c (the vehicle file's comment). Beyond 1100 .. 1900 us a speed
# controller gives no more; beyond 800 .. 2200 us no servo signal is valid.
PWM_CENTER, PWM_SPAN = 1500.0, 400.0
ALLOWED = {
    "pwm": (800.0, 2200.0, "pulses of 800 to 2200 us"),
    "normalized": (-1.05, 1.05, "commands in [-1, 1]"),
    "demand": (-1.05, 1.05, "demands in [-1, 1]"),
    "wrench": (-np.inf, np.inf, "a finite wrench in N, N m"),
}


@command_reader("csv")
def read_commands(path: Path, log: CommandLog) -> CommandExport:
    """Read commands; lines with an empty or NaN cell are left out and counted.

    Raises:
        BadInput: not such a file, or values no such command can have.
    """
    lines = csv_lines(path)
    places = column_places(path, lines.names, ["time_s", *log.columns])
    table, cut = without_cut_line(lines, places)
    time, value = times(table, places[0]), numbers(table, places[1:])
    _check_range(table, value, places[1:], log)
    whole = finite_rows(value)
    value, clipped = _normalized(value[whole], log)
    counts = {"cut_lines": cut, "dropped": int(np.sum(~whole)), "clipped": clipped}
    return CommandExport(time[whole], value, KIND[log.kind], counts)


def _check_range(table: Lines, value: Array, places: list[int], log: CommandLog) -> None:
    low, high, expected = ALLOWED[log.kind]
    bad = np.argwhere((value < low) | (value > high) | np.isinf(value))
    if bad.size:
        line, column = bad[0]
        name = table.names[places[column]]
        raise BadInput(
            f"the value {value[line, column]:g} ({len(bad)} such cells)",
            where=f"{table.path}, line {table.numbers[line]}, column '{name}'",
            expected=f"{expected}, as 'commands.kind: {log.kind}' says",
            remedy="Correct 'commands.kind' in campaign.yaml, or that value.",
        )


def _normalized(value: Array, log: CommandLog) -> tuple[Array, int]:
    """Values (m, c) as the model takes them, and how many lines reached beyond [-1, 1]."""
    if log.kind == "pwm":
        value = (value - PWM_CENTER) / PWM_SPAN
    if log.per_axis:
        value = _all_axes(value, log.axes)
    if log.kind == "wrench":
        return value, 0
    return np.clip(value, -1.0, 1.0), int(np.sum((np.abs(value) > 1.0).any(axis=1)))


def _all_axes(value: Array, axes: list[int]) -> Array:
    """Values (m, 6), surge to yaw; an axis without a column got no command."""
    full = np.zeros((len(value), len(AXES)))
    full[:, axes] = value
    return full
