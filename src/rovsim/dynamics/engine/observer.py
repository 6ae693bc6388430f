"""Innovations of a model that is integrated along a measurement and corrected by it.

    x_dot = f(x, u) + a,   a_dot = -a / T + white noise,   reading = pose or mean velocity + noise

This is a Kalman filter with constant gains for each axis: a is the disturbance, an acceleration (6)
with time constants T. Innovations are one-step prediction errors of the model.
"""

from math import atan2, cos, sin

from rovsim.dynamics.compilation.compiled import entry, inline_internal
from rovsim.dynamics.engine.as_tuples import (
    constants_of,
    parameters_of,
    state_of,
    step_of,
    surroundings_of,
)
from rovsim.dynamics.engine.equation import rotation
from rovsim.dynamics.engine.integration import (
    memory_after,
    midstep_memory_acceleration,
    renormalised,
    runge_kutta,
)
from rovsim.dynamics.engine.types import State
from rovsim.dynamics.engine.vectors import (
    ZERO6,
    add3,
    add6,
    each6,
    into_body,
    into_world,
    vector6,
)


@inline_internal
def turned(q, v):
    """q rotated by a small rotation vector v (3), body axes, rad; not normalised."""
    w, i, j, k = q
    a, b, c = 0.5 * v[0], 0.5 * v[1], 0.5 * v[2]
    return (
        w - i * a - j * b - k * c,
        i + w * a + j * c - k * b,
        j + w * b + k * a - i * c,
        k + w * c + i * b - j * a,
    )


@inline_internal
def heading(q):
    """The yaw part of an attitude q, as a quaternion."""
    w, i, j, k = q
    half = 0.5 * atan2(2.0 * (w * k + i * j), w * w + i * i - j * j - k * k)
    return cos(half), 0.0, 0.0, sin(half)


@inline_internal
def headed(q, y):
    """Quaternion of a measured pose y (7,), rotated in addition by the yaw of the predicted q."""
    c, _, _, s = heading(q)
    return c * y[3] - s * y[6], c * y[4] - s * y[5], c * y[5] + s * y[4], c * y[6] + s * y[3]


@inline_internal
def axes_of_errors(q, measured):
    """Rotation to NED from the axes of position errors: body axes, or level ones at its yaw."""
    if measured[4] == 1.0:
        return rotation(heading(q))
    return rotation(q)


@inline_internal
def pose_error(x, y, measured):
    """Innovation (6) of a pose: measured y (7,) minus predicted, m and rad (rotation vector).

    Position errors are along `axes_of_errors`, rotations along body axes.

    Args:
        x: predicted state.
        y: measured position in NED, m, and quaternion body to world.
        measured: (5,) 1 where x, y, z and yaw were measured, 0 where the prediction stands in for
            them. The last element is 1 where different sensors measure height and horizontal
            position: position errors are then along level axes, which keeps their noise apart.
    """
    moved = (
        measured[0] * (y[0] - x.position[0]),
        measured[1] * (y[1] - x.position[1]),
        measured[2] * (y[2] - x.position[2]),
    )
    d = into_body(axes_of_errors(x.attitude, measured), moved)
    w, i, j, k = x.attitude
    a, b, c, e = y[3], y[4], y[5], y[6]
    if measured[3] == 0.0:
        a, b, c, e = headed(x.attitude, y)
    real = w * a + i * b + j * c + k * e
    two = 2.0 if real >= 0.0 else -2.0
    return (
        d[0],
        d[1],
        d[2],
        two * (w * b - i * a - j * e + k * c),
        two * (w * c + i * e - j * a - k * b),
        two * (w * e - i * c + j * b - k * a),
    )


@inline_internal
def velocity_error(mean, y):
    """Innovation (6) of the mean velocity: y[7:] of a reading y (13,) minus the predicted mean."""
    return (
        y[7] - mean[0],
        y[8] - mean[1],
        y[9] - mean[2],
        y[10] - mean[3],
        y[11] - mean[4],
        y[12] - mean[5],
    )


@inline_internal
def along_body(v, q, measured):
    """A vector (6) with its linear part turned from the axes of position errors to body axes."""
    if measured[4] == 1.0:
        d = into_body(rotation(q), into_world(rotation(heading(q)), v[:3]))
        return d[0], d[1], d[2], v[3], v[4], v[5]
    return v


@inline_internal
def corrected(x, y, e, measured, gain_pose, gain_nu, by_velocity):
    """The state corrected by an innovation e (6), with gains (6) on the pose and on nu.

    With `by_velocity`, e corrects nu alone, and the measured pose of y replaces the predicted one.
    """
    nu = add6(x.nu, 1.0, along_body(each6(gain_nu, e), x.attitude, measured))
    if by_velocity:
        return State((y[0], y[1], y[2]), (y[3], y[4], y[5], y[6]), nu)
    k = each6(gain_pose, e)
    position = add3(x.position, 1.0, into_world(axes_of_errors(x.attitude, measured), k[:3]))
    return State(position, turned(x.attitude, k[3:]), nu)


@entry
def observe(extra, jobs, world, correction, out):
    """Filter all jobs, and write their innovations to `out`; no learned residual acts.

    Args:
        extra: wrench of the model's effects, see `equation`.
        jobs: each starts at the reading `first` and covers the `steps` readings that follow.
        world: of all parameter sets.
        correction: the readings and the filters, a `rovsim.simulation.correction.Correction`.
        out: (.., 6) innovations, m or m/s and rad or rad/s.
    """
    inputs, time, ends, measured = world.inputs, correction.time, correction.ends, correction.known
    by_velocity, decay, gains = correction.by_velocity, correction.decay, correction.gains
    constants, parameter_sets = world.constants, world.parameters
    surroundings = surroundings_of(world.site)
    for job in range(jobs.first.size):
        m, first, at = jobs.member[job], jobs.first[job], jobs.out[job]
        x, body = state_of(jobs.state[job]), constants_of(constants, m)
        parameters = parameters_of(parameter_sets, m)
        gain_pose, gain_nu = vector6(gains[0]), each6(body.free, vector6(gains[1]))
        gain_a = each6(body.free, vector6(gains[2]))
        a, n = ZERO6, ends[first]
        memory = vector6(jobs.memory[job]) if jobs.memory.size else ZERO6
        for k in range(first + 1, first + 1 + jobs.steps[job]):
            mean, duration = ZERO6, time[ends[k]] - time[n]
            while n < ends[k]:
                t, h, previous, disturbance = time[n], time[n + 1] - time[n], x, a
                if body.memory_decay != 0.0:
                    disturbance = add6(a, 1.0, midstep_memory_acceleration(x, memory, h, body))
                step = step_of(inputs, inputs.row[m], n, t, h, body)
                x, average = runge_kutta(
                    extra, x, body, parameters, step, disturbance, surroundings
                )
                if body.memory_decay != 0.0:
                    memory = memory_after(memory, previous, x, h, body)
                mean = add6(mean, h / duration, average)
                a, n = each6(vector6(decay[n]), a), n + 1
            y = correction.readings[correction.row[m], k]
            e = velocity_error(mean, y) if by_velocity else pose_error(x, y, measured)
            e = each6(vector6(correction.seen[k]), e)
            a = add6(a, 1.0, along_body(each6(gain_a, e), x.attitude, measured))
            x = renormalised(corrected(x, y, e, measured, gain_pose, gain_nu, by_velocity))
            for i in range(6):
                out[at + k - first - 1, i] = e[i]
