"""Numerical integration of the equation of motion, compiled by Numba.

`extra` is the wrench of a model's effects, see `equation`. `data` is an exported learned residual,
or None: Numba then does not compile its evaluation, which takes longer than everything else. In
entries, `bodies` and `p` are of all parameter sets, and `site` is `SiteArrays`. In the functions
that they call, `body` and `p` are of one set, and `site` or `place` is from `site_of`.
"""

from math import exp, sqrt

import numpy as np

from rovsim.dynamics.engine.compiled import entry, inline_anew, inline_internal, internal
from rovsim.dynamics.engine.equation import flow, rotation, slope
from rovsim.dynamics.engine.types import Constants, State, WrenchParameters
from rovsim.dynamics.engine.vectors import (
    add3,
    add4,
    add6,
    each6,
    matrix6,
    times6,
    vector3,
    vector6,
)
from rovsim.dynamics.learned.features import assemble_one
from rovsim.dynamics.learned.predictor import evaluate
from rovsim.dynamics.learned.settings import FEATURES

ZERO6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inline_internal
def moved(x, h, dx):
    """The state x + h dx; its quaternion is not normalised."""
    return State(
        add3(x.position, h, dx.position),
        add4(x.attitude, h, dx.attitude),
        add6(x.nu, h, dx.nu),
    )


@inline_internal
def renormalised(x):
    """The state with its quaternion scaled to unit length."""
    w, i, j, k = x.attitude
    length = sqrt(w * w + i * i + j * j + k * k)
    return State(x.position, (w / length, i / length, j / length, k / length), x.nu)


@inline_anew
def runge_kutta(extra, t, x, h, body, p, step, correction, ramp, site):
    """One classical Runge-Kutta 4 step of h s; returns the state and the mean nu (Nystroem).

    `correction` (6) is an additional acceleration, the mean over the step, `ramp` (6) its change.
    """
    k1 = slope(extra, t, x, body, p, step, add6(correction, -0.5, ramp), site)
    k2 = slope(extra, t + 0.5 * h, moved(x, 0.5 * h, k1), body, p, step, correction, site)
    k3 = slope(extra, t + 0.5 * h, moved(x, 0.5 * h, k2), body, p, step, correction, site)
    k4 = slope(extra, t + h, moved(x, h, k3), body, p, step, add6(correction, 0.5, ramp), site)
    mean = add6(add6(add6(x.nu, h / 6.0, k1.nu), h / 6.0, k2.nu), h / 6.0, k3.nu)
    x = moved(moved(x, h / 6.0, k1), h / 3.0, k2)
    return renormalised(moved(moved(x, h / 3.0, k3), h / 6.0, k4)), mean


@inline_internal
def through_water(x, body):
    """Velocity nu_r (6) relative to the water at a state."""
    return flow(body.current, rotation(x.attitude), x.nu)[0]


@inline_internal
def lagged(memory, nu_r, time):
    """Fluid memory (6) after moving at a constant nu_r for `time`, in time constants."""
    kept = exp(-time)
    return add6(add6(ZERO6, kept, memory), 1.0 - kept, nu_r)


@inline_internal
def memory_push(body, memory):
    """Acceleration (6) by the fluid memory: by water that still moves as the vehicle did."""
    return times6(body.M_inv, each6(body.memory, memory))


@internal
def push_over_step(x, memory, h, body):
    """The same at the middle of a step from x: held over the step, it is of second order."""
    ahead = lagged(memory, through_water(x, body), 0.5 * h * body.memory_decay)
    return memory_push(body, ahead)


@internal
def memory_after(memory, x, after, h, body):
    """Fluid memory after a step from state x to state `after`, at their mean nu_r."""
    mean = add6(through_water(x, body), 1.0, through_water(after, body))
    return lagged(memory, add6(ZERO6, 0.5, mean), h * body.memory_decay)


