"""Replay: drive a model with the logged commands, from measured states.

Open loop starts once and is never corrected; windows of h seconds start anew every h. What comes
back is aligned with the measurement and went through the same filter.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array
from pydantic import PositiveFloat

from rovsim.core.files import read_arrays, write_arrays
from rovsim.core.rotations import normalized
from rovsim.core.run import RunInfo
from rovsim.core.schema import Section, checked
from rovsim.dynamics.actuation import Between, Thrust
from rovsim.dynamics.engine.parallel import run_jobs
from rovsim.dynamics.engine.types import Inputs, Jobs, Place
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.binned import backward_difference, bin_means
from rovsim.measurement.signals.chain import SignalSettings, velocities
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.initial_memory import measured_memory

OPEN_LOOP = "open_loop"


class ReplaySettings(Section):
    """`step` s is the longest integration step; `commands` between two logged lines."""

    step: PositiveFloat = 0.01  # RK4's error is below 1e-6 m/s here (tests/laws/test_replay.py)
    commands: Between = "held"  # what an autopilot does with a set-point
    horizons: tuple[PositiveFloat, ...] = (0.5, 2.0, 5.0)  # s, contract section 3


def rule_settings(given: Mapping[str, Any]) -> tuple[SignalSettings, ReplaySettings]:
    """How motions were made and are replayed, from the parameters of a rule.

    Raises:
        BadInput: one of them does not fit.
    """
    signals = checked(SignalSettings, given["signals"], "conf")
    return signals, checked(ReplaySettings, given["replay"], "conf")


@dataclass(frozen=True, eq=False)
class Prediction:
    """What a model predicts at motion.time: NaN where nothing, infinite once it diverged.

    `eta` (n, 7) pose, `nu` (n, 6) velocity, `nu_dot` (n, 6) acceleration, after the filter.
    """

    eta: Array
    nu: Array
    nu_dot: Array


@dataclass(frozen=True, eq=False)
class Replay:
    """Predictions of one model for one run, by horizon: `open_loop`, `0.5`, `2`, `5`."""

    model: str
    run: RunInfo
    time: Array
    horizons: dict[str, Prediction]

    def write(self, path: Path) -> None:
        """Write to `.npz`."""
        arrays = {
            f"{horizon}/{name}": getattr(prediction, name)
            for horizon, prediction in self.horizons.items()
            for name in ("eta", "nu", "nu_dot")
        }
        label = np.array([self.model, self.run.id, self.run.control, self.run.split])
        write_arrays(path, label=label, time=self.time, **arrays)

    @staticmethod
    def read(path: Path) -> "Replay":
        """Read what `write` wrote."""
        a = read_arrays(path)
        model, *run = (str(s) for s in a["label"])
        names = dict.fromkeys(key.split("/")[0] for key in a if "/" in key)
        horizons = {h: Prediction(a[f"{h}/eta"], a[f"{h}/nu"], a[f"{h}/nu_dot"]) for h in names}
        return Replay(model, RunInfo(*run), a["time"], horizons)


@dataclass(frozen=True, eq=False)
class Clock:
    """The integration steps of one run: `edges` (k+1,) s, `stride` steps a sample."""

    edges: Array
    stride: int

    @property
    def h(self) -> float:
        """Step length in s."""
        return float(self.edges[1] - self.edges[0])


def clock(motion: Motion, step: float) -> Clock:
    """Steps no longer than `step`; those of a sampled run meet its samples."""
    if motion.binned:
        count = int(np.ceil((motion.end - motion.time[0]) / step - 1e-9))
        return Clock(motion.time[0] + step * np.arange(count + 1), 1)
    period = float(motion.time[1] - motion.time[0])
    stride = int(np.ceil(period / step - 1e-9))
    h, count = period / stride, (len(motion.time) - 1) * stride
    return Clock(motion.time[0] + h * np.arange(count + 1), stride)


def inputs(model: Model, motion: Motion, edges: Array, between: Between) -> Inputs:
    """Thrust of one model over each step, as the engine takes it.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    model.check(motion.site, motion.commands.kind)
    thrust = model.thrust_path.over_steps(motion.commands, edges, between)
    return packed_inputs(model, thrust, float(edges[-1] - edges[0]))


