"""Forces that few vehicles have: of a waterplane, of products of velocities, of control surfaces.

The equation of motion evaluates them only for vehicles that have at least one. The columns of a
control surface stand in `types`.
"""

from math import atan2, pi, sin, sqrt

import numpy as np

from rovsim.dynamics.compilation.compiled import inline_internal, internal
from rovsim.dynamics.engine.types import (
    CHORD,
    HALF,
    JET,
    NORMAL,
    PLACE,
    PROFILE,
    SLOPE,
    STALL,
    WAKE,
)
from rovsim.dynamics.engine.vectors import add3, cross, dot3, vector3, vector6


@inline_internal
def float_up(waterplane, depth, down):
    """Hydrostatic restoring of a surface vehicle in heave, roll, pitch (Fossen 2021, 4.2).

    Args:
        waterplane: stiffness in heave N/m, roll and pitch N m/rad.
        depth: of CO below its position at rest, m.
        down: (3) the NED z axis in body axes. The Euler angles roll and pitch are taken as small.
    """
    x, y, z = down
    roll, pitch = atan2(y, z), atan2(-x, sqrt(y * y + z * z))
    return -waterplane[0] * depth, -waterplane[1] * roll, -waterplane[2] * pitch


@inline_internal
def product(factors, v):
    """Product of up to three velocities v (6).

    factors (4): element 0 is the axis of the force, the others are i for v_i, 6 + i for |v_i|, and
    -1 for none.
    """
    value = 1.0
    for k in range(1, 4):
        if factors[k] >= 6:
            value *= abs(v[factors[k] - 6])
        elif factors[k] >= 0:
            value *= v[factors[k]]
    return value


@inline_internal
def coefficients(alpha, slope, stall):
    """Lift and drag coefficients at an angle of attack alpha, rad, without the profile's drag.

    The lift is linear (`slope` per rad) up to the angle `stall`, rad. Beyond, it is that of a flat
    plate (Viterna & Janetzke 1982), scaled so that both agree at the stall. The force is normal to
    the plate: there is no suction at the leading edge.
    """
    plate = slope * stall / sin(2.0 * stall)
    turned = alpha - 2.0 * pi * round(alpha / (2.0 * pi))
    lift = slope * turned if abs(turned) <= stall else plate * sin(2.0 * turned)
    return lift, 2.0 * plate * sin(turned) ** 2


@inline_internal
def surface_force(s, lifting, v, angle, thrust):
    """Force (3) of one control surface, body axes, N.

    Args:
        s: (15,) its row of `Body.surfaces`.
        lifting: factor on its lift.
        v: (3) its velocity relative to the water, body axes, m/s.
        angle: of its deflection, rad.
        thrust: of the thruster whose jet it stands in, N; 0 if there is none.
    """
    normal, chord = vector3(s[NORMAL:]), vector3(s[CHORD:])
    ahead, across = dot3(chord, v), dot3(normal, v)
    jet = s[JET] * thrust
    if jet > 0.0:
        square = ahead * abs(ahead) + jet
        ahead = sqrt(square) if square > 0.0 else -sqrt(-square)
    speed = sqrt(ahead * ahead + across * across)
    if speed == 0.0:
        return 0.0, 0.0, 0.0
    lift, drag = coefficients(angle - atan2(across, ahead), s[SLOPE], s[STALL])
    lift, drag = lifting * lift, drag + s[PROFILE]
    along = -s[HALF] * speed * (lift * across + drag * ahead)
    outward = s[HALF] * speed * (lift * ahead - drag * across)
    return add3((along * chord[0], along * chord[1], along * chord[2]), outward, normal)


@internal
def further_forces(body, depth, down, v, acting, count):
    """Wrench (6) of waterplane, products of velocities and surfaces, body axes, N and N m.

    Args:
        body: the fields of `Constants` from `waterplane` to `lifting`.
        depth: of CO below its position at rest, m.
        down: (3) the NED z axis in body axes.
        v: (6) velocity relative to the water.
        acting: forces of the `count` thruster components, N, then angles of the surfaces, rad.
        count: number of thruster components.
    """
    waterplane, products, factors, surfaces, lifting = body
    tau = np.zeros(6)
    tau[2], tau[3], tau[4] = float_up(waterplane, depth, down)
    for k in range(products.size):
        tau[factors[k, 0]] += products[k] * product(factors[k], v)
    for k in range(lifting.size):
        s = surfaces[k]
        place, thrust = vector3(s[PLACE:]), 0.0
        if s[WAKE] >= 0.0:
            thrust = acting[int(s[WAKE])]
        local = add3(v[:3], 1.0, cross(v[3:], place))
        force = surface_force(s, lifting[k], local, acting[count + k], thrust)
        moment = cross(place, force)
        for i in range(3):
            tau[i] += force[i]
            tau[3 + i] += moment[i]
    return vector6(tau)
