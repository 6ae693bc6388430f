"""Fossen's equation of motion and its integration, compiled by Numba. This file is a template.

`rovsim.engine.compiled` writes a copy of it in which `extra` calls the wrench kernels of one model,
so that LLVM inlines them and Numba caches the result on disk.

    M_RB nu_dot + C_RB(nu) nu + M_A nu_r_dot + C_A(nu_r) nu_r + D(nu_r) nu_r + g(eta)
        = tau_thrust + tau_extra                                      (Fossen 2021, eq. 6.1, 10.135)

State: position NED, quaternion body to world, body velocity. SI, float64, FRD at CO.
"""

from math import sqrt

import numpy as np
from numba import njit, prange

from rovsim.engine.at import At, Constants, State
from rovsim.engine.vectors import (
    add3,
    add4,
    add6,
    compiled,
    cross,
    dot3,
    inlined,
    into_body,
    into_world,
    matrix6,
    times6,
    vector3,
    vector6,
)  # fmt: skip
from rovsim.residual.features import assemble_one
from rovsim.residual.predictor import FEATURES, evaluate

# <extra>


@inlined
def extra(at, p):
    """Wrench of the model's further effects, parameters p (k,)."""
    return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0


# </extra>


@inlined
def rotation(q):
    """Rotation matrix body to world, by rows (Fossen 2021, eq. 2.73).

    Homogeneous in q: where a Runge-Kutta stage has stretched it, all of R is stretched alike, and
    no direction of the world is preferred.
    """
    w, i, j, k = q
    return (
        (w * w + i * i - j * j - k * k, 2 * (i * j - w * k), 2 * (i * k + w * j)),
        (2 * (i * j + w * k), w * w - i * i + j * j - k * k, 2 * (j * k - w * i)),
        (2 * (i * k - w * j), 2 * (j * k + w * i), w * w - i * i - j * j + k * k),
    )


@inlined
def quaternion_rate(q, nu):
    """Rate of the quaternion under body rates (Fossen 2021, eq. 2.78)."""
    a, b, c = 0.5 * nu[3], 0.5 * nu[4], 0.5 * nu[5]
    return (
        -q[1] * a - q[2] * b - q[3] * c,
        q[0] * a + q[2] * c - q[3] * b,
        q[0] * b + q[3] * a - q[1] * c,
        q[0] * c + q[1] * b - q[2] * a,
    )


@inlined
def coriolis(M, v):
    """C(v) v of a body with inertia M (6, 6), from its momentum (Fossen 2021, eq. 6.43).

    Written as cross products it can do no work: v' C(v) v = 0 whatever M is.
    """
    h = times6(M, v)
    force = cross(v[3:], h[:3])
    moment = add3(cross(v[:3], h[:3]), 1.0, cross(v[3:], h[3:]))
    return force[0], force[1], force[2], moment[0], moment[1], moment[2]


@inlined
def flow(current, R, nu):
    """Velocity through the water, and the rate of change of the current seen in body axes."""
    c = into_body(R, current)
    rate = cross(c, nu[3:])  # d/dt (R' v_c) = -omega x (R' v_c)
    nu_r = (nu[0] - c[0], nu[1] - c[1], nu[2] - c[2], nu[3], nu[4], nu[5])
    return nu_r, (rate[0], rate[1], rate[2], 0.0, 0.0, 0.0)


@inlined
def damping_term(linear, quadratic, v):
    """Damping force of one axis."""
    return -(linear + quadratic * abs(v)) * v


@inlined
def damping(a, b, v):
    """Linear (a) and quadratic (b) diagonal damping (Fossen 2021, eq. 6.75)."""
    return (
        damping_term(a[0], b[0], v[0]), damping_term(a[1], b[1], v[1]),
        damping_term(a[2], b[2], v[2]), damping_term(a[3], b[3], v[3]),
        damping_term(a[4], b[4], v[4]), damping_term(a[5], b[5], v[5]),
    )  # fmt: skip


@inlined
def restoring(heaviness, righting, R):
    """Weight and buoyancy; the world's down in body axes is the last row of R."""
    d, m = R[2], cross(righting, R[2])
    return heaviness * d[0], heaviness * d[1], heaviness * d[2], m[0], m[1], m[2]


