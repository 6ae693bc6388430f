"""Replay: drive a model with the logged commands, from measured states.

Open loop starts once and is never corrected; windows of h seconds start anew every h. What comes
back is aligned with the measurement and went through the same filter.
"""

from itertools import islice
from typing import Iterable, Iterator, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.horizons import OPEN_LOOP, name_horizon
from rovsim.core.rotations import normalized
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.binned import backward_difference, bin_means
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.measured import find_measured
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.drive import drive_by_log
from rovsim.simulation.filter_padding import Embedded, derive, embed
from rovsim.simulation.initial_memory import remembered_at
from rovsim.simulation.measured_states import interpolate, interpolate_state, undo_mocap_view
from rovsim.simulation.prediction import Prediction, Replay
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from rovsim.simulation.step_grid import StepGrid
from rovsim.simulation.unfiltered_motion import stage_outputs
from rovsim.simulation.unmeasured_velocities import propagate_unmeasured_velocities
from rovsim.simulation.windows import find_whole, find_windows

Spans = Sequence[tuple[int, int]]


def replay(
    model: Model,
    motion: Motion,
    how: SimulationSettings,
    open_loop: bool = True,
) -> Replay:
    """Replay one run open loop, unless that is not wanted, and in windows.

    What comes back is what the motion capture would report of the model's motion. An unusable run
    predicts nothing.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    horizons = dict(by_horizon(model, motion, how, open_loop))
    return Replay(model.name, motion.run, motion.time, horizons)


def by_horizon(
    model: Model,
    motion: Motion,
    how: SimulationSettings,
    open_loop: bool = True,
) -> Iterator[tuple[str, Prediction]]:
    """The predictions of a replay, one after the other, with the names of their horizons.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    for name, spans in find_spans(motion, how.replay, open_loop).items():
        yield name, predict(model, motion, spans, how)


def find_spans(
    motion: Motion, settings: ReplaySettings, open_loop: bool = True
) -> dict[str, Spans]:
    """The windows of each horizon: `open_loop`, `0.5`, `2`, `5`."""
    spans: dict[str, Spans] = {OPEN_LOOP: find_whole(motion)} if open_loop else {}
    for seconds in settings.horizons:
        spans[name_horizon(seconds)] = list(find_windows(motion, seconds))
    return spans


def predict(model: Model, motion: Motion, spans: Spans, how: SimulationSettings) -> Prediction:
    """What the motion capture would report of a model in some windows of a run; see `predict_all`.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    return predict_all([Case(model, motion)], spans, how)[0]


class Case(NamedTuple):
    """A model and a run; `disturbed`: accelerations (k, 6) over the steps that come on top."""

    model: Model
    motion: Motion
    disturbed: Array | None = None


def predict_all(cases: Sequence[Case], spans: Spans, how: SimulationSettings) -> list[Prediction]:
    """What the motion capture would report of models in some windows of a run.

    Args:
        cases: of runs with one clock.
        spans: first sample or bin of each window, and its last one.
        how: filter and derivative of the measurement, step length, how commands are held.

    Raises:
        BadInput: the run lacks what an effect of a model needs.
    """
    if not spans:
        return [Prediction.empty(len(case.motion.time)) for case in cases]
    if cases[0].motion.binned:
        return [_predict_bins(case, spans, how.replay) for case in cases]
    return _predict_samples(cases, spans, how)


def simulate(
    model: Model,
    motion: Motion,
    starts: Sequence[tuple[int, int, Array]],
    settings: ReplaySettings,
    disturbed: Array | None = None,
) -> list[Array]:
    """Simulate from several true states of one run, under its commands.

    Args:
        model: the model to drive.
        motion: the run; true, as the model sees it.
        starts: for each trajectory its first step, number of samples, and state (13,); in order of
            time, and velocities that were not measured are the model's own.
        settings: step length and how commands are held.
        disturbed: accelerations (k, 6) over the steps that come on top.

    Returns:
        For each start its states (samples + 1, 13), the given one first.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    grid = StepGrid.over(motion, settings.step)
    first = np.array([s[0] for s in starts], np.int64)
    steps = np.array([s[1] for s in starts], np.int64) * grid.stride
    state = np.array([s[2] for s in starts]).reshape(1, -1, 13)
    memory = remembered_at([model], lambda m: motion, grid.edges, first)
    drive = drive_by_log(model, motion, grid, settings.commands)
    if disturbed is not None:
        drive = drive.pushed(disturbed @ model.M.T)
    batch, known = Batch([model], motion.site), find_measured(motion.measured)
    begins = propagate_unmeasured_velocities(
        batch, [drive], Starts(state, first, steps, memory), grid.time, known
    )
    return batch.trajectories([drive], begins, grid.time, grid.stride)[0]


