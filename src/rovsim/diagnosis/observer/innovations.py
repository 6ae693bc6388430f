"""Innovations of many models on one run, in one compiled call."""

from collections import Counter
from types import ModuleType
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.noise import Tuning
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.observer.unlisted_drag import UNLISTED_DRAG
from rovsim.dynamics.actuation import Between, Thrust
from rovsim.dynamics.body import packed
from rovsim.dynamics.effects import catalogue
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.engine.compiled import engine
from rovsim.dynamics.engine.parallel import run_jobs
from rovsim.dynamics.engine.types import NO_MEMORY, Inputs, Jobs
from rovsim.dynamics.model import Model
from rovsim.simulation.initial_memory import measured_memory
from rovsim.simulation.replay import as_true, packed_inputs, place, stacked

NUDGE = 0.05  # m/s or rad/s: a tenth of usual speeds


def observe(
    models: Sequence[Model], run: ObservedRun, tuning: Tuning, between: Between = "held"
) -> Array:
    """Innovations (m, 6, n) of models without a residual on one run; the models share a vehicle.

    Each in the axes and at the point that the motion capture reports: there its noise does not
    depend on where a model believes the markers to be, so no such belief is favoured by its noise.
    """
    module, inputs, p = batch(models, run, between)
    readings, starts, row = _seen(models, run)
    out = np.empty((len(models) * len(run.time), 6))
    run_jobs(
        module.observe, _jobs(models, run, starts), run.h, run.ends,
        packed([m.body for m in models]), inputs, p, place(run.motion),
        readings, row, tuning.gains, tuning.decay(run.h), run.motion.binned, out,
    )  # fmt: skip
    e = out.reshape(len(models), -1, 6)
    reported = np.stack([m.mocap_view.twists(own) for m, own in zip(models, e, strict=True)])
    return np.ascontiguousarray(reported.swapaxes(1, 2))


def estimate_damping(model: Model, runs: Sequence[ObservedRun], between: Between) -> Array:
    """How fast each velocity decays (6,) 1/s: -d nu_dot / d nu, mean over the measured states."""
    slopes = []
    for run in runs:
        states = as_true(model, run.motion).state
        index = np.flatnonzero(np.isfinite(states).all(axis=1) & run.motion.usable)
        states = np.tile(states[index], (7, 1, 1))
        for i in range(6):
            states[i + 1, :, 7 + i] += NUDGE
        found = _accelerations(model, run, between, index, states)
        slopes.append([(found[0, :, i] - found[i + 1, :, i]) / NUDGE for i in range(6)])
    return np.array([float(np.mean(np.concatenate(own))) for own in zip(*slopes, strict=True)])


def _accelerations(model, run, between, index, states) -> Array:
    """Accelerations (s, k, 6) at states (s, k, 13) of some readings (k,)."""
    module, inputs, p = batch([model], run, between)
    steps = np.minimum(run.ends[index], inputs.wrench.shape[1] - 1)
    demand = inputs.demand[steps] if len(inputs.demand) else inputs.demand
    at = Inputs(
        inputs.wrench[:, steps], inputs.force[:, steps], demand, inputs.row, inputs.duration[steps]
    )
    memory, out = remembered([model], run, run.ends[index]), np.empty_like(states[..., 7:])
    for state, own in zip(states, out, strict=True):
        module.accelerations(
            run.ends[index] * run.h, np.ascontiguousarray(state), memory, packed([model.body]),
            at, p, np.empty(0), place(run.motion), own,
        )  # fmt: skip
    return out


def batch(
    models: Sequence[Model], run: ObservedRun, between: Between
) -> tuple[ModuleType, Inputs, Array]:
    """One engine for all models, their thrust on one run, and their wrench parameters (m, k)."""
    slots = _slots(models)
    p = np.stack([_wrench_parameters(m, slots) for m in models])
    return engine(slots), _inputs(models, run, between), p


def _slots(models: Sequence[Model]) -> list[type[Wrench]]:
    """Wrench effects of the one engine that serves all candidates, some perhaps twice."""
    known = [c for c in catalogue().values() if issubclass(c, Wrench)]
    most: Counter[type[Wrench]] = Counter([*known, *UNLISTED_DRAG])
    for model in models:
        most |= Counter(type(w) for w in model.wrenches)
    return [cls for cls in sorted(most, key=lambda cls: cls.id) for _ in range(most[cls])]


def _wrench_parameters(model: Model, slots: Sequence[type[Wrench]]) -> Array:
    """Parameters of every slot; those the model does not use have their defaults."""
    own = list(model.wrenches)
    parts = [np.zeros(0)]
    for cls in slots:
        used = next((w for w in own if type(w) is cls), None)
        if used is not None:
            own.remove(used)
        parts.append(np.array([p.default for p in cls.parameters]) if used is None else used.values)
    return np.concatenate(parts)


def _inputs(models: Sequence[Model], run: ObservedRun, between: Between) -> Inputs:
    """Thrust of all models; those that are pushed alike share a row."""
    rows: dict[tuple, int] = {}
    thrusts: dict[tuple, Thrust] = {}
    parts, row, duration = [], [], float(run.edges[-1] - run.edges[0])
    for model in models:
        path, pushed = model.thrust_path, model.thrust_path.key
        if pushed not in thrusts:
            thrusts[pushed] = path.over_steps(run.motion.commands, run.edges, between)
        loops = [loop.values.tobytes() for loop in path.autopilots]
        inertia = model.body.M.tobytes() if loops else b""
        key = (*pushed, *loops, inertia, model.body.B.tobytes())
        if key not in rows:
            rows[key] = len(rows)
            parts.append(packed_inputs(model, thrusts[pushed], duration))
        row.append(rows[key])
    return stacked(parts, row)


def _seen(models: Sequence[Model], run: ObservedRun) -> tuple[Array, Array, Array]:
    """What each model takes for true: readings (r, k, 13), starts (m, ., 13), and rows (m,)."""
    views: dict[bytes, int] = {}
    readings, starts, row = [], [], []
    for model in models:
        back = model.mocap_view.inverse
        key = back.key
        if key not in views:
            views[key] = len(views)
            readings.append(back.states(run.readings))
        starts.append(back.states(run.starts))
        row.append(views[key])
    return np.stack(readings), np.stack(starts), np.array(row, np.int64)


def remembered(models: Sequence[Model], run: ObservedRun, steps: Array) -> Array:
    """What the water remembers (m * s, 6) at integration steps (s,); empty if it never does."""
    if not any(m.body.forgets for m in models):
        return NO_MEMORY
    rows = [measured_memory(m, as_true(m, run.motion), run.edges) for m in models]
    return np.concatenate([r[steps] if r.size else np.zeros((len(steps), 6)) for r in rows])


def _jobs(models: Sequence[Model], run: ObservedRun, starts: Array) -> Jobs:
    """One job for each model and span."""
    count = len(models)
    first = np.array([a for a, _ in run.spans], np.int64)
    steps = np.array([b - a for a, b in run.spans], np.int64)
    begin = np.array([a for a, _ in run.rows], np.int64)
    offset = np.repeat(np.arange(count) * len(run.time), len(first))
    return Jobs(
        starts.reshape(-1, 13), np.tile(run.ends[first] * run.h, count),
        np.tile(first, count), np.tile(steps, count), np.repeat(np.arange(count), len(first)),
        np.tile(begin, count) + offset, remembered(models, run, run.ends[first]),
    )  # fmt: skip