@compiled
def thrust_loss(force, advance, B, directions, nu_r):
    """Change of the thruster wrench with inflow: F -> F (1 - c sign(F) d.v_r)."""
    tau = np.zeros(6)
    for n in range(force.size):
        inflow = dot3(vector3(directions[n]), nu_r)
        for i in range(6):
            tau[i] -= advance * abs(force[n]) * inflow * B[i, n]
    return vector6(tau)


@inlined
def accelerate(at, body, p, thrust, force):
    """Body acceleration under a thruster wrench (6,) made of thruster forces (n,)."""
    tau = add6(thrust, -1.0, coriolis(body.M_RB, at.nu))
    tau = add6(tau, -1.0, coriolis(body.M_A, at.nu_r))
    tau = add6(tau, 1.0, damping(body.linear, body.quadratic, at.nu_r))
    tau = add6(tau, 1.0, restoring(body.heaviness, body.righting, at.R))
    tau = add6(tau, 1.0, times6(body.M_A, at.nu_c_dot))
    tau = add6(tau, 1.0, extra(at, p))
    if body.advance != 0.0:
        loss = thrust_loss(force, body.advance, body.B, body.directions, at.nu_r)
        tau = add6(tau, 1.0, loss)
    return times6(body.M_inv, tau)


@inlined
def slope(t, x, body, p, step, correction, site):
    """Rate of change of the state at time t; `correction` (6,) adds to the acceleration."""
    thrust, force, demand, duration = step
    R = rotation(x.attitude)
    nu_r, nu_c_dot = flow(body.current, R, x.nu)
    at = At(t, duration, x.position, R, x.nu, nu_r, nu_c_dot, demand, site[0], site[1])
    nu_dot = add6(accelerate(at, body, p, thrust, force), 1.0, correction)
    return State(into_world(R, x.nu), quaternion_rate(x.attitude, x.nu), nu_dot)


@inlined
def moved(x, h, dx):
    """x + h dx."""
    return State(
        add3(x.position, h, dx.position),
        add4(x.attitude, h, dx.attitude),
        add6(x.nu, h, dx.nu),
    )


@inlined
def renormalised(x):
    """The state with its quaternion scaled to unit length."""
    w, i, j, k = x.attitude
    length = sqrt(w * w + i * i + j * j + k * k)
    return State(x.position, (w / length, i / length, j / length, k / length), x.nu)


@inlined
def runge_kutta(t, x, h, body, p, step, correction, site):
    """One classical Runge-Kutta 4 step."""
    k1 = slope(t, x, body, p, step, correction, site)
    k2 = slope(t + 0.5 * h, moved(x, 0.5 * h, k1), body, p, step, correction, site)
    k3 = slope(t + 0.5 * h, moved(x, 0.5 * h, k2), body, p, step, correction, site)
    k4 = slope(t + h, moved(x, h, k3), body, p, step, correction, site)
    x = moved(moved(x, h / 6.0, k1), h / 3.0, k2)
    return renormalised(moved(moved(x, h / 3.0, k3), h / 6.0, k4))


@compiled
def learned(t, x, body, p, step, data, site, features, a_res):
    """Learned acceleration error at x. tau_res = M a_res, so it simply adds to nu_dot."""
    base = slope(t, x, body, p, step, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), site)
    assemble_one(data, x.nu, base.nu, step[0], rotation(x.attitude), features)
    evaluate(data, features, a_res)
    return vector6(a_res)


@inlined
def constants_of(bodies, m):
    """Constants of parameter set m alone, as tuples."""
    return Constants(
        matrix6(bodies.M_RB[m]), matrix6(bodies.M_A[m]), matrix6(bodies.M_inv[m]),
        vector6(bodies.linear[m]), vector6(bodies.quadratic[m]), bodies.heaviness[m],
        vector3(bodies.righting[m]), vector3(bodies.current[m]), bodies.advance[m],
        bodies.B[m], bodies.directions,
    )  # fmt: skip