def _predict_samples(
    cases: Sequence[Case], spans: Spans, how: SimulationSettings
) -> list[Prediction]:
    """Predictions at the samples of a uniform clock, through the filter of the measurement."""
    first = cases[0].motion
    signals = how.signals.suited(first)
    within = embed(first, spans, round(signals.reach / time_step(first.time)))
    paths = [path for case in cases for path in _report_samples(case, within, how.replay)]
    motions = [case.motion for case in cases for _ in within]
    derived = iter(zip(paths, derive(paths, within * len(cases), motions, signals), strict=True))
    return [_gather(len(first.time), within, islice(derived, len(within))) for _ in cases]


def _report_samples(
    case: Case, within: Sequence[Embedded], settings: ReplaySettings
) -> list[Array]:
    """Poses (k, 7) of each window, as reported."""
    model, motion, _ = case
    true, stride = undo_mocap_view(model, motion), StepGrid.over(motion, settings.step).stride
    state, period = true.state, time_step(motion.time)
    starts = [(w.first * stride, w.last + w.after - w.first, state[w.first]) for w in within]
    stages = stage_outputs(model, motion)[1:, :, :14]
    simulated = simulate(model, true, starts, settings, case.disturbed)
    return [
        model.mocap_view.report(path, period, stages[:, w.first])[:, :7]
        for w, path in zip(within, simulated, strict=True)
    ]


def _gather(
    count: int, within: Sequence[Embedded], derived: Iterable[tuple[Array, Array]]
) -> Prediction:
    """A prediction at `count` samples, of poses and their derivatives in each window."""
    found = Prediction.empty(count)
    for w, (path, (nu, nu_dot)) in zip(within, derived, strict=True):
        at, own = slice(w.first + 1, w.last + 1), slice(1, w.last - w.first + 1)
        found.eta[at], found.nu[at], found.nu_dot[at] = path[own], nu[own], nu_dot[own]
        found.mark_diverged(at)
    return found


def _predict_bins(case: Case, spans: Spans, settings: ReplaySettings) -> Prediction:
    """Means over the measurement's own bins, of a trajectory on fine steps; nothing is filtered."""
    model, motion, disturbed = case
    found = Prediction.empty(len(motion.time))
    true, grid = undo_mocap_view(model, motion), StepGrid.over(motion, settings.step)
    outputs, view = stage_outputs(model, motion)[1:], model.mocap_view
    bins, ends = np.append(motion.time, motion.end), len(grid.edges) - 1
    first = [min(round((bins[a] - bins[0]) / grid.h), ends - 1) for a, _ in spans]
    last = [min(int(np.ceil((bins[b] - bins[0]) / grid.h)), ends) for _, b in spans]
    starts = [
        (k, max(e - k, 1), interpolate_state(true, grid.edges[k]))
        for k, e in zip(first, last, strict=True)
    ]
    for (a, b), (k, count, _), path in zip(
        spans, starts, simulate(model, true, starts, settings, disturbed), strict=True
    ):
        fine = grid.edges[k : k + count + 1]
        begin = interpolate(motion.time, outputs, grid.edges[k])
        shown = view.report(path, grid.h, begin, straight=True)
        means = bin_means(fine, shown, np.clip(bins[a : b + 1], fine[0], fine[-1]))
        found.eta[a:b] = np.hstack([means[:, :3], normalized(means[:, 3:7])])
        found.nu[a:b] = means[:, 7:]
        found.nu_dot[a:b] = backward_difference(means[:, 7:], motion.time[a:b])
        found.mark_diverged(slice(a, b))
    return found
