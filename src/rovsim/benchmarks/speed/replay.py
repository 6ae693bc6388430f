"""Integration steps per second: one trajectory, many side by side, with a residual in the loop."""

from dataclasses import replace
from time import perf_counter
from typing import Any, Callable, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import Site
from rovsim.dynamics import body as bodies
from rovsim.dynamics.actuation import Thrust
from rovsim.dynamics.learned.residual import Residual
from rovsim.dynamics.model import Model
from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.drive import Drive

STEP_S = 0.01
REPEATS = 15  # the best of so many: what the machine can do when nothing else runs


def steps_per_second(model: Model, count: int, steps: int) -> float:
    """Time `count` trajectories side by side, driven by random thrust.

    Args:
        model: that is replayed.
        count: of trajectories.
        steps: RK4 steps of each.

    Returns:
        Steps of all trajectories per second.
    """
    force = np.random.default_rng(0).uniform(-10, 10, (steps, len(model.body.directions)))
    thrust = Thrust(force, np.zeros((steps, 6)), np.full((steps, 6), np.nan))
    drive, batch = Drive.by(model, thrust, steps * STEP_S), Batch([model], Site.unknown())
    time = STEP_S * np.arange(steps + 1)
    state = np.zeros((1, count, 13))
    state[..., 3] = 1.0
    starts = Starts(state, np.zeros(count, np.int64), np.full(count, steps))
    return count * steps / best(lambda: batch.trajectories([drive], starts, time))


def best(call: Callable[[], Any]) -> float:
    """Return the shortest time in s of `REPEATS` calls, after one that may compile."""
    call()
    durations = []
    for _ in range(REPEATS):
        start = perf_counter()
        call()
        durations.append(perf_counter() - start)
    return min(durations)


def numpy_steps_per_second(model: Model) -> float:
    """Time the same equation written with NumPy matrices, as Python simulators usually are."""
    c, B, steps = model.constants, model.body.B, 300
    force = np.random.default_rng(0).uniform(-10, 10, (steps, B.shape[1]))

    def coriolis(M: Array, v: Array) -> Array:
        h = M @ v
        S = bodies.cross_matrix
        top = np.hstack([np.zeros((3, 3)), -S(h[:3])])
        return np.vstack([top, np.hstack([-S(h[:3]), -S(h[3:])])]) @ v

    def slope(x: Array, tau: Array) -> Array:
        q, nu = x[3:7], x[7:]
        w, v = q[0], q[1:]
        R = (
            np.eye(3)
            + 2 * w * bodies.cross_matrix(v)
            + 2 * np.linalg.matrix_power(bodies.cross_matrix(v), 2)
        )
        d = (c.linear[0] + c.quadratic[0] * np.abs(nu)) * nu
        g = np.concatenate([c.net_weight[0] * R[2], np.cross(c.restoring_lever[0], R[2])])
        net_force = tau - coriolis(c.M_RB[0], nu) - coriolis(c.M_A[0], nu) - d + g
        q_dot = 0.5 * np.concatenate([[-v @ nu[3:]], w * nu[3:] + np.cross(v, nu[3:])])
        return np.concatenate([R @ nu[:3], q_dot, c.M_inv[0] @ net_force])

    def drive() -> None:
        x = np.zeros(13)
        x[3] = 1.0
        for f in force:
            tau = B @ f
            k1 = slope(x, tau)
            k2 = slope(x + 0.5 * STEP_S * k1, tau)
            k3 = slope(x + 0.5 * STEP_S * k2, tau)
            k4 = slope(x + STEP_S * k3, tau)
            x = x + STEP_S / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            x[3:7] /= np.linalg.norm(x[3:7])

    return steps / best(drive)


def replay_speeds(model: Model, residuals: Mapping[str, Residual]) -> dict[str, float]:
    """Return steps per second of the nominal model, and with each residual in the loop, by name."""
    return {
        "single_steps_per_s": steps_per_second(model, 1, 200_000),
        "batch_steps_per_s": steps_per_second(model, 400, 2_000),
        **{
            f"{name}_in_loop_steps_per_s": steps_per_second(
                replace(model, residual=residual), 1, 5_000
            )
            for name, residual in residuals.items()
        },
        "numpy_steps_per_s": numpy_steps_per_second(model),
    }
