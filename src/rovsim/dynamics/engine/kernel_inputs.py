"""What kernels of effects may read beside `At`: actuators, and channels logged with the commands.

Only a kernel whose code contains `at.actuators` or `at.channels` gets them; others are not slowed.

Columns of `acting` where an engine has such a kernel: forces of the thruster components (k), N;
angles of the surfaces (s), rad; forces of the thrusters (n), N; logged commands (k + s); then the
channels of each such effect, in the order of the effects.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import typeof, types
from numpy import ndarray as Array

from rovsim.dynamics.compilation.compiled import inline_anew, inline_internal
from rovsim.dynamics.engine.types import EXAMPLE, Vector3, Vector6
from rovsim.dynamics.engine.vectors import add3, cross, vector3


class Actuators(NamedTuple):
    """Forces, commands and inflow of the actuators, in the order of the vehicle file.

    Attributes:
        force: (n,) of the n thrusters, N.
        command: (c,) as logged and mixed, in the order of `Vehicle.command_columns`: in [-1, 1];
            angles in rad.
        inflow: (n + s, 3) velocity relative to the water at thrusters, then control surfaces, body
            axes, m/s, without the velocity that propellers induce.
    """

    force: Array
    command: Array
    inflow: Array


class ReadingAt(NamedTuple):
    """`At` with the same attributes, the actuators, and the channels of an effect by name."""

    t: float
    duration: float
    position: Vector3
    R: tuple[Vector3, Vector3, Vector3]
    nu: Vector6
    nu_r: Vector6
    nu_c_dot: Vector6
    drag: Vector6
    inertia: Vector6
    demand: Vector6
    tank: tuple[tuple[float, float], tuple[float, float], tuple[float, float]]
    axes: Vector3
    actuators: Actuators
    channels: Any


def example_reading(channels: Any) -> ReadingAt:
    """An arbitrary instant of a vehicle with eight thrusters: to compile and try kernels on."""
    actuators = Actuators(np.zeros(8), np.zeros(8), np.zeros((8, 3)))
    return ReadingAt(*EXAMPLE, actuators, channels)


class Layout(NamedTuple):
    """Numbers of thruster components and surfaces, and all `places`: they order `acting`."""

    components: int
    surfaces: int
    places: Array


@inline_internal
def layout_of(body):
    """The layout of `acting` for a vehicle with these constants."""
    return Layout(body.B.shape[1], body.lifting.size, body.places)


@inline_internal
def first_channel(layout):
    """Index of the column of `acting` where the channels begin."""
    components, surfaces, places = layout
    return 2 * (components + surfaces) + places.shape[0] - surfaces


@inline_internal
def actuators_at(at, layout, acting):
    """All actuators at one instant, from the columns of `acting` and the motion."""
    columns, count = layout.components + layout.surfaces, layout.places.shape[0]
    first = columns + count - layout.surfaces
    inflow = np.empty((count, 3))
    for i in range(count):
        local = add3(at.nu_r[:3], 1.0, cross(at.nu_r[3:], vector3(layout.places[i])))
        for j in range(3):
            inflow[i, j] = local[j]
    return Actuators(acting[columns:first], acting[first : first + columns], inflow)


@inline_anew
def reading_at(at, actuators, channels):
    """`at` together with the actuators and the channels that a kernel reads."""
    return ReadingAt(
        at.t,
        at.duration,
        at.position,
        at.R,
        at.nu,
        at.nu_r,
        at.nu_c_dot,
        at.drag,
        at.inertia,
        at.demand,
        at.tank,
        at.axes,
        actuators,
        channels,
    )


# Signature of attached effects, which are called by address: (at, p, layout, acting) -> wrench.
ATTACHED_SIGNATURE = types.UniTuple(types.float64, 6)(
    typeof(EXAMPLE), types.float64[::1], typeof(Layout(0, 0, np.zeros((0, 3)))), types.float64[::1]
)
