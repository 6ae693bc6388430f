"""From the files of a run to one `Recording` in NED and FRD."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.rotations import axes_signs
from rovsim.core.run import Commands, Logged, RunInfo, Site
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.campaign_file import CommandLog, Mocap, Run
from rovsim.measurement.recording import channels
from rovsim.measurement.recording.channels import Channels
from rovsim.measurement.recording.csv_checks import MAX_STEP_S
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.joined import join
from rovsim.measurement.recording.readers import (
    COMMAND_KINDS,
    command_readers,
    mocap_readers,
    reader_of,
)
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.recording.repairs import Anomalies, CommandRepairs
from rovsim.measurement.recording.tidying import measured_rate, tidy_commands, tidy_export

# Times beyond this are dates (seconds since 1970 or since the machine was started); a day is none.
MIN_DATE_S = 1e5
MAX_DURATION_RATIO = 100.0  # times as long as the recording: the log has another unit of time


def read_run(campaign: Campaign, run_id: str) -> tuple[Recording, Anomalies]:
    """Read the measurements and commands of one run; nothing is filtered or filled in.

    Raises:
        BadInput: a file cannot be used; names the file, the place in it and the remedy.
    """
    run, mocap = campaign.run(run_id), campaign.mocap
    reader = reader_of(mocap.format, mocap_readers(), f"{campaign.file}, mocap.format")
    paths = campaign.mocap_paths(run)
    export = tidy_export(join({path: reader.read(path, mocap) for path in paths}), paths[0])
    commands, repairs, notes = _read_commands(campaign, run)
    if run.commanded:
        _check_clocks(export.time, commands.time, campaign.commands_path(run))
    export, commands = _from_zero(export, _with_battery(commands, export.channels))
    export, left_out = _use(export, run)
    info = RunInfo(run.id, run.control, run.split)
    recording = to_ned(export, mocap, info, site(campaign), commands)
    notes = tuple(dict.fromkeys([*export.notes, *notes]))
    spans = tuple((begin, end) for begin, end in run.use or ())
    return recording, Anomalies(export.repairs, repairs, left_out, spans, notes)


def site(campaign: Campaign) -> Site:
    """Where the campaign was recorded."""
    return Site(campaign.tank_ned(), campaign.world_signs())


def _read_commands(
    campaign: Campaign, run: Run
) -> tuple[Commands, CommandRepairs, tuple[str, ...]]:
    log = campaign.commands
    if not run.commanded or log is None:
        return _no_commands(log), CommandRepairs(), ()
    reader = reader_of(log.format, command_readers(), f"{campaign.file}, commands.format")
    path = campaign.commands_path(run)
    export = reader.read(path, log)
    commands, repairs = tidy_commands(export, path)
    return _shifted(commands, run.commands_shift_s), repairs, export.notes


def _no_commands(log: CommandLog | None) -> Commands:
    """Make a log without lines, of the kind of the other runs, or a wrench if none has commands."""
    kind = COMMAND_KINDS[log.kind] if log else "wrench"
    columns = len(log.columns) if log and not log.per_axis else len(AXES)
    return Commands(np.empty(0), np.empty((0, columns)), kind)


def _from_zero(export: Export, commands: Commands) -> tuple[Export, Commands]:
    """Count times that are dates from the full second in which the recording starts.

    Near 1.7e9 s, floating-point times are 2.4e-7 s apart, and one per mille of a time is weeks.
    """
    start = float(np.floor(export.time[0]))
    if abs(start) < MIN_DATE_S:
        return export, commands
    shifted = {k: replace(c, time=c.time - start) for k, c in export.channels.items()}
    export = replace(export, time=export.time - start, channels=shifted)
    return export, _shifted(commands, -start)


def _shifted(commands: Commands, by: float) -> Commands:
    """Add `by` seconds to the times of commands."""
    auxiliary = {k: replace(x, time=x.time + by) for k, x in commands.auxiliary.items()}
    return replace(commands, time=commands.time + by, auxiliary=auxiliary)


def _use(export: Export, run: Run) -> tuple[Export, int]:
    """Leave out what lies outside of the used spans of a run.

    Lines with poses stay, but the body counts as not found there, so that the clock goes on.

    Returns:
        The export, and the number of lines that lie outside.

    Raises:
        BadInput: nothing lies inside.
    """
    if run.use is None:
        return export, 0

    def inside(time: Array) -> Array:
        return np.any([(time >= begin) & (time <= end) for begin, end in run.use or ()], axis=0)

    mask = inside(export.time)
    if not mask.any():
        raise BadInput(
            f"{run.use} holds nothing of it: it lasts from {export.time[0]:.10g} to "
            f"{export.time[-1]:.10g} s",
            where=f"campaign.yaml, run {run.id}, use",
            expected="spans [from, to] in s on the clock of the recording",
            remedy="Look at the time axis of the figures that `rovsim compare` draws.",
        )
    used_channels = {
        name: replace(
            channel,
            time=channel.time[inside(channel.time)],
            value=channel.value[inside(channel.time)],
        )
        for name, channel in export.channels.items()
    }
    if not export.tracked.any():
        return _cut(export, mask, used_channels), int(np.sum(~mask))
    return replace(export, tracked=export.tracked & mask, channels=used_channels), int(
        np.sum(~mask)
    )


def _cut(export: Export, used: Array, kept: Channels) -> Export:
    """Remove the unused lines of an export without poses; `kept` are its remaining channels."""
    rows = {n: getattr(export, n)[used] for n in ("time", "position", "attitude", "tracked")}
    return replace(export, **rows, channels=kept)


def _with_battery(commands: Commands, channels: Channels) -> Commands:
    """Add the voltage of the battery to the commands, if the recording has it and the log not."""
    battery = channels.get("voltage")
    if battery is None or "voltage" in commands.auxiliary:
        return commands
    voltage = Logged(battery.time, battery.value[:, 0])
    return replace(commands, auxiliary={**commands.auxiliary, "voltage": voltage})


def to_ned(export: Export, mocap: Mocap, info: RunInfo, at: Site, commands: Commands) -> Recording:
    """Turn an export in the file's axes into a recording in NED and FRD.

    With S the signs of the axes as diagonal matrices: p = S_world p_file and
    R = S_world R_file S_body, so each side is converted on its own.
    """
    world, body = axes_signs(mocap.world_axes), axes_signs(mocap.body_axes)
    tracked = export.tracked[:, None]
    nu = None if export.nu is None else export.nu * np.tile(body, 2)
    return Recording(
        info,
        at,
        export.time,
        np.where(tracked, export.position * world, np.nan),
        np.where(tracked, channels.attitude_to_ned(export.attitude, mocap), np.nan),
        export.tracked,
        commands,
        export.rate or measured_rate(export.time),
        nu,
        channels.to_ned(export.channels, mocap),
        mocap.sensors,
    )


def _check_clocks(measured: Array, commands: Array, path: Path) -> None:
    """Refuse commands in another unit of time than the recording, or without common times.

    Args:
        measured: times (n,) of the recording, s.
        commands: times (m,) of the commands.
        path: the file of the commands, for the error.
    """
    span = (
        f"the commands run from {commands[0]:.10g} to {commands[-1]:.10g} s, "
        f"what was measured from {measured[0]:.10g} to {measured[-1]:.10g} s"
    )
    longer = float(np.ptp(commands)) > MAX_DURATION_RATIO * float(np.ptp(measured))
    if len(commands) > 1 and longer and np.median(np.diff(commands)) > MAX_STEP_S:
        raise BadInput(
            f"{span}: ms, us or ns?",
            where=path,
            expected="times of the commands in seconds",
            remedy="Divide them, or let `rovsim init` make a copy in s.",
        )
    # a single command holds from then on, however early
    if commands[0] >= measured[-1] or (len(commands) > 1 and commands[-1] <= measured[0]):
        raise BadInput(
            span,
            where=path,
            expected="commands on the clock of the motion capture",
            remedy="Say in the run which seconds to add to their times: 'commands_shift_s'.",
        )
