"""Find what may be commands in an ArduPilot log."""

from pathlib import Path
from typing import Iterator

from rovsim.measurement.recording.candidates import CommandCandidate, FoundCommands
from rovsim.measurement.recording.formats.ardupilot.commands import LOG_FIELDS
from rovsim.measurement.recording.formats.ardupilot.logs import open_log
from rovsim.measurement.recording.formats.ardupilot.series import ArduPilotLog
from rovsim.measurement.recording.pulse_candidates import from_outputs, from_radio

MAX_CHANNELS = 16  # outputs and channels of a log


def find_commands(path: Path) -> FoundCommands:
    """Find outputs to thrusters and the pilot's radio, without channels that carry no pulse.

    Raises:
        BadInput: it is no such log.
    """
    found = _candidates(open_log(path))
    return FoundCommands(tuple(candidate for candidate in found if candidate.columns))


def _candidates(log: ArduPilotLog) -> Iterator[CommandCandidate]:
    for kind, (name, field) in LOG_FIELDS[log.kind].items():
        if name not in log.series:
            continue
        series = log.series[name]
        pulses = series.of([field.format(k) for k in range(1, MAX_CHANNELS + 1)])
        if kind == "SERVO":
            reason = f"outputs ({name}), in their order"
            yield from_outputs("ardupilot", series.time, pulses, reason)
        else:
            reason = f"the pilot's radio ({name}) by ArduSub's order of channels"
            yield from_radio("ardupilot", series.time, pulses, reason)