@inlined
def step_of(inputs, row, k):
    """Commands of step k: thruster wrench, thruster forces, demand, duration of the recording."""
    return (
        vector6(inputs.wrench[row, k]), inputs.force[row, k], vector6(inputs.demand[k]),
        inputs.duration[k],
    )  # fmt: skip


@inlined
def state_of(a):
    """State of an array (13,)."""
    return State((a[0], a[1], a[2]), (a[3], a[4], a[5], a[6]), vector6(a[7:]))


@inlined
def store(x, out):
    """Write a state into an array (13,)."""
    for i in range(3):
        out[i] = x.position[i]
    for i in range(4):
        out[3 + i] = x.attitude[i]
    for i in range(6):
        out[7 + i] = x.nu[i]


@inlined
def site_of(site):
    """Walls (low, high per world axis) and MoCap axes as tuples."""
    tank = site.tank
    walls = ((tank[0, 0], tank[0, 1]), (tank[1, 0], tank[1, 1]), (tank[2, 0], tank[2, 1]))
    return walls, vector3(site.axes)


@compiled
def run_job(job, jobs, h, stride, bodies, inputs, p, data, site, out):
    """Integrate one job; after every `stride` steps its state goes into the next row of out.

    A learned residual is evaluated at the start of each step and held over it.
    """
    m, first, row, start = jobs.member[job], jobs.first[job], jobs.out[job], jobs.time[job]
    x, body, own, place = state_of(jobs.state[job]), constants_of(bodies, m), p[m], site_of(site)
    features, a_res, correction = np.empty(FEATURES), np.empty(6), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for n in range(jobs.steps[job]):
        step, t = step_of(inputs, inputs.row[m], first + n), start + n * h
        if data.size:
            correction = learned(t, x, body, own, step, data, place, features, a_res)
        x = runge_kutta(t, x, h, body, own, step, correction, place)
        if (n + 1) % stride == 0:
            store(x, out[row + n // stride])


@compiled
def integrate(jobs, h, stride, bodies, inputs, p, data, site, out):
    """Run the jobs one after the other on this core."""
    for job in range(jobs.first.size):
        run_job(job, jobs, h, stride, bodies, inputs, p, data, site, out)


@njit(cache=True, parallel=True)
def integrate_parallel(jobs, h, stride, bodies, inputs, p, data, site, out):
    """Run the jobs on all cores; each is independent, so the numbers do not depend on how many."""
    for job in prange(jobs.first.size):
        run_job(job, jobs, h, stride, bodies, inputs, p, data, site, out)


@compiled
def heun(state, t, h, pushes, bodies, inputs, p, data, site, out):
    """Heun's method over the steps of the inputs, each with an extra acceleration pushes (k, 6).

    For the synthetic tank, whose truth must not share the replay's integrator.
    """
    x, body, place = state_of(state), constants_of(bodies, 0), site_of(site)
    features, a_res, none = np.empty(FEATURES), np.empty(6), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for n in range(pushes.shape[0]):
        step, now, push = step_of(inputs, 0, n), t + n * h, vector6(pushes[n])
        if data.size:
            a_learned = learned(now, x, body, p, step, data, place, features, a_res)
            push = add6(push, 1.0, a_learned)
        else:
            push = add6(push, 1.0, none)
        k1 = slope(now, x, body, p, step, push, place)
        k2 = slope(now + h, moved(x, h, k1), body, p, step, push, place)
        x = renormalised(moved(moved(x, 0.5 * h, k1), 0.5 * h, k2))
        store(x, out[n])


@compiled
def accelerations(times, states, bodies, inputs, p, data, site, out):
    """nu_dot (n, 6) of parameter set 0 at each state (n, 13) under the commands of step n."""
    body, own, place = constants_of(bodies, 0), p[0], site_of(site)
    features, a_res, correction = np.empty(FEATURES), np.empty(6), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for n in range(times.size):
        x, step = state_of(states[n]), step_of(inputs, inputs.row[0], n)
        if data.size:
            correction = learned(times[n], x, body, own, step, data, place, features, a_res)
        nu_dot = slope(times[n], x, body, own, step, correction, place).nu
        for i in range(6):
            out[n, i] = nu_dot[i]
