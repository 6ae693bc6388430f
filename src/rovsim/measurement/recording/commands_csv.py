"""Commands in a csv file: `time_s` and the columns that the campaign names."""

from pathlib import Path

from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands import as_commands
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
