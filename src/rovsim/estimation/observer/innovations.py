"""Run many models along one recording at once: their innovations, and how their errors evolve."""

from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.kalman import AxisErrorDynamics
from rovsim.estimation.observer.noise import RunFilters
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.correction import Correction
from rovsim.simulation.initial_memory import remembered_at
from rovsim.simulation.measured_states import true_states, undo_mocap_view

# Of the root mean square: a torpedo's sway drives its yaw at 0.98 of it, axes of vehicles that go
# to and fro drive each other at 0.6 of it at most.
MIN_COUPLING_SHARE = 0.9
PERTURBATION = 0.05  # m/s or rad/s, a tenth of usual speeds; m or rad


def observe(
    models: Sequence[Model],
    run: ObservedRun,
    filters: RunFilters,
    disturbances: Array | None = None,
) -> Array:
    """Innovations (m, 6, n) of m models on one run, without their learned residuals.

    They stand in the axes, and at the point, that the motion capture reports. There the noise of
    the cameras is the same wherever a model assumes the markers to be, so that it favours none of
    these assumptions.

    Args:
        models: of one vehicle.
        run: what was measured.
        filters: that correct the models.
        disturbances: accelerations (m, n, 6) of the models at the readings, m/s2 and rad/s2.
    """
    readings, row, starts = _read_as_modelled(models, run)
    time = run.since_start(run.edges)
    correction = Correction(
        readings,
        row,
        run.reading_mask.astype(float),
        run.pose_measured,
        time,
        run.reading_steps,
        filters.gains,
        filters.decays,
        run.motion.binned,
    )
    drives = run.drives.of(models)
    if disturbances is not None:
        drives = [
            drive.with_wrench(_between(run, a) @ model.M.T)
            for drive, a, model in zip(drives, disturbances, models, strict=True)
        ]
    e = batch_of(models, run).innovations(drives, starts, correction)
    reported = np.stack([m.mocap_view.twists(a) for m, a in zip(models, e, strict=True)])
    return np.ascontiguousarray(reported.swapaxes(1, 2))


def _between(run: ObservedRun, a: Array) -> Array:
    """Interpolate accelerations (n, 6) at the readings to the middle of each step, (s, 6)."""
    middle = run.edges[:-1] + 0.5 * np.diff(run.edges) - run.edges[0]
    return np.column_stack([np.interp(middle, run.time, column) for column in a.T])


class ErrorDynamics(NamedTuple):
    """How small errors of a model grow or decay, linearised and averaged over measured states.

    Errors of the position stand along the body's axes, or along level axes where only parts of the
    pose were measured (`ObservedRun.pose_measured`).

    Attributes:
        damping: -d nu_dot / d nu (6, 6), 1/s.
        largest: root mean square (6, 6) of the same, 1/s; as large as `damping` where that never
            changes its sign.
        stiffness: -d nu_dot / d pose (6, 6), 1/s2.
    """

    damping: Array
    largest: Array
    stiffness: Array

    @property
    def by_axis(self) -> tuple[AxisErrorDynamics, ...]:
        """The same for each of the six axes by itself, without what couples them."""
        diagonals = zip(np.diag(self.damping), np.diag(self.stiffness), strict=True)
        return tuple(AxisErrorDynamics(float(d), float(k)) for d, k in diagonals)

    @property
    def coupling(self) -> float:
        """The fastest rate at which two axes constantly drive each other, 1/s."""
        significant = np.where(
            np.abs(self.damping) > MIN_COUPLING_SHARE * self.largest, self.damping, 0.0
        )
        products = significant * significant.T
        return float(np.sqrt(np.max(np.abs(products - np.diag(np.diag(products))))))


def estimate_errors(model: Model, runs: Sequence[ObservedRun]) -> ErrorDynamics:
    """Linearise a model at all measured states: how errors of its velocities and poses evolve."""
    slopes = []
    for run in runs:
        states = undo_mocap_view(model, run.motion).state
        index = np.flatnonzero(np.isfinite(states).all(axis=1) & run.motion.usable)
        states = _perturb(states[index], level=bool(run.pose_measured[4]))
        accelerations = accelerate(model, run, index, states)
        slopes.append((accelerations[0] - accelerations[1:]) / PERTURBATION)
    slope = np.concatenate(slopes, axis=1)
    mean, largest = np.mean(slope, axis=1), np.sqrt(np.mean(slope[:6] ** 2, axis=1))
    return ErrorDynamics(mean[:6].T, largest.T, mean[6:].T)


