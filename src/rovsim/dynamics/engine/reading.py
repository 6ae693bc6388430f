"""What the kernels of effects may read beside `At`: actuators, and channels logged beside commands.

Only a kernel that says `at.actuators` or `at.channels` is handed it; others pay nothing for it.

Columns of `acting` where an engine has such a kernel: forces of the components of the thrusters
(k), angles of the surfaces (s), forces of the thrusters (n), logged commands (k + s), then the
channels of each such effect, one effect after the other.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import typeof, types
from numpy import ndarray as Array

from rovsim.dynamics.engine.compiled import inline_anew, inline_internal
from rovsim.dynamics.engine.types import EXAMPLE, Vector3, Vector6
from rovsim.dynamics.engine.vectors import add3, cross, vector3


class Actuators(NamedTuple):
    """Thrusters, in the vehicle file's order, then control surfaces.

    `force` (n,) N of the n thrusters; `command` (c,) as logged and mixed, in the order of
    `Vehicle.command_columns`: [-1, 1], angles in rad; `inflow` (n + s, 3) velocity through the
    water at each place, body axes, m/s, without what the propellers add.
    """

    force: Array
    command: Array
    inflow: Array


class ReadingAt(NamedTuple):
    """`At`, the actuators, and the channels that an effect declares, by name."""

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
    """Some instant: what such a kernel can be tried on, of a vehicle with eight actuators."""
    actuators = Actuators(np.zeros(8), np.zeros(8), np.zeros((8, 3)))
    return ReadingAt(*EXAMPLE, actuators, channels)


class Layout(NamedTuple):
    """Of `acting`: the number of thrusters' components and of surfaces, and all `places`."""

    components: int
    surfaces: int
    places: Array


@inline_internal
def layout_of(body):
    """Where in `acting` is what."""
    return Layout(body.B.shape[1], body.lifting.size, body.places)


@inline_internal
def first_channel(layout):
    """Column of `acting` where the channels begin."""
    components, surfaces, places = layout
    return 2 * (components + surfaces) + places.shape[0] - surfaces


@inline_internal
def actuators_at(at, layout, acting):
    """All actuators at one instant."""
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
    """An instant with what only some effects read."""
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


# How a chain of effects is called by its address: (at, p, layout, acting).
BY_ADDRESS = types.UniTuple(types.float64, 6)(
    typeof(EXAMPLE), types.float64[::1], typeof(Layout(0, 0, np.zeros((0, 3)))), types.float64[::1]
)
