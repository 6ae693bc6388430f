"""Read commands of an ArduPilot log: outputs to thrusters (SERVO1 …) or the radio (RC1 …)."""

import re
from pathlib import Path

from numpy import ndarray as Array

from rovsim.core import pwm
from rovsim.core.errors import BadInput
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands import as_commands
from rovsim.measurement.recording.exports import CommandExport
from rovsim.measurement.recording.formats.ardupilot.logs import needs, open_log
from rovsim.measurement.recording.formats.ardupilot.series import ArduPilotLog, Series

# Kind of log -> kind of column -> type of message, and the field of a number.
LOG_FIELDS = {
    "dataflash": {"SERVO": ("RCOU", "C{}"), "RC": ("RCIN", "C{}")},
    "telemetry": {
        "SERVO": ("SERVO_OUTPUT_RAW", "servo{}_raw"),
        "RC": ("RC_CHANNELS", "chan{}_raw"),
    },
}


def read_commands(path: Path, log: CommandLog) -> CommandExport:
    """Read columns SERVO1, SERVO2, … or RC1, RC2, …, pulses in us.

    Raises:
        BadInput: no such log, no such column in it, or other kinds of command.
    """
    kind, numbers = _wanted(path, log)
    vehicle_log = open_log(path)
    series, field = _series(vehicle_log, kind)
    names = [field.format(number) for number in numbers]
    missing = [log.names[k] for k, name in enumerate(names) if name not in series.fields]
    if missing:
        raise BadInput(
            f"no output or channel {', '.join(missing)} in {LOG_FIELDS[vehicle_log.kind][kind][0]}",
            where=path,
            expected="columns that the log holds",
            remedy="Correct 'commands.columns'.",
        )
    value, notes = _without_pulse(series.of(names), kind)

    def place(line: int, column: int) -> str:
        return f"{path}, at {series.time[line]:.3f} s, column '{log.names[column]}'"

    return as_commands(series.time, value, log, place, pulses=True, notes=notes)


def _wanted(path: Path, log: CommandLog) -> tuple[str, list[int]]:
    """Whether the columns are of SERVO or RC, and their numbers."""
    parts = [re.fullmatch(r"(SERVO|RC)([1-9]\d?)", name) for name in log.names]
    kinds = {part[1] for part in parts if part}
    if len(kinds) != 1 or not all(parts) or log.kind == "wrench":
        raise BadInput(
            f"the columns {', '.join(log.names)} of the kind {log.kind}",
            where="commands.columns in campaign.yaml",
            expected=f"SERVO1, SERVO2, … or RC1, RC2, … of {path.name}, pulses in us, for "
            "thrusters or as demands",
            remedy="Correct 'commands.columns' and 'commands.kind'.",
        )
    return kinds.pop(), [int(part[2]) for part in parts if part]


def _series(held: ArduPilotLog, wanted: str) -> tuple[Series, str]:
    name, field = LOG_FIELDS[held.kind][wanted]
    if name not in held.series:
        raise needs(held, [name], "no commands")
    series = held.series[name]
    return series, field


def _without_pulse(value: Array, wanted: str) -> tuple[Array, tuple[str, ...]]:
    """Replace values (m, c) of 0 and 65535, which mean "no pulse", as in a bag of mavros."""
    if wanted != "RC":
        return pwm.of_outputs(value)
    return pwm.of_inputs(value), ()
