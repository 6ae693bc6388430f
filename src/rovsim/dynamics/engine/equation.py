"""Fossen's equation of motion, compiled by Numba.

`extra(at, parameters, body, acting)` returns the wrench (6) of all wrench effects of a model. This
compiled function is passed down the calls, so that LLVM inlines the kernels of the effects.

    M_RB nu_dot + C_RB(nu) nu + M_A nu_r_dot + C_A(nu_r) nu_r + D(nu_r) nu_r + g(eta)
        = tau_thrust + tau_extra                                      (Fossen 2021, eq. 6.1, 10.135)

State: position in NED, quaternion (w, x, y, z) body to world, nu in body axes. SI, float64, FRD at
CO. Vectors are tuples (`vectors`). Arguments in common: `body`, the `Constants` of one parameter
set; `parameters`, its `WrenchParameters`; `step`, the present one; `acting`, see `types.Inputs`.
They stay apart: taking one that holds arrays out of a further tuple costs half as much as a step
(measured).
"""

import numpy as np

from rovsim.dynamics.compilation.compiled import inline_anew, inline_internal, internal
from rovsim.dynamics.engine.types import At, State
from rovsim.dynamics.engine.uncommon_forces import further_forces
from rovsim.dynamics.engine.vectors import (
    add3,
    add6,
    cross,
    dot3,
    into_body,
    into_world,
    times6,
    vector3,
    vector6,
)


@inline_internal
def rotation(q):
    """Rotation matrix body to world, by rows (Fossen 2021, eq. 2.73).

    Homogeneous in q: if a Runge-Kutta stage has changed the length of q, all elements of R are
    scaled by the same factor, and no direction of the world is preferred.
    """
    w, i, j, k = q
    return (
        (w * w + i * i - j * j - k * k, 2 * (i * j - w * k), 2 * (i * k + w * j)),
        (2 * (i * j + w * k), w * w - i * i + j * j - k * k, 2 * (j * k - w * i)),
        (2 * (i * k - w * j), 2 * (j * k + w * i), w * w - i * i - j * j + k * k),
    )


@inline_internal
def quaternion_rate(q, nu):
    """Time derivative of the quaternion q at velocity nu (6) (Fossen 2021, eq. 2.78)."""
    a, b, c = 0.5 * nu[3], 0.5 * nu[4], 0.5 * nu[5]
    return (
        -q[1] * a - q[2] * b - q[3] * c,
        q[0] * a + q[2] * c - q[3] * b,
        q[0] * b + q[3] * a - q[1] * c,
        q[0] * c + q[1] * b - q[2] * a,
    )


@inline_internal
def coriolis(M, v):
    """C(v) v of a body with inertia M (6, 6), from its momentum (Fossen 2021, eq. 6.43).

    Written with cross products, it does no work: v' C(v) v = 0 for any M.
    """
    h = times6(M, v)
    force = cross(v[3:], h[:3])
    moment = add3(cross(v[:3], h[:3]), 1.0, cross(v[3:], h[3:]))
    return force[0], force[1], force[2], moment[0], moment[1], moment[2]


@inline_internal
def flow(current, R, nu):
    """nu_r (6), and the rate (6) of a constant NED current (3,) as seen in turning body axes."""
    c = into_body(R, current)
    rate = cross(c, nu[3:])  # d/dt (R' v_c) = -omega x (R' v_c)
    nu_r = (nu[0] - c[0], nu[1] - c[1], nu[2] - c[2], nu[3], nu[4], nu[5])
    return nu_r, (rate[0], rate[1], rate[2], 0.0, 0.0, 0.0)


@inline_internal
def damping_term(linear, quadratic, v):
    """Linear and quadratic damping force of one axis at velocity v: positive = drag."""
    return -(linear + quadratic * abs(v)) * v


@inline_internal
def damping(a, b, v):
    """Wrench (6) of diagonal damping, linear a and quadratic b (Fossen 2021, eq. 6.75)."""
    return (
        damping_term(a[0], b[0], v[0]),
        damping_term(a[1], b[1], v[1]),
        damping_term(a[2], b[2], v[2]),
        damping_term(a[3], b[3], v[3]),
        damping_term(a[4], b[4], v[4]),
        damping_term(a[5], b[5], v[5]),
    )


