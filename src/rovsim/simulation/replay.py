"""Replay: drive a model with the logged commands, from measured states.

An open-loop replay starts once and is never corrected; windows of h seconds start again from the
measured state every h seconds. Predictions are aligned with the measurement, and have passed the
same filter.
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
from rovsim.simulation.filter_padding import PaddedWindow, differentiate_windows, pad_windows
from rovsim.simulation.initial_memory import remembered_at
from rovsim.simulation.measured_states import interpolate, interpolate_state, undo_mocap_view
from rovsim.simulation.prediction import Prediction, Replay
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from rovsim.simulation.step_grid import StepGrid
from rovsim.simulation.unfiltered_motion import stage_outputs
from rovsim.simulation.unmeasured_velocities import propagate_unmeasured_velocities
from rovsim.simulation.windows import find_whole, find_windows

Spans = Sequence[tuple[int, int]]  # first sample or bin of each window, and its last one


def replay(
    model: Model,
    motion: Motion,
    settings: SimulationSettings,
    open_loop: bool = True,
) -> Replay:
    """Replay one run in windows, and in open loop as well unless told otherwise.

    The result is what the motion capture would report of the model's motion; it is NaN throughout
    for a run without usable samples.

    Args:
        model: the model to drive.
        motion: the run.
        settings: filter and derivative of the measurement, horizons, step length, and how commands
            are held.
        open_loop: whether to replay the whole run in one go, too.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    horizons = dict(by_horizon(model, motion, settings, open_loop))
    return Replay(model.name, motion.run, motion.time, horizons)


def by_horizon(
    model: Model,
    motion: Motion,
    settings: SimulationSettings,
    open_loop: bool = True,
) -> Iterator[tuple[str, Prediction]]:
    """Yield the predictions of `replay` one by one, each with the name of its horizon.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    for name, spans in find_spans(motion, settings.replay, open_loop).items():
        yield name, predict(model, motion, spans, settings)


def find_spans(
    motion: Motion, settings: ReplaySettings, open_loop: bool = True
) -> dict[str, Spans]:
    """Find the windows of each horizon, by its name: `open_loop`, `0.5`, `2`, `5`."""
    spans: dict[str, Spans] = {OPEN_LOOP: find_whole(motion)} if open_loop else {}
    for seconds in settings.horizons:
        spans[name_horizon(seconds)] = list(find_windows(motion, seconds))
    return spans


def predict(model: Model, motion: Motion, spans: Spans, settings: SimulationSettings) -> Prediction:
    """Predict what the motion capture would report of one model; see `predict_all`.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    return predict_all([ReplayCase(model, motion)], spans, settings)[0]


class ReplayCase(NamedTuple):
    """A model to be replayed along a run.

    Attributes:
        model: the model.
        motion: the run.
        disturbed: further accelerations (k, 6) over the integration steps, m/s2 and rad/s2.
    """

    model: Model
    motion: Motion
    disturbed: Array | None = None


class Anchor(NamedTuple):
    """Where a trajectory begins.

    Attributes:
        step: index of the integration step at which it begins.
        samples: length of the trajectory in sampling periods; in steps, for a binned run.
        state: true state (13,) there: pose in NED, body velocity in FRD.
    """

    step: int
    samples: int
    state: Array


def predict_all(
    cases: Sequence[ReplayCase], spans: Spans, settings: SimulationSettings
) -> list[Prediction]:
    """Predict what the motion capture would report of several models in windows of a run.

    Args:
        cases: models and runs; the runs have the same clock.
        spans: first sample or bin of each window, and its last one.
        settings: filter and derivative of the measurement, step length, how commands are held.

    Raises:
        BadInput: the run lacks what an effect of a model needs.
    """
    if not spans:
        return [Prediction.empty(len(case.motion.time)) for case in cases]
    if cases[0].motion.binned:
        return [_predict_bins(case, spans, settings.replay) for case in cases]
    return _predict_samples(cases, spans, settings)