@inline_anew
def learned(extra, t, x, body, p, step, push, data, site, features, a_res):
    """Learned acceleration residual (6) at x: tau_res = M a_res, so it adds to nu_dot."""
    base = slope(extra, t, x, body, p, step, push, site)
    assemble_one(data, x.nu, base.nu, step[0], rotation(x.attitude), features)
    evaluate(data, features, a_res)
    return each6(body.free, vector6(a_res))


@inline_internal
def constants_of(bodies, m):
    """Constants of parameter set m alone, as tuples."""
    return Constants(
        matrix6(bodies.M_RB[m]),
        matrix6(bodies.M_A[m]),
        matrix6(bodies.M_inv[m]),
        vector6(bodies.linear[m]),
        vector6(bodies.quadratic[m]),
        bodies.net_weight[m],
        vector3(bodies.restoring_lever[m]),
        vector3(bodies.current[m]),
        bodies.advance[m],
        bodies.coupled[m],
        bodies.coupling[m],
        vector6(bodies.memory[m]),
        bodies.memory_decay[m],
        bodies.B[m],
        bodies.directions,
        bodies.uncommon[m],
        vector3(bodies.waterplane[m]),
        bodies.products[m],
        bodies.factors,
        bodies.surfaces,
        bodies.lifting[m],
        vector6(bodies.free[m]),
        bodies.places,
    )


@inline_internal
def parameters_of(p, m):
    """Parameters of the wrench effects of set m alone."""
    return WrenchParameters(p.values[m], p.attached)


@inline_internal
def step_of(inputs, row, k):
    """Inputs of step k: wrench, forces and angles, demand, duration (see `types.Inputs`)."""
    return (
        vector6(inputs.wrench[row, k]),
        inputs.acting[row, k],
        vector6(inputs.demand[k]),
        inputs.duration[k],
    )


@inline_internal
def ramp_of(inputs, row, k, body):
    """Change of the acceleration by the thrusters over step k, (6)."""
    if inputs.ramp.size == 0:
        return ZERO6
    return times6(body.M_inv, vector6(inputs.ramp[row, k]))


@inline_internal
def state_of(a):
    """State of an array (13,)."""
    return State((a[0], a[1], a[2]), (a[3], a[4], a[5], a[6]), vector6(a[7:]))


@inline_internal
def store(x, out):
    """Write a state into an array (13,)."""
    for i in range(3):
        out[i] = x.position[i]
    for i in range(4):
        out[3 + i] = x.attitude[i]
    for i in range(6):
        out[7 + i] = x.nu[i]


@inline_internal
def site_of(site):
    """`SiteArrays` as tuples: walls (low, high per NED axis), MoCap axes, level of rest."""
    tank = site.tank
    walls = ((tank[0, 0], tank[0, 1]), (tank[1, 0], tank[1, 1]), (tank[2, 0], tank[2, 1]))
    return walls, vector3(site.axes), site.level


@inline_anew
def stepped(extra, t, x, memory, h, body, own, step, ramp, data, place, features, a_res):
    """State and fluid memory after one step; the learned residual is constant over the step."""
    push = ZERO6
    if body.memory_decay != 0.0:
        push = push_over_step(x, memory, h, body)
    if data is not None:
        a_learned = learned(extra, t, x, body, own, step, push, data, place, features, a_res)
        push = add6(push, 1.0, a_learned)
    after, _ = runge_kutta(extra, t, x, h, body, own, step, push, ramp, place)
    if body.memory_decay != 0.0:
        memory = memory_after(memory, x, after, h, body)
    return after, memory


