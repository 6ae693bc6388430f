"""What the vehicle could have been told, and never was in the runs: nothing is known of it."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.dynamics.vehicle import Vehicle
from rovsim.estimation.observer.usable_runs import UsableRuns

RESTING = 0.01  # of a command or a demand, N, N m, rad: 4 us of a pulse, the rounding of a log


def list_not_commanded(usable: UsableRuns, vehicle: Vehicle) -> tuple[str, ...]:
    """Thrusters and surfaces by name, or axes where these are commanded, that stayed at rest.

    Axes in which nothing moved are told as that; runs without any commands tell of none.
    """
    logs = [run.motion.commands for run in usable.runs if len(run.motion.commands.time)]
    if not logs:
        return ()
    told = np.max([np.max(np.abs(log.value), axis=0) for log in logs], axis=0)
    resting = told <= RESTING
    if logs[0].kind == "thruster":
        return _named(vehicle.command_columns, resting & ~np.array(vehicle.angles, bool))
    silent = np.isin(AXES, usable.still)
    return _named(AXES, resting & vehicle.free & ~silent & _pushed(vehicle, logs[0].kind))


def _pushed(vehicle: Vehicle, kind: str) -> Array:
    """Axes (6,) that a command of that kind can push."""
    if kind == "wrench" or vehicle.thrusters.mixer is None:
        return np.ones(len(AXES), bool)
    return np.asarray(vehicle.thrusters.mixing().any(axis=0))


def _named(names: Sequence[str], which: Array) -> tuple[str, ...]:
    return tuple(name for name, yes in zip(names, which, strict=True) if yes)