def _perturb(states: Array, level: bool) -> Array:
    """Thirteen variants (13, k, 13) of states (k, 13).

    The states themselves, then with a faster velocity on each of the six axes, then displaced along
    or turned about each of them; along level axes where `level`.
    """
    perturbed = np.tile(states, (13, 1, 1))
    q = states[:, 3:7]
    zero = np.zeros(len(q))
    axes = rotations.from_euler(zero, zero, rotations.to_euler(q)[:, 2]) if level else q
    for i, unit in enumerate(np.eye(3)):
        perturbed[1 + i, :, 7 + i] += PERTURBATION
        perturbed[4 + i, :, 10 + i] += PERTURBATION
        perturbed[7 + i, :, :3] += rotations.rotate(axes, PERTURBATION * np.tile(unit, (len(q), 1)))
        perturbed[10 + i, :, 3:7] = rotations.multiply(q, rotations.exp(PERTURBATION * unit))
    return perturbed


def accelerate(model: Model, run: ObservedRun, index: Array, states: Array) -> Array:
    """Accelerations (s, k, 6) of a model at s variants of the states (s, k, 13).

    Args:
        model: the model.
        run: under whose commands it moves.
        index: samples or bins (k,) of the run that the states belong to.
        states: s variants of each.
    """
    at, edges, batch = run.at[index], run.grid, batch_of([model], run)
    drive = run.replay_drives.of([model])[0].at(np.minimum(at, len(edges) - 2))
    memory = find_fluid_memory([model], run, edges, at).reshape(-1, 6)
    return np.stack(
        [batch.accelerations(drive, run.since_start(edges)[at], state, memory) for state in states]
    )


def batch_of(models: Sequence[Model], run: ObservedRun) -> Batch:
    """The models side by side in one engine, at the site of a run, without learned residuals."""
    return Batch(models, run.motion.site, candidates=run.wrenches, learned=False)


def _read_as_modelled(models: Sequence[Model], run: ObservedRun) -> tuple[Array, Array, Starts]:
    """Readings and starts as each model interprets them.

    Models may differ in what they assume of the cameras, such as where the markers are.

    Returns:
        Readings (r, k, 13) of the vehicle itself, one series for all models that assume the same;
        which series (m,) is that of each model; and where the models start.
    """
    views = [m.mocap_view.inverse for m in models]
    distinct = {inverse.key: inverse for inverse in views}
    readings = np.stack([run.read(inverse) for inverse in distinct.values()])
    series = {key: k for k, key in enumerate(distinct)}
    begins = np.array([a for a, _ in run.segments], np.int64)
    steps = np.array([b - a for a, b in run.segments], np.int64)
    by_view = {m.mocap_view.key: m for m in models}
    states_by_view = {
        key: true_states(m, run.motion, run.reading_samples[begins]) for key, m in by_view.items()
    }
    states = np.stack([states_by_view[m.mocap_view.key] for m in models])
    starts = Starts(
        states, begins, steps, find_fluid_memory(models, run, run.edges, run.reading_steps[begins])
    )
    return readings, np.array([series[inverse.key] for inverse in views], np.int64), starts


def find_fluid_memory(
    models: Sequence[Model], run: ObservedRun, edges: Array, steps: Array
) -> Array:
    """Velocity (m, s, 6) that the water still has in each model, where it has a fluid memory.

    Args:
        models: m of them.
        run: whose measured motion the water followed.
        edges: (k+1,) s at which the steps of a grid begin and end.
        steps: (s,) of that grid.

    Returns:
        The velocities; empty if no model has a fluid memory.
    """
    return remembered_at(models, lambda m: undo_mocap_view(m, run.motion), edges, steps)