def packed_inputs(model: Model, thrust: Thrust, duration: float) -> Inputs:
    """Wrench, force and demand of one parameter set, stacked for the engine."""
    wrench = thrust.wrench + model.actuated(thrust.force, thrust.demand)
    steps = len(wrench)
    return Inputs(
        wrench[None], thrust.force[None], thrust.demand, np.zeros(1, np.int64),
        np.full(steps, duration),
    )  # fmt: skip


def stacked(parts: Sequence[Inputs], row: Sequence[int]) -> Inputs:
    """Inputs of several thrust paths over the same steps; `row` (m,): which of them a model has."""
    wrench = np.concatenate([one.wrench for one in parts])
    force = np.concatenate([one.force for one in parts])
    return parts[0]._replace(wrench=wrench, force=force, row=np.array(row, np.int64))


def place(motion: Motion) -> Place:
    """The site of a run, as the engine takes it."""
    return Place(np.ascontiguousarray(motion.site.tank), np.ascontiguousarray(motion.site.axes))


def trajectories(
    model: Model,
    motion: Motion,
    starts: Sequence[tuple[float, int, Array]],
    settings: ReplaySettings,
) -> list[Array]:
    """Simulate from several true states of one run.

    Args:
        model: the model to drive.
        motion: the run, whose commands drive it.
        starts: for each trajectory its first step, number of samples, and state (13,).
        settings: step length and how commands are held.

    Returns:
        For each start its states (samples + 1, 13), the given one first.
    """
    steps = clock(motion, settings.step)
    first = np.array([s[0] for s in starts], np.int64)
    samples = np.array([s[1] for s in starts], np.int64)
    rows = np.concatenate([[0], np.cumsum(samples)])
    states, remembered = (
        np.array([s[2] for s in starts]),
        measured_memory(model, motion, steps.edges),
    )
    jobs = Jobs(
        states, first * steps.h, first, samples * steps.stride,
        np.zeros(len(starts), np.int64), rows[:-1],
        remembered[first] if remembered.size else remembered,
    )  # fmt: skip
    out = np.empty((rows[-1], 13))
    run_jobs(
        model.engine.integrate, jobs, steps.h, steps.stride, model.constants,
        inputs(model, motion, steps.edges, settings.commands), model.wrench_parameters()[None],
        residual_data(model), place(motion), out,
    )  # fmt: skip
    return [
        np.vstack([state, out[a:b]])
        for state, a, b in zip(states, rows[:-1], rows[1:], strict=True)
    ]


def residual_data(model: Model) -> Array:
    """The trained residual as one flat array, empty without one."""
    return model.residual.data if model.residual else np.empty(0)


def replay(
    model: Model, motion: Motion, signals: SignalSettings, settings: ReplaySettings,
    open_loop: bool = True,
) -> Replay:  # fmt: skip
    """Replay one run open loop, unless that is not wanted, and in windows.

    What comes back is what the motion capture would report of the model's motion. An unusable run
    predicts nothing.
    """
    true = as_true(model, motion)
    spans = {OPEN_LOOP: _whole(motion)} if open_loop else {}
    for seconds in settings.horizons:
        spans[f"{seconds:g}"] = list(windows(motion, seconds))
    predict = _predict_bins if motion.binned else _predict_samples
    horizons = {
        name: predict(model, true, found, signals, settings) for name, found in spans.items()
    }
    return Replay(model.name, motion.run, motion.time, horizons)


def as_true(model: Model, motion: Motion) -> Motion:
    """The motion behind the reported one, if the motion capture sees as the model says."""
    back = model.mocap_view.inverse
    return motion if back.identity else replace(
        motion, eta=back.poses(motion.eta), nu=back.twists(motion.nu),
        nu_dot=back.twists(motion.nu_dot), state_nu=back.twists(motion.state_nu),
    )  # fmt: skip


def _whole(motion: Motion) -> list[tuple[int, int]]:
    """From the first usable sample to the last sample, once."""
    last = len(motion.time) - (0 if motion.binned else 1)
    return [(first, last) for first, _ in motion.segments()[:1] if first < last]


