"""Find thrusters, surfaces or axes that the runs never commanded: nothing is known of these."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.dynamics.vehicle import Vehicle
from rovsim.estimation.observer.usable_runs import UsableRuns

# Of a normalised command or demand, N, N m or rad: 4 us of a pulse, about what a log rounds to.
MAX_IDLE_AMPLITUDE = 0.01


def list_not_commanded(usable: UsableRuns, vehicle: Vehicle) -> tuple[str, ...]:
    """List what stayed at rest in all runs: thrusters and surfaces, or axes if these are commanded.

    Axes along which the vehicle did not move are left out, as a diagnosis reports them by
    themselves. Where no run has commands, nothing is listed.

    Args:
        usable: train runs.
        vehicle: says which thrusters and axes there are.
    """
    logs = [run.motion.commands for run in usable.runs if len(run.motion.commands.time)]
    if not logs:
        return ()
    amplitude = np.max([np.max(np.abs(log.value), axis=0) for log in logs], axis=0)
    resting = amplitude <= MAX_IDLE_AMPLITUDE
    if logs[0].kind == "thruster":
        return _select_names(vehicle.command_columns, resting & ~np.array(vehicle.angles, bool))
    silent = np.isin(AXES, usable.still)
    return _select_names(
        AXES, resting & vehicle.free & ~silent & _mark_pushable(vehicle, logs[0].kind)
    )


def _mark_pushable(vehicle: Vehicle, kind: str) -> Array:
    """Mask (6,) of the axes that commands of a kind can push."""
    if kind == "wrench" or vehicle.thrusters.mixer is None:
        return np.ones(len(AXES), bool)
    return np.asarray(vehicle.thrusters.mixing().any(axis=0))


def _select_names(names: Sequence[str], which: Array) -> tuple[str, ...]:
    """Names whose place in a mask (n,) is set."""
    return tuple(name for name, flag in zip(names, which, strict=True) if flag)
