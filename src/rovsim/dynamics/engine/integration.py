"""Numerical integration of the equation of motion, compiled by Numba.

`extra` is the wrench of a model's effects, see `equation`. Entries get the `World` of all parameter
sets; the functions that they call get what belongs to one of them, and one `Step` at a time. Where
no learned residual acts, Numba does not compile its evaluation, which takes longer than everything
else: functions get a residual as an argument of its own, since Numba looks for None in no tuple.
"""

from math import exp, sqrt

import numpy as np

from rovsim.dynamics.compilation.compiled import entry, inline_anew, inline_internal, internal
from rovsim.dynamics.engine.as_tuples import (
    constants_of,
    even_step_of,
    parameters_of,
    state_of,
    step_of,
    store,
    surroundings_of,
)
from rovsim.dynamics.engine.equation import flow, rotation, slope
from rovsim.dynamics.engine.types import Scratch, State
from rovsim.dynamics.engine.vectors import ZERO6, add3, add4, add6, each6, times6, vector6
from rovsim.dynamics.learned.features import assemble_one
from rovsim.dynamics.learned.predictor import evaluate
from rovsim.dynamics.learned.settings import MAX_FEATURES


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
def runge_kutta(extra, x, body, parameters, step, correction, surroundings):
    """One classical Runge-Kutta 4 step; returns the state and the mean nu (Nystroem).

    `correction` (6) is an additional acceleration, the mean over the step.
    """
    t, h, ramp = step.t, step.h, step.ramp
    first, last = add6(correction, -0.5, ramp), add6(correction, 0.5, ramp)
    k1 = slope(extra, t, x, body, parameters, step, first, surroundings)
    x2, half = moved(x, 0.5 * h, k1), t + 0.5 * h
    k2 = slope(extra, half, x2, body, parameters, step, correction, surroundings)
    x3 = moved(x, 0.5 * h, k2)
    k3 = slope(extra, half, x3, body, parameters, step, correction, surroundings)
    k4 = slope(extra, t + h, moved(x, h, k3), body, parameters, step, last, surroundings)
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
    decay = exp(-time)
    return add6(add6(ZERO6, decay, memory), 1.0 - decay, nu_r)


@inline_internal
def memory_acceleration(body, memory):
    """Acceleration (6) by the fluid memory: by water that still moves as the vehicle did."""
    return times6(body.M_inv, each6(body.memory, memory))


@internal
def midstep_memory_acceleration(x, memory, h, body):
    """The same at the middle of a step from x: held over the step, it is of second order."""
    ahead = lagged(memory, through_water(x, body), 0.5 * h * body.memory_decay)
    return memory_acceleration(body, ahead)


@internal
def memory_after(memory, x, after, h, body):
    """Fluid memory after a step from state x to state `after`, at their mean nu_r."""
    mean = add6(through_water(x, body), 1.0, through_water(after, body))
    return lagged(memory, add6(ZERO6, 0.5, mean), h * body.memory_decay)


@inline_anew
def learned(extra, x, body, parameters, step, disturbance, surroundings, residual, scratch):
    """Learned acceleration (6) at x: tau_res = M a_res, so it adds to nu_dot; zero without one.

    `disturbance` (6) is an additional acceleration, under which the residual sees the model.
    """
    if residual is None:
        return ZERO6
    base = slope(extra, step.t, x, body, parameters, step, disturbance, surroundings)
    R = rotation(x.attitude)
    assemble_one(residual, x.nu, base.nu, step.thrust, R, scratch.features)
    evaluate(residual, scratch.features, scratch.a_res)
    return each6(body.free, vector6(scratch.a_res))


@inline_internal
def empty_scratch():
    """What a residual may write to."""
    return Scratch(np.empty(MAX_FEATURES), np.empty(6))


@inline_anew
def stepped(extra, x, memory, body, parameters, step, surroundings, residual, scratch):
    """State and fluid memory after one step; the learned residual is constant over the step."""
    disturbance = ZERO6
    if body.memory_decay != 0.0:
        disturbance = midstep_memory_acceleration(x, memory, step.h, body)
    a_res = learned(extra, x, body, parameters, step, disturbance, surroundings, residual, scratch)
    after, _ = runge_kutta(
        extra, x, body, parameters, step, add6(disturbance, 1.0, a_res), surroundings
    )
    if body.memory_decay != 0.0:
        memory = memory_after(memory, x, after, step.h, body)
    return after, memory


