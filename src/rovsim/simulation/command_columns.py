"""Columns of a command log: which are angles, and how many digits they keep."""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.pwm import in_whole_pulses
from rovsim.core.run import CommandKind
from rovsim.dynamics.vehicle import Vehicle
from rovsim.measurement.campaign import Campaign


def mark_angles(campaign: Campaign, vehicle: Vehicle) -> Campaign:
    """The campaign, its log told which of its columns are angles in rad.

    Columns stand in the vehicle's order, whatever they are called.

    Raises:
        BadInput: a column called like one of the vehicle's stands in another's place.
    """
    log, expected = campaign.commands, vehicle.command_columns
    if log is None or log.per_axis or not any(vehicle.angles) or len(log.names) != len(expected):
        return campaign
    for name, place in zip(log.names, expected, strict=True):
        if name != place and name in expected:
            raise BadInput(
                f"the column '{name}' stands where '{place}' belongs",
                where=f"{campaign.file}, commands.columns",
                expected=f"the vehicle's order: {', '.join(expected)}",
                remedy="Put the columns into that order.",
            )
    angles = [name for name, angle in zip(log.names, vehicle.angles, strict=True) if angle]
    return replace(campaign, commands=log.model_copy(update={"angles": angles}))


def round_as_logged(value: Array, kind: CommandKind, vehicle: Vehicle) -> Array:
    """Values (..., c) to the digits that a log keeps: pulses in whole us, else four decimals."""
    rounded = np.round(value, 4)
    if kind != "thruster":
        return rounded
    return np.where(vehicle.angles, rounded, in_whole_pulses(value))
