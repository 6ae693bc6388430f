"""The velocity that the logged commands should cause: each axis by itself, from rest.

Good enough to tell axes, clocks and files by correlation; no replay (no Coriolis, no gaps).
"""

from typing import NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core.run import Commands, latest
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import Vehicle
from rovsim.dynamics.vehicle.hydrodynamics import matrix
from rovsim.measurement.rough_motion import STEP
from rovsim.measurement.signals.clock import time_step
from rovsim.simulation.drive import Drive

BEFORE, AFTER = 1.0, 3.0  # s around the commands


def wrench(vehicle: Vehicle, commands: Commands) -> Array:
    """Static body wrench (m, 6) of each logged line: N, N m, FRD."""
    model = nominal(vehicle)
    return Drive.by(model, model.thrust_path.at(commands, 0.0, 1.0), 1.0).wrench


def can_push_sideways(vehicle: Vehicle) -> bool:
    """Whether its thrusters push it sideways; else it slips and turns as its own speed makes it."""
    return bool(np.abs(nominal(vehicle).body.B[AXES.index("sway")]).max(initial=0.0) > 0.0)


def velocity(vehicle: Vehicle, commands: Commands, time: Array) -> Array:
    """Body velocity (n, 6) at the even times (n,) s, commands held between their lines."""
    tau = held(commands.time, wrench(vehicle, commands), time)
    return respond(vehicle, tau, time_step(time))


def cause(
    vehicle: Vehicle, commands: Commands, begin: float, longest: float
) -> tuple[Array, Array]:
    """Times (n,) s and body velocities (n, 6) that commands cause, and a little around them.

    From `begin` s on, and of that at most the first `longest` s.
    """
    end = min(float(commands.time[-1]), begin + longest)
    time = np.arange(begin - BEFORE, end + AFTER, STEP)
    return time, velocity(vehicle, commands, time)


def respond(vehicle: Vehicle, tau: Array, step: float) -> Array:
    """Body velocity (n, 6) under a wrench (n, 6) at even times, `step` s apart, from rest."""
    inertia, linear, quadratic, stiffness = _diagonals(vehicle)
    nu, angle = np.zeros(6), np.zeros(6)
    found = np.empty((len(tau), 6))
    for k, push in enumerate(tau):
        found[k] = nu
        # implicit in the drag: stable at any step
        resisted = inertia / step + linear + quadratic * np.abs(nu)
        nu = (inertia / step * nu + push - stiffness * angle) / resisted
        angle = angle + step * nu
    return np.where(vehicle.free, found, 0.0)


def held(time: Array, value: Array, at: Array) -> Array:
    """Values (n, c) of the last line at each instant (n,); zero before the first."""
    return np.where((at >= time[0])[:, None], value[latest(time, at)], 0.0)


def righting(vehicle: Vehicle) -> Array:
    """Restoring stiffness (6,) of a vehicle at rest: N/m, N m/rad."""
    dry = vehicle.rigid_body
    center = dry.center_of_buoyancy or dry.center_of_gravity
    arm = dry.center_of_gravity[2] - center[2]
    weight = dry.mass * vehicle.fluid.gravity
    stiffness = weight * arm * np.array([0.0, 0.0, 0.0, 1.0, 1.0, 0.0])
    if vehicle.waterplane is not None:
        plane = vehicle.waterplane
        stiffness += [0.0, 0.0, plane.heave, plane.roll, plane.pitch, 0.0]
    return np.asarray(stiffness)


class _Diagonals(NamedTuple):
    """Constants (6,) of the six axes, without what couples them: SI units.

    `linear` and `quadratic` are drag coefficients; `stiffness` rights the vehicle at rest.
    """

    inertia: Array
    linear: Array
    quadratic: Array
    stiffness: Array


def _diagonals(vehicle: Vehicle) -> _Diagonals:
    """The constants of each axis by itself, of a vehicle at rest; its stiffness at least 0."""
    dry, water = vehicle.rigid_body, vehicle.hydrodynamics
    moments = [getattr(dry.inertia, name) or 1.0 for name in ("Ixx", "Iyy", "Izz")]
    inertia = np.array([dry.mass] * 3 + moments) + np.diag(matrix(water.added_mass))
    linear, quadratic = (
        np.diag(matrix(water.linear_damping)),
        np.diag(matrix(water.quadratic_damping)),
    )
    return _Diagonals(inertia, linear, quadratic, np.maximum(righting(vehicle), 0.0))