@entry
def integrate(extra, jobs, time, stride, world, out):
    """Integrate all jobs; every `stride` steps the state is written to the next row of `out`.

    `time` (k+1,) are the instants, in s, between the steps of the inputs; `out` is (.., 13).
    """
    inputs, residual, scratch = world.inputs, world.residual, empty_scratch()
    constants, parameter_sets = world.constants, world.parameters
    surroundings = surroundings_of(world.site)
    for job in range(jobs.first.size):
        m, first, row = jobs.member[job], jobs.first[job], jobs.out[job]
        body, parameters = constants_of(constants, m), parameters_of(parameter_sets, m)
        x, remaining = state_of(jobs.state[job]), stride
        memory = vector6(jobs.memory[job]) if jobs.memory.size else ZERO6
        for n in range(first, first + jobs.steps[job]):
            step = step_of(inputs, inputs.row[m], n, time[n], time[n + 1] - time[n], body)
            x, memory = stepped(
                extra, x, memory, body, parameters, step, surroundings, residual, scratch
            )
            remaining -= 1
            if remaining == 0:
                store(x, out[row])
                row, remaining = row + 1, stride


@entry
def advance(extra, state, memory, t, h, world):
    """Integrate a state (13,) and memory (6,) in place over all inputs, in steps of h s."""
    x, body, surroundings = (
        state_of(state),
        constants_of(world.constants, 0),
        surroundings_of(world.site),
    )
    m, scratch, parameters = vector6(memory), empty_scratch(), parameters_of(world.parameters, 0)
    inputs, residual = world.inputs, world.residual
    for n in range(inputs.duration.size):
        step = even_step_of(inputs, 0, n, t + n * h, h)
        x, m = stepped(extra, x, m, body, parameters, step, surroundings, residual, scratch)
    store(x, state)
    for i in range(6):
        memory[i] = m[i]


@entry
def heun(extra, state, memory, t, h, disturbances, world, out):
    """Integrate with Heun's method, adding an acceleration in each step: disturbances (k, 6).

    For the synthetic tank, whose truth must not share the integrator of a replay. The fluid memory
    (6,) is integrated with the state and updated in place; states go to `out` (k, 13).
    """
    x, body, surroundings = (
        state_of(state),
        constants_of(world.constants, 0),
        surroundings_of(world.site),
    )
    m, scratch, parameters = vector6(memory), empty_scratch(), parameters_of(world.parameters, 0)
    inputs, residual = world.inputs, world.residual
    for n in range(disturbances.shape[0]):
        now, disturbance, recalled = (
            t + n * h,
            vector6(disturbances[n]),
            memory_acceleration(body, m),
        )
        step = even_step_of(inputs, 0, n, now, h)
        a_res = learned(extra, x, body, parameters, step, recalled, surroundings, residual, scratch)
        disturbance = add6(disturbance, 1.0, a_res)
        k1 = slope(
            extra, now, x, body, parameters, step, add6(disturbance, 1.0, recalled), surroundings
        )
        m1 = add6(through_water(x, body), -1.0, m)
        x1, ahead = moved(x, h, k1), add6(m, h * body.memory_decay, m1)
        disturbance = add6(disturbance, 1.0, memory_acceleration(body, ahead))
        k2 = slope(extra, now + h, x1, body, parameters, step, disturbance, surroundings)
        m2 = add6(through_water(x1, body), -1.0, ahead)
        x = renormalised(moved(moved(x, 0.5 * h, k1), 0.5 * h, k2))
        m = add6(m, 0.5 * h * body.memory_decay, add6(m1, 1.0, m2))
        store(x, out[n])
    for i in range(6):
        memory[i] = m[i]


@entry
def accelerations(extra, times, states, memory, world, out):
    """Evaluate nu_dot (n, 6) of parameter set 0 at states (n, 13), under the inputs of step n.

    `memory` (n, 6) is the fluid memory at each state; empty: none.
    """
    inputs, residual, scratch = world.inputs, world.residual, empty_scratch()
    body, parameters = constants_of(world.constants, 0), parameters_of(world.parameters, 0)
    surroundings = surroundings_of(world.site)
    for n in range(times.size):
        x, disturbance = state_of(states[n]), ZERO6
        step = even_step_of(inputs, inputs.row[0], n, times[n], 0.0)
        if memory.size:
            disturbance = memory_acceleration(body, vector6(memory[n]))
        a_res = learned(
            extra, x, body, parameters, step, disturbance, surroundings, residual, scratch
        )
        disturbance = add6(disturbance, 1.0, a_res)
        nu_dot = slope(extra, times[n], x, body, parameters, step, disturbance, surroundings).nu
        for i in range(6):
            out[n, i] = nu_dot[i]
