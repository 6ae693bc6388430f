"""Sort what was read by time, keep each time once, and count what was wrong."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.robust import LONG_STEP
from rovsim.core.run import Commands, Logged
from rovsim.measurement.recording.channels import Channels, tidy_channels
from rovsim.measurement.recording.exports import CommandExport, Export
from rovsim.measurement.recording.one_run import check_one_run
from rovsim.measurement.recording.repairs import CommandRepairs, MotionRepairs
from rovsim.measurement.recording.repeated import without_repeated

RATE_TOLERANCE = 0.02  # share of the header's rate; clock jitter stays far below


def tidy_export(export: Export, path: Path) -> Export:
    """Sort by time, keep the first of equal times, and check the rate.

    Poses that only repeat the one before are removed (`without_repeated`). Poses in none of which
    the body was found stay: such a run is too short to be used.

    Returns:
        The export, whose `repairs` count what was wrong.

    Raises:
        BadInput: there are neither two frames nor a channel with two samples.
        SeveralRuns: the times start again.
    """
    for time in (export.time[export.tracked], *(c.time for c in export.channels.values())):
        check_one_run(time, path)
    channels, unsorted, duplicates = tidy_channels(export.channels)
    repairs = replace(export.repairs, unsorted=unsorted, duplicates=duplicates)
    if not export.tracked.any() and any(len(c.time) > 1 for c in channels.values()):
        return _of_channels(replace(export, repairs=repairs), channels)
    order = np.argsort(export.time, kind="stable")
    time = export.time[order]
    keep = order[np.diff(time, prepend=-np.inf) > 0]
    if len(keep) < 2 or (channels and not export.tracked[keep].any()):
        raise _too_few(export, path)
    rate, measured = export.rate, measured_rate(export.time[keep])
    if rate and abs(measured / rate - 1.0) > RATE_TOLERANCE:
        rate, repairs = None, replace(repairs, wrong_header_rate=1)
    repairs += MotionRepairs(
        unsorted=int(np.sum(np.diff(export.time) < 0)), duplicates=len(time) - len(keep)
    )
    tidied = replace(
        export,
        time=export.time[keep],
        position=export.position[keep],
        attitude=export.attitude[keep],
        tracked=export.tracked[keep],
        rate=rate,
        nu=None if export.nu is None else export.nu[keep],
        repairs=repairs,
        channels=channels,
    )
    return without_repeated(tidied)


def _too_few(export: Export, path: Path) -> BadInput:
    lines = max(len(export.time), *(len(c.time) for c in export.channels.values()), 0)
    return BadInput(
        f"no frames, and no channel with two samples ({lines} lines)"
        if export.channels
        else f"no frames ({lines} lines)",
        where=path,
        expected="a run with at least two frames, or two samples of a channel",
        remedy="Export the run again, or take it out of 'runs'.",
    )


def _of_channels(export: Export, channels: Channels) -> Export:
    """Make an export without poses, whose frames are the times of all channels."""
    time = np.unique(np.concatenate([channel.time for channel in channels.values()]))
    unknown = np.full((len(time), 7), np.nan)
    rate = max(channel.rate or 0.0 for channel in channels.values())
    return replace(
        export,
        time=time,
        position=unknown[:, :3],
        attitude=unknown[:, 3:],
        tracked=np.zeros(len(time), bool),
        rate=rate,
        nu=None,
        channels=channels,
    )


def measured_rate(time: Array) -> float:
    """Rate in Hz of the median step between the times (n,) s."""
    return 1.0 / float(np.median(np.diff(time)))


def tidy_commands(log: CommandExport, path: Path) -> tuple[Commands, CommandRepairs]:
    """Sort by time and keep the last of equal times (it is what the vehicle got); count both.

    Raises:
        BadInput: no line is left.
        SeveralRuns: the times start again.
    """
    if not len(log.time):
        raise BadInput(
            f"no commands ({log.repairs.dropped} lines without a value)",
            where=path,
            expected="at least one line with a time and every column",
            remedy="Export the commands again, or take the run out of 'runs'.",
        )
    check_one_run(log.time, path)
    order = np.argsort(log.time, kind="stable")
    time = log.time[order]
    keep = order[np.diff(time, append=np.inf) > 0]
    steps = np.diff(log.time[keep])
    longest = LONG_STEP * np.median(steps) if len(steps) else np.inf
    repairs = replace(
        log.repairs,
        unsorted=int(np.sum(np.diff(log.time) < 0)),
        duplicates=len(time) - len(keep),
        long_steps=int(np.sum(steps > longest)),
    )
    auxiliary = {
        name: _in_order(logged) for name, logged in log.auxiliary.items() if len(logged.time)
    }
    return Commands(log.time[keep], log.value[keep], log.kind, auxiliary), repairs


def _in_order(own: Logged) -> Logged:
    """Sort by time, and keep the first of equal times."""
    time, index = np.unique(own.time, return_index=True)
    return Logged(time, own.value[index])
