"""From the files of a run to one `Recording` in NED and FRD."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import axes_signs, multiply
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.campaign import Campaign, Mocap
from rovsim.measurement.recording.readers import (
    CommandExport,
    Export,
    command_readers,
    mocap_readers,
    reader_of,
)
from rovsim.measurement.recording.recording import Recording

RATES_DIFFER = 0.02  # share of the header's rate; clock jitter stays far below


@dataclass(frozen=True)
class Anomalies:
    """How much of the raw files had to be repaired or left out, in lines."""

    duplicates: int = 0
    unsorted: int = 0
    cut_lines: int = 0
    bad_rotations: int = 0
    wrong_header_rate: int = 0  # 1: the header's rate does not agree with the times
    command_duplicates: int = 0
    command_unsorted: int = 0
    command_cut_lines: int = 0
    command_dropped: int = 0
    command_clipped: int = 0
    command_long_steps: int = 0


def read_run(campaign: Campaign, run_id: str) -> tuple[Recording, Anomalies]:
    """Read the poses and commands of one run; nothing is filtered or filled in.

    Raises:
        BadInput: a file cannot be used; names the file, the place in it and the remedy.
    """
    run = campaign.run(run_id)
    mocap, log = campaign.mocap, campaign.commands
    place = f"{campaign.file}, "
    read_poses = reader_of(mocap.format, mocap_readers(), place + "mocap.format")
    read_commands = reader_of(log.format, command_readers(), place + "commands.format")
    poses_path, commands_path = campaign.mocap_path(run), campaign.commands_path(run)
    poses, pose_counts = tidy_poses(read_poses(poses_path, mocap), poses_path)
    commands, command_counts = tidy_commands(read_commands(commands_path, log), commands_path)
    _check_overlap(poses.time, commands.time, commands_path)
    info = RunInfo(run.id, run.control, run.split)
    recording = to_ned(poses, mocap, info, site(campaign), commands)
    return recording, Anomalies(**pose_counts, **command_counts)


def site(campaign: Campaign) -> Site:
    """Where the campaign was recorded."""
    return Site(campaign.tank_ned(), campaign.world_signs())


def to_ned(poses: Export, mocap: Mocap, info: RunInfo, at: Site, commands: Commands) -> Recording:
    """Turn poses in the file's axes into a recording in NED and FRD.

    With S the signs of the axes as diagonal matrices: p = S_world p_file and
    R = S_world R_file S_body, so each side is converted on its own.
    """
    world, body = axes_signs(mocap.world_axes), axes_signs(mocap.body_axes)
    turned = multiply(multiply(_quaternion(world), poses.attitude), _quaternion(body))
    seen = poses.found[:, None]
    nu = None if poses.nu is None else poses.nu * np.tile(body, 2)
    return Recording(
        info,
        at,
        poses.time,
        np.where(seen, poses.position * world, np.nan),
        np.where(seen, np.where(turned[:, :1] < 0, -turned, turned), np.nan),
        poses.found,
        commands,
        poses.rate or measured_rate(poses.time),
        nu,
    )


def _quaternion(signs: Array) -> Array:
    """Rotation with the matrix diag(signs): none, or a half turn about x."""
    return np.array([1.0, 0, 0, 0]) if signs[1] > 0 else np.array([0.0, 1, 0, 0])


def tidy_poses(poses: Export, path: Path) -> tuple[Export, dict[str, int]]:
    """Sort by time, keep the first of equal times, and check the rate; count what was wrong.

    Raises:
        BadInput: no frame, one time only, or no frame in which the body was found.
    """
    order = np.argsort(poses.time, kind="stable")
    time = poses.time[order]
    keep = order[np.diff(time, prepend=-np.inf) > 0]
    if len(keep) < 2 or not poses.found[keep].any():
        found = "no frame in which the body was found" if len(keep) > 1 else "no frames"
        raise BadInput(
            f"{found} ({len(time)} lines)",
            where=path,
            expected="a run with at least two frames and the body in sight",
            remedy="Export the run again, or take it out of 'runs'.",
        )
    counts = dict(poses.counts)
    rate, measured = poses.rate, measured_rate(poses.time[keep])
    if rate and abs(measured / rate - 1.0) > RATES_DIFFER:
        rate, counts["wrong_header_rate"] = None, 1
    counts["unsorted"] = int(np.sum(np.diff(poses.time) < 0))
    counts["duplicates"] = len(time) - len(keep)
    return Export(
        poses.time[keep],
        poses.position[keep],
        poses.attitude[keep],
        poses.found[keep],
        rate,
        None if poses.nu is None else poses.nu[keep],
    ), counts


def measured_rate(time: Array) -> float:
    """Rate in Hz of the usual step between the times (n,)."""
    return 1.0 / float(np.median(np.diff(time)))


def tidy_commands(log: CommandExport, path: Path) -> tuple[Commands, dict[str, int]]:
    """Sort by time and keep the last of equal times (it is what the vehicle got); count both.

    Raises:
        BadInput: no line is left.
    """
    if not len(log.time):
        raise BadInput(
            f"no commands ({log.counts.get('dropped', 0)} lines without a value)",
            where=path,
            expected="at least one line with a time and every column",
            remedy="Export the commands again, or take the run out of 'runs'.",
        )
    order = np.argsort(log.time, kind="stable")
    time = log.time[order]
    keep = order[np.diff(time, append=np.inf) > 0]
    steps = np.diff(log.time[keep])
    counts = {f"command_{name}": count for name, count in log.counts.items()}
    counts["command_unsorted"] = int(np.sum(np.diff(log.time) < 0))
    counts["command_duplicates"] = len(time) - len(keep)
    # a missing line makes a step twice as long
    counts["command_long_steps"] = int(np.sum(steps > 1.5 * np.median(steps))) if len(steps) else 0
    return Commands(log.time[keep], log.value[keep], log.kind), counts


def _check_overlap(poses: Array, commands: Array, path: Path) -> None:
    if commands[0] >= poses[-1] or commands[-1] <= poses[0]:
        raise BadInput(
            f"the commands run from {commands[0]:g} to {commands[-1]:g} s, "
            f"the poses from {poses[0]:g} to {poses[-1]:g} s",
            where=f"{path}, column 'time_s'",
            expected="commands on the clock of the motion capture",
            remedy="Shift the command times to that clock.",
        )
