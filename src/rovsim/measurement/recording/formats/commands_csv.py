"""Commands in a csv file: `time_s` and the columns that the campaign names."""

import io
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core import pwm
from rovsim.core.axes import AXES
from rovsim.core.run import Commands
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands import are_pulses, as_commands, as_logged
from rovsim.measurement.recording.exports import CommandExport
from rovsim.measurement.recording.readers import CommandReader
from rovsim.measurement.recording.repairs import CommandRepairs
from rovsim.measurement.recording.tables.delimited import csv_lines, without_cut_line
from rovsim.measurement.recording.tables.named_columns import column_places
from rovsim.measurement.recording.tables.numbers import numbers
from rovsim.measurement.recording.tables.times import times

HEAVE = AXES.index("heave")


def read_commands(path: Path, log: CommandLog) -> CommandExport:
    """Read commands; lines without any value are left out and counted.

    An empty or NaN cell of another line takes the previous value of its column. Demands that are
    pulses of a radio, in us, are recognised by their size.

    Raises:
        BadInput: the file cannot be read so, or values that no such command can have.
    """
    lines = csv_lines(path)
    places = column_places(path, lines.names, ["time_s", *log.names, *log.auxiliary])
    table, cut_lines = without_cut_line(lines, places)

    def place(line: int, column: int) -> str:
        return f"{path}, line {table.numbers[line]}, column '{log.names[column]}'"

    time, value = times(table, places[0]), numbers(table, places[1:])
    command_columns = slice(len(log.names))
    value[:, command_columns], pulse_notes = _without_pulse(value[:, command_columns], log)
    value[:, command_columns], fill_notes = _held(time, value[:, command_columns])
    value, radio_notes = _of_a_radio(value, log)
    notes = (*pulse_notes, *radio_notes, *fill_notes)
    repairs = CommandRepairs(cut_lines=cut_lines)
    return as_commands(time, value, log, place, repairs, pulses=bool(radio_notes), notes=notes)


def _without_pulse(value: Array, log: CommandLog) -> tuple[Array, tuple[str, ...]]:
    """Replace outputs without a pulse by the pulse of no command, if all other values are pulses.

    Args:
        value: logged values (m, c).
        log: says which columns are angles; these stay as they are.

    Returns:
        The values, and sentences about what was replaced. Values that are not pulses stay as they
        are, and are refused later.
    """
    pulses = value[:, ~np.array(log.turned)]
    if log.kind != "pwm" or not are_pulses(pulses):
        return value, ()
    value = value.copy()
    value[:, ~np.array(log.turned)], notes = pwm.of_outputs(pulses)
    return value, notes


def _held(time: Array, value: Array) -> tuple[Array, tuple[str, ...]]:
    """Fill cells of a log that only records changes: each column holds until its next value.

    Args:
        time: (m,) s, in any order.
        value: logged values (m, c), NaN in empty cells.

    Returns:
        The filled values, and a sentence if any was filled. Lines without any value stay empty.
    """
    order = np.argsort(time, kind="stable")
    present = ~np.isnan(value[order])
    nonempty = present.any(axis=1)[:, None]
    previous = np.maximum.accumulate(np.where(present, np.arange(len(time))[:, None], -1), axis=0)
    to_fill = nonempty & ~present & (previous >= 0)
    if not to_fill.any():
        return value, ()
    filled = value.copy()
    filled[order] = np.where(
        to_fill, np.take_along_axis(value[order], previous, axis=0), value[order]
    )
    return filled, (
        f"{to_fill.sum()} cells of the commands are empty beside others that are not: the value "
        "before holds on.",
    )


def _of_a_radio(value: Array, log: CommandLog) -> tuple[Array, tuple[str, ...]]:
    """Turn demands that are pulses of a radio into [-1, 1]; with a sentence if they are."""
    demands = value[:, : len(log.names)]
    if log.kind != "demand" or not are_pulses(demands):
        return value, ()
    note = "The demands are pulses in us, read as (pulse - 1500) / 400."
    heave = log.axis_numbers.index(HEAVE) if HEAVE in log.axis_numbers else None
    if heave is not None and log.signs[heave] > 0:
        name = log.names[heave]
        note += (
            f" A long pulse of '{name}' is taken for down; where the stick is up (ArduSub), write "
            f"'-{name}' in commands.columns."
        )
    value = value.copy()
    value[:, : len(log.names)] = pwm.of_inputs(demands)
    return value, (note,)


def format_commands(commands: Commands, log: CommandLog) -> str:
    """Write commands as text that `read_commands` can read: times to 0.1 ms, pulses in whole us."""
    pulses = log.kind == "pwm"
    shapes = ["%d" if pulses and not is_angle else "%.4f" for is_angle in log.turned]
    text = io.StringIO()
    text.write(",".join(["time_s", *log.names]) + "\n")
    table = np.column_stack([commands.time, as_logged(commands, log)])
    np.savetxt(text, table, fmt=",".join(["%.4f", *shapes]))
    return text.getvalue()


COMMAND_READER = CommandReader(
    "csv",
    read_commands,
    options={
        "auxiliary": "further columns of a csv (from other logs the battery's voltage is read by "
        "itself)"
    },
)