def windows(motion: Motion, seconds: float) -> Iterator[tuple[int, int]]:
    """Index pairs (anchor, end) of full windows inside usable stretches.

    Sampled: predictions are anchor+1 .. end. Binned: bins anchor .. end-1, whose number follows the
    uneven clock: the next window starts at the bin that begins nearest to `seconds` later.
    """
    for first, last in motion.segments():
        if motion.binned:
            yield from _bin_windows(motion, first, last, seconds)
            continue
        count = round(seconds / float(motion.time[1] - motion.time[0]))
        for anchor in range(first, last - count, count):
            yield anchor, anchor + count


def _bin_windows(
    motion: Motion, first: int, last: int, seconds: float
) -> Iterator[tuple[int, int]]:
    starts = np.append(motion.time, motion.end)[: last + 1]
    anchor = first
    while starts[last] - starts[anchor] >= 0.75 * seconds:
        end = anchor + 1 + int(np.argmin(np.abs(starts[anchor + 1 :] - starts[anchor] - seconds)))
        yield anchor, end
        if end >= last:
            return
        anchor = end


def _empty(motion: Motion) -> Prediction:
    n = len(motion.time)
    return Prediction(np.full((n, 7), np.nan), np.full((n, 6), np.nan), np.full((n, 6), np.nan))


def _predict_samples(model, motion, spans, signals, settings) -> Prediction:
    """Predictions at the samples of a uniform clock, through the filter of the measurement."""
    found = _empty(motion)
    if not spans:
        return found
    stride, period = clock(motion, settings.step).stride, float(motion.time[1] - motion.time[0])
    state = motion.state
    starts = [(a * stride, b - a, state[a]) for a, b in spans]
    paths = model.mocap_view.states(np.stack(trajectories(model, motion, starts, settings)))
    nu, nu_dot = np.full((2, *paths.shape[:-1], 6), np.inf)
    stayed = np.isfinite(paths).all(axis=(1, 2))
    if stayed.any():
        nu[stayed], nu_dot[stayed] = velocities(paths[stayed, :, :7], period, signals)
    for i, (a, b) in enumerate(spans):
        at = slice(a + 1, b + 1)
        found.eta[at], found.nu[at], found.nu_dot[at] = paths[i, 1:, :7], nu[i, 1:], nu_dot[i, 1:]
        _mark_diverged(found, at)
    return found


def _predict_bins(model, motion, spans, signals, settings) -> Prediction:
    """Means over the measurement's own bins, of a trajectory on fine steps; nothing is filtered."""
    found = _empty(motion)
    steps = clock(motion, settings.step)
    starts, ends = np.append(motion.time, motion.end), len(steps.edges) - 1
    first = [min(round((starts[a] - starts[0]) / steps.h), ends - 1) for a, _ in spans]
    last = [min(int(np.ceil((starts[b] - starts[0]) / steps.h)), ends) for _, b in spans]
    jobs = [
        (k, max(e - k, 1), state_at(motion, steps.edges[k]))
        for k, e in zip(first, last, strict=True)
    ]
    for (a, b), (k, count, _), path in zip(
        spans, jobs, trajectories(model, motion, jobs, settings) if jobs else [], strict=True
    ):
        fine = steps.edges[k : k + count + 1]
        edges = np.clip(starts[a : b + 1], fine[0], fine[-1])
        means = bin_means(fine, model.mocap_view.states(path), edges)
        found.eta[a:b] = np.hstack([means[:, :3], normalized(means[:, 3:7])])
        found.nu[a:b] = means[:, 7:]
        found.nu_dot[a:b] = backward_difference(means[:, 7:], motion.time[a:b])
        _mark_diverged(found, slice(a, b))
    return found


def _mark_diverged(found: Prediction, at: slice) -> None:
    """Infinite where the model left the finite numbers, so that no score passes over it."""
    lost = ~np.isfinite(found.nu[at]).all(axis=1)
    for values in (found.eta, found.nu, found.nu_dot):
        values[at][lost] = np.inf


def state_at(motion: Motion, time: float) -> Array:
    """State between two bin starts, linearly."""
    k = int(np.clip(np.searchsorted(motion.time, time) - 1, 0, len(motion.time) - 2))
    share = (time - motion.time[k]) / (motion.time[k + 1] - motion.time[k])
    state = (1.0 - share) * motion.state[k] + share * motion.state[k + 1]
    state[3:7] = normalized(state[3:7])
    return state