@inline_internal
def restoring(net_weight, restoring_lever, R):
    """Wrench (6) of weight and buoyancy; the last row of R is the NED z axis in body axes."""
    d, m = R[2], cross(restoring_lever, R[2])
    return net_weight * d[0], net_weight * d[1], net_weight * d[2], m[0], m[1], m[2]


@internal
def coupled_damping(coupling, v):
    """Wrench (6) of damping between axes; coupling (2, 6, 6): linear, then quadratic matrix."""
    tau = np.zeros(6)
    for i in range(6):
        for j in range(6):
            tau[i] -= (coupling[0, i, j] + coupling[1, i, j] * abs(v[j])) * v[j]
    return vector6(tau)


@internal
def thrust_loss(acting, advance, B, directions, nu_r):
    """Change (6) of the thruster wrench with inflow: F -> F (1 - c sign(F) d.v_r), c = advance."""
    tau = np.zeros(6)
    for n in range(B.shape[1]):
        inflow = dot3(vector3(directions[n]), nu_r)
        for i in range(6):
            tau[i] -= advance * abs(acting[n]) * inflow * B[i, n]
    return vector6(tau)


@inline_anew
def accelerate(extra, at, body, parameters, thrust, acting, level):
    """nu_dot (6) under a thruster wrench (6); level: z in NED where a floating vehicle rests."""
    tau = add6(thrust, -1.0, coriolis(body.M_RB, at.nu))
    tau = add6(tau, -1.0, coriolis(body.M_A, at.nu_r))
    tau = add6(tau, 1.0, at.drag)
    tau = add6(tau, 1.0, restoring(body.net_weight, body.restoring_lever, at.R))
    tau = add6(tau, 1.0, times6(body.M_A, at.nu_c_dot))
    tau = add6(tau, 1.0, extra(at, parameters, body, acting))
    if body.coupled != 0.0:
        tau = add6(tau, 1.0, coupled_damping(body.coupling, at.nu_r))
    if body.advance != 0.0:
        loss = thrust_loss(acting, body.advance, body.B, body.directions, at.nu_r)
        tau = add6(tau, 1.0, loss)
    if body.uncommon != 0.0:
        uncommon = (body.waterplane, body.products, body.factors, body.surfaces, body.lifting)
        depth, count = at.position[2] - level, body.B.shape[1]
        tau = add6(tau, 1.0, further_forces(uncommon, depth, at.R[2], at.nu_r, acting, count))
    return times6(body.M_inv, tau)


@inline_internal
def diagonal(a, b):
    """Diagonal of the sum of two matrices."""
    return (
        a[0][0] + b[0][0],
        a[1][1] + b[1][1],
        a[2][2] + b[2][2],
        a[3][3] + b[3][3],
        a[4][4] + b[4][4],
        a[5][5] + b[5][5],
    )


@inline_anew
def slope(extra, t, x, body, parameters, step, correction, surroundings):
    """Time derivative of the state x at time t.

    Args:
        extra: wrench of the model's effects, see the module.
        t: s since the start of the recording.
        x: the state.
        body: constants of the equation.
        parameters: of the wrench effects.
        step: the present step.
        correction: (6) additional acceleration, m/s2 and rad/s2. It must be zero along axes that
            are held, as `M_inv` is, so that they stay at rest.
        surroundings: walls, axes, level.
    """
    thrust, acting, level = step.thrust, step.acting, surroundings.level
    R = rotation(x.attitude)
    nu_r, nu_c_dot = flow(body.current, R, x.nu)
    drag, inertia = damping(body.linear, body.quadratic, nu_r), diagonal(body.M_RB, body.M_A)
    at = At(
        t,
        step.duration,
        x.position,
        R,
        x.nu,
        nu_r,
        nu_c_dot,
        drag,
        inertia,
        step.demand,
        surroundings.tank,
        surroundings.axes,
    )
    nu_dot = add6(accelerate(extra, at, body, parameters, thrust, acting, level), 1.0, correction)
    return State(into_world(R, x.nu), quaternion_rate(x.attitude, x.nu), nu_dot)
