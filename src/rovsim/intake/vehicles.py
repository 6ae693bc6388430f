"""Find the vehicle files that a log of commands fits, and the order of its columns for each."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.run import Commands
from rovsim.core.shipped import conf_names
from rovsim.dynamics.vehicle import Vehicle, load_vehicle
from rovsim.measurement.campaign_file import CommandLog, LoggedKind
from rovsim.measurement.recording.candidates import CommandCandidate
from rovsim.measurement.recording.commands import as_commands, within
from rovsim.measurement.recording.tidying import tidy_commands

OUTPUT_PREFIX = "SERVO"  # columns of a log that may hold more outputs than thrusters


@dataclass(frozen=True, eq=False)
class VehicleMatch:
    """A vehicle that a log of commands may be of.

    Attributes:
        name: of the vehicle file.
        vehicle: what it describes.
        columns: of the log that the vehicle takes, in the order of its thrusters.
        kind: of the commands.
        by_name: whether the log names its columns as the vehicle file does.
    """

    name: str
    vehicle: Vehicle
    columns: tuple[str, ...]
    kind: LoggedKind
    by_name: bool


def fitting(drive: CommandCandidate) -> list[VehicleMatch]:
    """List the vehicles of conf/vehicle/ that can take a log's columns.

    If some of them name these columns as the log does, only those are listed.
    """
    fits = [fit for name in conf_names("vehicle") if (fit := _fit(name, drive)) is not None]
    return [fit for fit in fits if fit.by_name] or fits


def _fit(name: str, drive: CommandCandidate) -> VehicleMatch | None:
    vehicle = load_vehicle(name)
    expected = vehicle.command_columns
    if drive.kind in ("demand", "wrench"):
        return (
            VehicleMatch(name, vehicle, drive.columns, drive.kind, False)
            if _drives(vehicle, drive)
            else None
        )
    # names such as port or a fin's are the vehicle's own; t1, t2 … are names that anybody gives
    own_names = not all(column[-1].isdigit() for column in expected)
    available = {*drive.columns, *(drive.rest if own_names else ())}
    if expected and (
        set(expected) == set(drive.columns) or (own_names and set(expected) <= available)
    ):
        kind = drive.kind or _kind(drive, vehicle)
        return VehicleMatch(name, vehicle, expected, kind, own_names) if kind else None
    count = len(expected)
    outputs = all(column.startswith(OUTPUT_PREFIX) for column in drive.columns)
    if drive.kind is None or not count or len(drive.columns) < count or any(vehicle.angles):
        return None
    if len(drive.columns) == count or outputs:
        return VehicleMatch(name, vehicle, drive.columns[:count], drive.kind, False)
    return None


def _kind(drive: CommandCandidate, vehicle: Vehicle) -> LoggedKind | None:
    """Tell the kind from the columns of thrusters; those of angles are in rad in any log."""
    thrusters = [
        n for n, angle in zip(vehicle.command_columns, vehicle.angles, strict=True) if not angle
    ]
    value = drive.of(thrusters).ravel()
    kinds: tuple[LoggedKind, ...] = ("pwm", "normalized")
    return next((kind for kind in kinds if within(value, kind)), None)


def _drives(vehicle: Vehicle, drive: CommandCandidate) -> bool:
    """Whether a vehicle can move along all axes that demands or a wrench ask for."""
    log = drive.log()
    moving = {axis for k, axis in enumerate(log.axis_numbers) if np.nanstd(drive.value[:, k]) > 0}
    if not vehicle.free[list(moving)].all():
        return False
    if drive.kind == "wrench":
        return True
    mixer = vehicle.thrusters.mixer
    return mixer is not None and all(vehicle.thrusters.mixing()[:, axis].any() for axis in moving)


def convert_log(drive: CommandCandidate, fit: VehicleMatch, path: Path) -> Commands | None:
    """Convert a log to commands as the vehicle takes them.

    Args:
        drive: the log as read.
        fit: the vehicle, with the columns and the kind of the commands.
        path: of the log, for messages.

    Returns:
        None where the values are not of that kind.
    """
    log = drive.log(fit.columns, fit.kind)
    angles = [
        n for n, angle in zip(fit.vehicle.command_columns, fit.vehicle.angles, strict=True) if angle
    ]
    if not log.per_axis:
        log = log.model_copy(update={"angles": [n for n in log.names if n in angles]})
    value = drive.of(log.names)
    try:
        export = as_commands(
            drive.time, value, log, lambda line, column: str(path), pulses=_pulses(value, log)
        )
        return tidy_commands(export, path)[0]
    except BadInput:
        return None


def _pulses(value: Array, log: CommandLog) -> bool:
    """Whether demands are logged as pulses of a radio, in us."""
    return log.kind == "demand" and within(value.ravel(), "pwm")