@entry
def integrate(extra, jobs, time, stride, bodies, inputs, p, data, site, out):
    """Integrate all jobs; every `stride` steps the state is written to the next row of `out`.

    `time` (k+1,) are the instants, in s, between the steps of the inputs; `out` is (.., 13).
    """
    place, features, a_res = site_of(site), np.empty(FEATURES), np.empty(6)
    for job in range(jobs.first.size):
        m, first, row = jobs.member[job], jobs.first[job], jobs.out[job]
        x, body, own = state_of(jobs.state[job]), constants_of(bodies, m), parameters_of(p, m)
        memory, left = vector6(jobs.memory[job]) if jobs.memory.size else ZERO6, stride
        for n in range(first, first + jobs.steps[job]):
            t, h, step = time[n], time[n + 1] - time[n], step_of(inputs, inputs.row[m], n)
            ramp = ramp_of(inputs, inputs.row[m], n, body)
            x, memory = stepped(
                extra, t, x, memory, h, body, own, step, ramp, data, place, features, a_res
            )
            left -= 1
            if left == 0:
                store(x, out[row])
                row, left = row + 1, stride


@entry
def advance(extra, state, memory, t, h, bodies, inputs, p, data, site):
    """Integrate a state (13,) and memory (6,) in place over all inputs, in steps of h s."""
    x, body, place, m = state_of(state), constants_of(bodies, 0), site_of(site), vector6(memory)
    features, a_res, own = np.empty(FEATURES), np.empty(6), parameters_of(p, 0)
    for n in range(inputs.duration.size):
        step = step_of(inputs, 0, n)
        x, m = stepped(
            extra, t + n * h, x, m, h, body, own, step, ZERO6, data, place, features, a_res
        )
    store(x, state)
    for i in range(6):
        memory[i] = m[i]


@entry
def heun(extra, state, memory, t, h, pushes, bodies, inputs, p, data, site, out):
    """Integrate with Heun's method, with an additional acceleration in each step: pushes (k, 6).

    For the synthetic tank, whose truth must not share the integrator of a replay. The fluid memory
    (6,) is integrated with the state and updated in place; states go to `out` (k, 13).
    """
    x, body, place = state_of(state), constants_of(bodies, 0), site_of(site)
    features, a_res, m = np.empty(FEATURES), np.empty(6), vector6(memory)
    own = parameters_of(p, 0)
    for n in range(pushes.shape[0]):
        step, now, push = step_of(inputs, 0, n), t + n * h, vector6(pushes[n])
        if data is not None:
            recalled = memory_push(body, m)
            a_learned = learned(
                extra, now, x, body, own, step, recalled, data, place, features, a_res
            )
            push = add6(push, 1.0, a_learned)
        k1 = slope(extra, now, x, body, own, step, add6(push, 1.0, memory_push(body, m)), place)
        m1 = add6(through_water(x, body), -1.0, m)
        x1, ahead = moved(x, h, k1), add6(m, h * body.memory_decay, m1)
        k2 = slope(
            extra, now + h, x1, body, own, step, add6(push, 1.0, memory_push(body, ahead)), place
        )
        m2 = add6(through_water(x1, body), -1.0, ahead)
        x = renormalised(moved(moved(x, 0.5 * h, k1), 0.5 * h, k2))
        m = add6(m, 0.5 * h * body.memory_decay, add6(m1, 1.0, m2))
        store(x, out[n])
    for i in range(6):
        memory[i] = m[i]


@entry
def accelerations(extra, times, states, memory, bodies, inputs, p, data, site, out):
    """Evaluate nu_dot (n, 6) of parameter set 0 at states (n, 13), under the inputs of step n.

    `memory` (n, 6) is the fluid memory at each state; empty: none.
    """
    body, own, place = constants_of(bodies, 0), parameters_of(p, 0), site_of(site)
    features, a_res = np.empty(FEATURES), np.empty(6)
    for n in range(times.size):
        x, step, push = state_of(states[n]), step_of(inputs, inputs.row[0], n), ZERO6
        if memory.size:
            push = memory_push(body, vector6(memory[n]))
        if data is not None:
            a_learned = learned(
                extra, times[n], x, body, own, step, push, data, place, features, a_res
            )
            push = add6(push, 1.0, a_learned)
        nu_dot = slope(extra, times[n], x, body, own, step, push, place).nu
        for i in range(6):
            out[n, i] = nu_dot[i]
