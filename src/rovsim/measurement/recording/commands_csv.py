"""Commands in a csv file: `time_s` and the columns that the campaign names."""

import io
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core import pwm
from rovsim.core.run import Commands
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands import ALLOWED, as_commands, as_logged
from rovsim.measurement.recording.readers import CommandExport, CommandReader
from rovsim.measurement.recording.table import column_places, csv_lines, numbers, without_cut_line
from rovsim.measurement.recording.times import times

HEAVE = AXES.index("heave")


def read_commands(path: Path, log: CommandLog) -> CommandExport:
    """Read commands; lines with an empty or NaN cell are left out and counted.

    Demands that are pulses of a radio, in us, are seen by their size.

    Raises:
        BadInput: not such a file, or values no such command can have.
    """
    lines = csv_lines(path)
    places = column_places(path, lines.names, ["time_s", *log.names, *log.auxiliary])
    table, cut = without_cut_line(lines, places)

    def place(line: int, column: int) -> str:
        return f"{path}, line {table.numbers[line]}, column '{log.names[column]}'"

    time, value = times(table, places[0]), numbers(table, places[1:])
    value, notes = _of_a_radio(value, log)
    return as_commands(time, value, log, place, {"cut_lines": cut}, pulses=bool(notes), notes=notes)


def _of_a_radio(value: Array, log: CommandLog) -> tuple[Array, tuple[str, ...]]:
    """Values (m, c) whose demands may be pulses, and what to say about it; else as they are."""
    own = value[:, : len(log.names)]
    given = own[np.isfinite(own) & ~pwm.absent(own)]
    low, high = ALLOWED["pwm"][:2]
    if log.kind != "demand" or not len(given) or given.min() < low or given.max() > high:
        return value, ()
    said = "The demands are pulses in us, read as (pulse - 1500) / 400."
    heave = log.axis_numbers.index(HEAVE) if HEAVE in log.axis_numbers else None
    if heave is not None and log.signs[heave] > 0:
        name = log.names[heave]
        said += (
            f" A long pulse of '{name}' is taken for down; where the stick is up (ArduSub), write "
            f"'-{name}' in commands.columns."
        )
    value = value.copy()
    value[:, : len(log.names)] = np.where(pwm.absent(own), np.nan, own)
    return value, (said,)


def format_commands(commands: Commands, log: CommandLog) -> str:
    """A file that `read_commands` reads back: times to 0.1 ms, pulses in whole us."""
    pulses = log.kind == "pwm"
    shapes = ["%d" if pulses and not turned else "%.4f" for turned in log.turned]
    text = io.StringIO()
    text.write(",".join(["time_s", *log.names]) + "\n")
    table = np.column_stack([commands.time, as_logged(commands, log)])
    np.savetxt(text, table, fmt=",".join(["%.4f", *shapes]))
    return text.getvalue()


COMMAND_READER = CommandReader("csv", read_commands, auxiliary=True)