def simulate(
    model: Model,
    motion: Motion,
    starts: Sequence[Anchor],
    settings: ReplaySettings,
    disturbed: Array | None = None,
) -> list[Array]:
    """Simulate a model from several states of one run, under its commands.

    Args:
        model: the model to drive.
        motion: the run as the model sees it, see `undo_mocap_view`.
        starts: of each trajectory, in order of time. Velocities that were not measured are replaced
            by those that the model itself reaches by then.
        settings: step length and how commands are held.
        disturbed: further accelerations (k, 6) over the integration steps, m/s2 and rad/s2.

    Returns:
        For each start the states (samples + 1, 13), of which the first is the start itself.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    grid = StepGrid.over(motion, settings.step)
    first = np.array([step for step, _, _ in starts], np.int64)
    steps = np.array([samples for _, samples, _ in starts], np.int64) * grid.stride
    state = np.array([state for _, _, state in starts]).reshape(1, -1, 13)
    memory = remembered_at([model], lambda m: motion, grid.edges, first)
    drive = drive_by_log(model, motion, grid, settings.commands)
    if disturbed is not None:
        drive = drive.with_wrench(disturbed @ model.M.T)
    batch, measured = Batch([model], motion.site), find_measured(motion.measured)
    full_starts = propagate_unmeasured_velocities(
        batch, [drive], Starts(state, first, steps, memory), grid.time, measured
    )
    return batch.trajectories([drive], full_starts, grid.time, grid.stride)[0]


def _predict_samples(
    cases: Sequence[ReplayCase], spans: Spans, settings: SimulationSettings
) -> list[Prediction]:
    """Predict at the samples of a uniform clock, through the filter of the measurement."""
    first = cases[0].motion
    signals = settings.signals.suited(first)
    windows = pad_windows(first, spans, round(signals.reach / time_step(first.time)))
    paths = [path for case in cases for path in _report_samples(case, windows, settings.replay)]
    motions = [case.motion for case in cases for _ in windows]
    derived = iter(
        zip(
            paths, differentiate_windows(paths, windows * len(cases), motions, signals), strict=True
        )
    )
    return [_gather(len(first.time), windows, islice(derived, len(windows))) for _ in cases]


def _report_samples(
    case: ReplayCase, within: Sequence[PaddedWindow], settings: ReplaySettings
) -> list[Array]:
    """Simulate each window; returns the poses (k, 7) that the motion capture would report."""
    model, motion, _ = case
    true, stride = undo_mocap_view(model, motion), StepGrid.over(motion, settings.step).stride
    state, period = true.state, time_step(motion.time)
    starts = [Anchor(w.first * stride, w.last + w.after - w.first, state[w.first]) for w in within]
    stages = stage_outputs(model, motion)[1:, :, :14]
    paths = simulate(model, true, starts, settings, case.disturbed)
    return [
        model.mocap_view.report(path, period, stages[:, w.first])[:, :7]
        for w, path in zip(within, paths, strict=True)
    ]


def _gather(
    count: int, within: Sequence[PaddedWindow], derived: Iterable[tuple[Array, Array]]
) -> Prediction:
    """Put the poses of all windows and their derivatives into one prediction at `count` samples."""
    prediction = Prediction.empty(count)
    for w, (path, (nu, nu_dot)) in zip(within, derived, strict=True):
        at, rows = slice(w.first + 1, w.last + 1), slice(1, w.last - w.first + 1)
        prediction.eta[at], prediction.nu[at], prediction.nu_dot[at] = (
            path[rows],
            nu[rows],
            nu_dot[rows],
        )
        prediction.mark_diverged(at)
    return prediction


def _predict_bins(case: ReplayCase, spans: Spans, settings: ReplaySettings) -> Prediction:
    """Predict means over the measured bins, from a trajectory on finer steps, without a filter."""
    model, motion, disturbed = case
    prediction = Prediction.empty(len(motion.time))
    true, grid = undo_mocap_view(model, motion), StepGrid.over(motion, settings.step)
    outputs, view = stage_outputs(model, motion)[1:], model.mocap_view
    bins, total = np.append(motion.time, motion.end), len(grid.edges) - 1
    first = [min(round((bins[a] - bins[0]) / grid.h), total - 1) for a, _ in spans]
    last = [min(int(np.ceil((bins[b] - bins[0]) / grid.h)), total) for _, b in spans]
    starts = [
        Anchor(k, max(e - k, 1), interpolate_state(true, grid.edges[k]))
        for k, e in zip(first, last, strict=True)
    ]
    for (a, b), (k, count, _), path in zip(
        spans, starts, simulate(model, true, starts, settings, disturbed), strict=True
    ):
        fine = grid.edges[k : k + count + 1]
        stage_start = interpolate(motion.time, outputs, grid.edges[k])
        reported = view.report(path, grid.h, stage_start, straight=True)
        means = bin_means(fine, reported, np.clip(bins[a : b + 1], fine[0], fine[-1]))
        prediction.eta[a:b] = np.hstack([means[:, :3], normalized(means[:, 3:7])])
        prediction.nu[a:b] = means[:, 7:]
        prediction.nu_dot[a:b] = backward_difference(means[:, 7:], motion.time[a:b])
        prediction.mark_diverged(slice(a, b))
    return prediction
