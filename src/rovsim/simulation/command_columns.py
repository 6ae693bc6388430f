"""Columns of a command log: which are angles, and how many digits a log keeps of each."""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.pwm import in_whole_pulses
from rovsim.core.run import CommandKind
from rovsim.dynamics.vehicle import Vehicle
from rovsim.measurement.campaign import Campaign


def mark_angles(campaign: Campaign, vehicle: Vehicle) -> Campaign:
    """Note in the description of a campaign's log which of its columns are angles, in rad.

    Columns are taken in the order of `Vehicle.command_columns`, whatever their names are.

    Raises:
        BadInput: a column has the name of a command of the vehicle, but the place of another.
    """
    log, expected = campaign.commands, vehicle.command_columns
    if log is None or log.per_axis or not any(vehicle.angles) or len(log.names) != len(expected):
        return campaign
    for name, column in zip(log.names, expected, strict=True):
        if name != column and name in expected:
            raise BadInput(
                f"the column '{name}' stands where '{column}' belongs",
                where=f"{campaign.file}, commands.columns",
                expected=f"the vehicle's order: {', '.join(expected)}",
                remedy="Put the columns into that order.",
            )
    angles = [name for name, angle in zip(log.names, vehicle.angles, strict=True) if angle]
    return replace(campaign, commands=log.model_copy(update={"angles": angles}))


def round_as_logged(value: Array, kind: CommandKind, vehicle: Vehicle) -> Array:
    """Round commands (..., c) as a log does: thrusters to PWM in whole us, others to 4 decimals."""
    rounded = np.round(value, 4)
    if kind != "thruster":
        return rounded
    return np.where(vehicle.angles, rounded, in_whole_pulses(value))
