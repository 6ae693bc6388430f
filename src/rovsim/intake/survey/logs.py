"""Find motions and commands in ArduPilot logs."""

from pathlib import Path
from typing import Iterator

import numpy as np

from rovsim.core.pwm import PILOT_CHANNELS, absent
from rovsim.intake.survey.contents import CommandCandidate, Contents, Track
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.formats.ardupilot.commands import LOG_FIELDS
from rovsim.measurement.recording.formats.ardupilot.logs import open_log
from rovsim.measurement.recording.formats.ardupilot.motion import read_log
from rovsim.measurement.recording.formats.ardupilot.series import ArduPilotLog
from rovsim.measurement.recording.tidying import tidy_export

MAX_CHANNELS = 16  # outputs and channels of a log


def look_into_log(path: Path) -> Contents:
    """Read the channels of a log, its outputs and the pilot's radio.

    Raises:
        BadInput: it is no such log, or holds no measurement.
    """
    mocap = Mocap(format="ardupilot", world_axes="ned", body_axes="frd")
    track = Track("", tidy_export(read_log(path, mocap), path))
    drives = tuple(_drives(open_log(path)))
    return Contents(path, "ardupilot", (track,), drives)


def _drives(log: ArduPilotLog) -> Iterator[CommandCandidate]:
    """List outputs to thrusters and the pilot's radio, without channels that carry no pulse."""
    for kind, (name, field) in LOG_FIELDS[log.kind].items():
        if name not in log.series:
            continue
        series = log.series[name]
        value = series.of([field.format(k) for k in range(1, MAX_CHANNELS + 1)])
        channels = np.flatnonzero((~absent(value) & np.isfinite(value)).any(axis=0)) + 1
        if kind == "SERVO" and len(channels):
            columns = tuple(f"SERVO{k}" for k in channels)
            meaning = f"outputs ({name}), in their order"
            yield CommandCandidate(
                "ardupilot", columns, series.time, value[:, channels - 1], "pwm", meaning
            )
        elif len(channels):
            pilot = {c: k for c in PILOT_CHANNELS if (k := int(c.lstrip("-RC"))) in channels}
            if pilot:
                sticks = value[:, [k - 1 for k in pilot.values()]]
                meaning = f"the pilot's radio ({name}) by ArduSub's order of channels"
                yield CommandCandidate(
                    "ardupilot",
                    tuple(pilot),
                    series.time,
                    sticks,
                    "demand",
                    meaning,
                    axes=tuple(PILOT_CHANNELS[c] for c in pilot),
                )
