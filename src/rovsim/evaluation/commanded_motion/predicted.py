"""Predict roughly which velocity logged commands should cause: each axis by itself, from rest.

This is good enough to tell axes, clocks and files by correlation. It is no replay: Coriolis forces
and gaps of the recording are ignored.
"""

from typing import NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.run import Commands, latest
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import Vehicle
from rovsim.dynamics.vehicle.hydrodynamics import matrix
from rovsim.measurement.rough_motion import MIN_STEP_S
from rovsim.measurement.signals.clock import time_step
from rovsim.simulation.drive import Drive

# s that are predicted before the first and after the last command
PREDICTED_BEFORE_S, PREDICTED_AFTER_S = 1.0, 3.0


def predict_wrench(vehicle: Vehicle, commands: Commands) -> Array:
    """Static wrench (m, 6) of the thrusters at each of m logged commands, N and N m, FRD."""
    model = nominal(vehicle)
    return Drive.by(model, model.thrust_path.at(commands, 0.0, 1.0), 1.0).wrench


def can_push_sideways(vehicle: Vehicle) -> bool:
    """Whether the thrusters can push the vehicle sideways.

    If not, it sways and turns because of its own forward speed.
    """
    return bool(np.abs(nominal(vehicle).body.B[AXES.index("sway")]).max(initial=0.0) > 0.0)


def predict_velocity(vehicle: Vehicle, commands: Commands, time: Array) -> Array:
    """Body velocity (n, 6) that commands cause, m/s and rad/s, FRD.

    Args:
        vehicle: the vehicle.
        commands: logged commands; each holds until the next one.
        time: evenly spaced times (n,), s.
    """
    tau = held(commands.time, predict_wrench(vehicle, commands), time)
    return respond(vehicle, tau, time_step(time))


def cause(
    vehicle: Vehicle, commands: Commands, begin: float, longest: float
) -> tuple[Array, Array]:
    """Predict the body velocity that commands cause, from shortly before to shortly after them.

    Args:
        vehicle: the vehicle.
        commands: logged commands.
        begin: commands before this time are not considered, s.
        longest: how much of the commands is considered at most, s.

    Returns:
        Times (n,) in s, and velocities (n, 6) in m/s and rad/s, FRD.
    """
    end = min(float(commands.time[-1]), begin + longest)
    time = np.arange(begin - PREDICTED_BEFORE_S, end + PREDICTED_AFTER_S, MIN_STEP_S)
    return time, predict_velocity(vehicle, commands, time)


def respond(vehicle: Vehicle, tau: Array, step: float) -> Array:
    """Integrate the body velocity (n, 6) from rest under a wrench, each axis by itself.

    Args:
        vehicle: the vehicle.
        tau: wrench (n, 6) at evenly spaced times, N and N m, FRD.
        step: between these times, s.
    """
    inertia, linear, quadratic, stiffness = _diagonals(vehicle)
    nu, angle = np.zeros(6), np.zeros(6)
    path = np.empty((len(tau), 6))
    for k, push in enumerate(tau):
        path[k] = nu
        # drag is integrated implicitly, which is stable for any step
        denominator = inertia / step + linear + quadratic * np.abs(nu)
        nu = (inertia / step * nu + push - stiffness * angle) / denominator
        angle = angle + step * nu
    return np.where(vehicle.free, path, 0.0)


def held(time: Array, value: Array, at: Array) -> Array:
    """Values (n, c) of the latest line of a log at each time; zero before the first line.

    Args:
        time: of the lines (m,), s.
        value: of the lines (m, c).
        at: the times (n,), s.
    """
    return np.where((at >= time[0])[:, None], value[latest(time, at)], 0.0)


def righting(vehicle: Vehicle) -> Array:
    """Restoring stiffness (6,) of each axis of a vehicle at rest, N/m and N m/rad."""
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
    """Constants (6,) of the six axes, without any coupling.

    Attributes:
        inertia: with added mass, kg and kg m2.
        linear: drag coefficients, N s/m and N m s/rad.
        quadratic: drag coefficients, N s2/m2 and N m s2/rad2.
        stiffness: that restores the vehicle at rest, N/m and N m/rad.
    """

    inertia: Array
    linear: Array
    quadratic: Array
    stiffness: Array


def _diagonals(vehicle: Vehicle) -> _Diagonals:
    """Constants of each axis of a vehicle; a negative stiffness is replaced by zero."""
    dry, water = vehicle.rigid_body, vehicle.hydrodynamics
    moments = [getattr(dry.inertia, name) or 1.0 for name in ("Ixx", "Iyy", "Izz")]
    inertia = np.array([dry.mass] * 3 + moments) + np.diag(matrix(water.added_mass))
    linear, quadratic = (
        np.diag(matrix(water.linear_damping)),
        np.diag(matrix(water.quadratic_damping)),
    )
    return _Diagonals(inertia, linear, quadratic, np.maximum(righting(vehicle), 0.0))
