"""Innovations of many models on one run, in one compiled call."""

from collections import Counter
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.noise import Tuning
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.model import Model
from rovsim.simulation.batch import Batch, Correction, Starts
from rovsim.simulation.drive import Drive, drive_models
from rovsim.simulation.initial_memory import remembered_at
from rovsim.simulation.measured_states import as_true

NUDGE = 0.05  # m/s or rad/s: a tenth of usual speeds


def observe(models: Sequence[Model], run: ObservedRun, tuning: Tuning) -> Array:
    """Innovations (m, 6, n) of models without a residual on one run; the models share a vehicle.

    Each in the axes and at the point that the motion capture reports: there its noise does not
    depend on where a model believes the markers to be, so no such belief is favoured by its noise.
    """
    readings, starts = _see(models, run)
    seen = Correction(
        readings, run.ends, tuning.gains, tuning.decay(run.h), by_velocity=run.motion.binned
    )
    e = serve_all(models, run).innovations(drive_all(models, run), starts, run.h, seen)
    reported = np.stack([m.mocap_view.twists(own) for m, own in zip(models, e, strict=True)])
    return np.ascontiguousarray(reported.swapaxes(1, 2))


def estimate_damping(model: Model, runs: Sequence[ObservedRun]) -> Array:
    """How fast each velocity decays (6,) 1/s: -d nu_dot / d nu, mean over the measured states."""
    slopes = []
    for run in runs:
        states = as_true(model, run.motion).state
        index = np.flatnonzero(np.isfinite(states).all(axis=1) & run.motion.usable)
        states = np.tile(states[index], (7, 1, 1))
        for i in range(6):
            states[i + 1, :, 7 + i] += NUDGE
        found = _accelerate(model, run, index, states)
        slopes.append([(found[0, :, i] - found[i + 1, :, i]) / NUDGE for i in range(6)])
    return np.array([float(np.mean(np.concatenate(own))) for own in zip(*slopes, strict=True)])


def _accelerate(model: Model, run: ObservedRun, index: Array, states: Array) -> Array:
    """Accelerations (s, k, 6) at states (s, k, 13) of some readings (k,)."""
    ends, batch = run.ends[index], serve_all([model], run)
    drive = drive_all([model], run)[0].at(np.minimum(ends, len(run.edges) - 2))
    memory = recall([model], run, ends).reshape(-1, 6)
    return np.stack([batch.accelerations(drive, ends * run.h, own, memory) for own in states])


def serve_all(models: Sequence[Model], run: ObservedRun) -> Batch:
    """One engine for all models, at the site of a run."""
    return Batch(models, run.motion.site, _slots(models, run.wrenches))


def drive_all(models: Sequence[Model], run: ObservedRun) -> list[Drive]:
    """What the logged commands do to each model, over the integration steps of a run."""
    return drive_models(models, run.motion.commands, run.edges, run.between)


def _slots(models: Sequence[Model], known: Sequence[type[Wrench]]) -> list[type[Wrench]]:
    """Wrench effects of the one engine that serves all candidates, some perhaps twice."""
    most: Counter[type[Wrench]] = Counter(known)
    for model in models:
        most |= Counter(type(w) for w in model.wrenches)
    return [cls for cls in sorted(most, key=lambda cls: cls.id) for _ in range(most[cls])]


def _see(models: Sequence[Model], run: ObservedRun) -> tuple[list[Array], Starts]:
    """What each model takes for true: readings (k, 13), shared where models see alike; starts."""
    readings: dict[bytes, Array] = {}
    for model in models:
        back = model.mocap_view.inverse
        if back.key not in readings:
            readings[back.key] = back.states(run.readings)
    first = np.array([a for a, _ in run.spans], np.int64)
    steps = np.array([b - a for a, b in run.spans], np.int64)
    states = np.stack([m.mocap_view.inverse.states(run.starts) for m in models])
    starts = Starts(states, first, steps, recall(models, run, run.ends[first]))
    return [readings[m.mocap_view.inverse.key] for m in models], starts


def recall(models: Sequence[Model], run: ObservedRun, steps: Array) -> Array:
    """What the water remembers (m, s, 6) at integration steps (s,); empty if it never does."""
    true = (as_true(m, run.motion) for m in models)
    return remembered_at(models, true, run.edges, steps)
