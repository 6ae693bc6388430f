"""Commands in a csv file: `time_s` and the columns that the campaign names."""

import io
from pathlib import Path

import numpy as np

from rovsim.core.run import Commands
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands import as_commands, as_logged
from rovsim.measurement.recording.readers import CommandExport, command_reader
from rovsim.measurement.recording.table import (
    column_places,
    csv_lines,
    numbers,
    times,
    without_cut_line,
)


@command_reader("csv")
def read_commands(path: Path, log: CommandLog) -> CommandExport:
    """Read commands; lines with an empty or NaN cell are left out and counted.

    Raises:
        BadInput: not such a file, or values no such command can have.
    """
    lines = csv_lines(path)
    places = column_places(path, lines.names, ["time_s", *log.names, *log.auxiliary])
    table, cut = without_cut_line(lines, places)

    def place(line: int, column: int) -> str:
        return f"{path}, line {table.numbers[line]}, column '{log.names[column]}'"

    time, value = times(table, places[0]), numbers(table, places[1:])
    return as_commands(time, value, log, place, {"cut_lines": cut})


def format_commands(commands: Commands, log: CommandLog) -> str:
    """A file that `read_commands` reads back: times to 0.1 ms, pulses in whole us."""
    pulses = log.kind == "pwm"
    shapes = ["%d" if pulses and not turned else "%.4f" for turned in log.turned]
    text = io.StringIO()
    text.write(",".join(["time_s", *log.names]) + "\n")
    table = np.column_stack([commands.time, as_logged(commands, log)])
    np.savetxt(text, table, fmt=",".join(["%.4f", *shapes]))
    return text.getvalue()
