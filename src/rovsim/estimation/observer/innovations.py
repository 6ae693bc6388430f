"""Innovations of many models on one run, in one compiled call."""

from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.kalman import AxisErrorDynamics
from rovsim.estimation.observer.noise import RunFilters
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.simulation.batch import Batch, Correction, Starts
from rovsim.simulation.initial_memory import remembered_at
from rovsim.simulation.measured_states import true_states, undo_mocap_view

# Of the root mean square: a torpedo's sway drives its yaw at 0.98 of it, axes of vehicles that go
# to and fro drive each other at 0.6 of it at most.
LASTING = 0.9
NUDGE = 0.05  # m/s or rad/s, a tenth of usual speeds; m or rad


def observe(
    models: Sequence[Model], run: ObservedRun, filters: RunFilters, pushed: Array | None = None
) -> Array:
    """Innovations (m, 6, n) of models without a residual on one run; the models share a vehicle.

    `pushed` (m, n, 6): accelerations at the readings that models have besides.

    Each in the axes and at the point that the motion capture reports: there its noise does not
    depend on where a model believes the markers to be, so no such belief is favoured by its noise.
    """
    readings, starts = _see(models, run)
    time = run.since_start(run.edges)
    seen = Correction(
        readings,
        run.reading_mask.astype(float),
        run.pose_measured,
        time,
        run.reading_steps,
        filters.gains,
        filters.decays,
        run.motion.binned,
    )
    drives = run.drives.of(models)
    if pushed is not None:
        drives = [
            drive.pushed(_between(run, own) @ model.M.T)
            for drive, own, model in zip(drives, pushed, models, strict=True)
        ]
    e = serve_all(models, run).innovations(drives, starts, seen)
    reported = np.stack([m.mocap_view.twists(own) for m, own in zip(models, e, strict=True)])
    return np.ascontiguousarray(reported.swapaxes(1, 2))


def _between(run: ObservedRun, a: Array) -> Array:
    """Of accelerations (n, 6) at the readings, those (s, 6) in the middle of the steps."""
    middle = run.edges[:-1] + 0.5 * np.diff(run.edges) - run.edges[0]
    return np.column_stack([np.interp(middle, run.time, own) for own in a.T])


class ErrorDynamics(NamedTuple):
    """How small errors go on: -d nu_dot / d nu, and / d pose (6, 6), mean over measured states.

    `largest` (6, 6): root mean square of `damping`, what it would be if it never changed its sign.
    Errors of the position stand along the body's axes, or level ones (`ObservedRun.pose_measured`).
    """

    damping: Array
    largest: Array
    stiffness: Array

    @property
    def error_dynamics(self) -> tuple[AxisErrorDynamics, ...]:
        """Each axis by itself."""
        each = zip(np.diag(self.damping), np.diag(self.stiffness), strict=True)
        return tuple(AxisErrorDynamics(float(d), float(k)) for d, k in each)

    @property
    def coupling(self) -> float:
        """How fast velocities of two axes drive each other all the time, 1/s, at most."""
        lasting = np.where(np.abs(self.damping) > LASTING * self.largest, self.damping, 0.0)
        across = lasting * lasting.T
        return float(np.sqrt(np.max(np.abs(across - np.diag(np.diag(across))))))


def estimate_errors(model: Model, runs: Sequence[ObservedRun]) -> ErrorDynamics:
    """How errors of a model's velocities and poses go on over the measured states."""
    slopes = []
    for run in runs:
        states = undo_mocap_view(model, run.motion).state
        index = np.flatnonzero(np.isfinite(states).all(axis=1) & run.motion.usable)
        states = _nudge(states[index], level=bool(run.pose_measured[4]))
        accelerations = accelerate(model, run, index, states)
        slopes.append((accelerations[0] - accelerations[1:]) / NUDGE)
    slope = np.concatenate(slopes, axis=1)
    mean, largest = np.mean(slope, axis=1), np.sqrt(np.mean(slope[:6] ** 2, axis=1))
    return ErrorDynamics(mean[:6].T, largest.T, mean[6:].T)


def _nudge(states: Array, level: bool) -> Array:
    """States (13, k, 13): as they are, then faster on each axis, then displaced along each."""
    nudged = np.tile(states, (13, 1, 1))
    q = states[:, 3:7]
    zero = np.zeros(len(q))
    axes = rotations.from_euler(zero, zero, rotations.to_euler(q)[:, 2]) if level else q
    for i, unit in enumerate(np.eye(3)):
        nudged[1 + i, :, 7 + i] += NUDGE
        nudged[4 + i, :, 10 + i] += NUDGE
        nudged[7 + i, :, :3] += rotations.rotate(axes, NUDGE * np.tile(unit, (len(q), 1)))
        nudged[10 + i, :, 3:7] = rotations.multiply(q, rotations.exp(NUDGE * unit))
    return nudged


def accelerate(model: Model, run: ObservedRun, index: Array, states: Array) -> Array:
    """Accelerations (s, k, 6) at states (s, k, 13) of some samples or bins (k,)."""
    at, edges, batch = run.at[index], run.grid, serve_all([model], run)
    drive = run.replay_drives.of([model])[0].at(np.minimum(at, len(edges) - 2))
    memory = recall([model], run, edges, at).reshape(-1, 6)
    return np.stack(
        [batch.accelerations(drive, run.since_start(edges)[at], own, memory) for own in states]
    )


def serve_all(models: Sequence[Model], run: ObservedRun) -> Batch:
    """One engine for all models, at the site of a run."""
    return Batch(models, run.motion.site, candidates=run.wrenches, learned=False)


def _see(models: Sequence[Model], run: ObservedRun) -> tuple[list[Array], Starts]:
    """What each model takes for true: readings (k, 13), shared where models see alike; starts."""
    views = [m.mocap_view.inverse for m in models]
    readings = {back.key: run.read(back) for back in {v.key: v for v in views}.values()}
    first = np.array([a for a, _ in run.segments], np.int64)
    steps = np.array([b - a for a, b in run.segments], np.int64)
    alike = {m.mocap_view.key: m for m in models}
    true = {key: true_states(m, run.motion, run.reading_samples[first]) for key, m in alike.items()}
    states = np.stack([true[m.mocap_view.key] for m in models])
    starts = Starts(states, first, steps, recall(models, run, run.edges, run.reading_steps[first]))
    return [readings[back.key] for back in views], starts


def recall(models: Sequence[Model], run: ObservedRun, edges: Array, steps: Array) -> Array:
    """What the water remembers (m, s, 6) at steps (s,) of a grid; empty if it never does."""
    return remembered_at(models, lambda m: undo_mocap_view(m, run.motion), edges, steps)
