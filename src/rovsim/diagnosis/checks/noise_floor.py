"""The noise floor: what a perfect model would score.

Its errors come from three sources, all drawn at random here: the disturbance that pushes the
vehicle while the model does not know of it, the noise of the state it starts from, and the noise of
the velocity it is compared with, both after the filter. Level and memory are those of `noise.py`,
fitted to the train runs.
"""

from dataclasses import dataclass
from typing import Iterable, NamedTuple

import numpy as np
from numpy import ndarray as Array
from scipy.signal import lfilter

from rovsim.core import rotations
from rovsim.diagnosis.observer.drifting_current import push_by_current
from rovsim.diagnosis.observer.noise import Noise
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.observer.windows import Windows
from rovsim.dynamics.model import Model
from rovsim.evaluation.scores import Moments, normalize, root_mean
from rovsim.measurement.signals.chain import SignalSettings, velocities
from rovsim.measurement.signals.filter import filter_eta

DRAWS = 8
PAD = 1.0  # s before and after, so that the filter has settled


class NoiseFloor(NamedTuple):
    """The `windows_2s` error (see scores.normalize) of a perfect model, in so many windows."""

    error: float | None
    windows: int


def simulate_noise_floor(
    model: Model,
    runs: Iterable[ObservedRun],
    noise: Noise,
    signals: SignalSettings,
    seed: int = 0,
) -> NoiseFloor | None:
    """What a perfect model would score on these runs, of which there is one at least.

    None where only parts of the pose were measured: how their noise passes is not known here.
    """
    perfect = _PerfectModel(model, noise, signals, np.random.default_rng(seed))
    squares, count, windows, measured = np.zeros(6), 0, 0, Moments.nothing()
    for run in runs:
        if run.motion.measured is not None:
            return None
        errors = perfect.errors(run)
        squares, count = squares + np.square(errors).sum(axis=0), count + len(errors)
        windows += len(Windows(run).spans)
        measured += Moments.of(run.motion.nu[run.motion.usable])
    return NoiseFloor(normalize(measured.std, root_mean(squares, count)), windows)


@dataclass(frozen=True, eq=False)
class _PerfectModel:
    """A model to which only chance is unknown: the disturbance and the noise of the readings."""

    model: Model
    noise: Noise
    signals: SignalSettings
    random: np.random.Generator

    def errors(self, run: ObservedRun) -> Array:
        """Its errors (n, 6) on one run, all draws."""
        windows, measured = Windows(run), run.motion.state
        pushes = self._push(run)
        reported = [self._report(run) for _ in range(DRAWS)]
        truth = np.tile(measured[windows.first], (DRAWS, 1, 1))
        starts = np.array([state[windows.first] for state in reported])
        models = [self.model] * DRAWS
        happened = windows.compare(models, truth, pushes)
        predicted = windows.compare(models, starts)
        at = windows.compared
        read = np.array([state[at, 7:] - measured[at, 7:] for state in reported])
        return (predicted - happened - read).reshape(-1, 6)

    def _push(self, run: ObservedRun) -> Array:
        """Wrench (draws, k, 6) of the disturbance over the integration steps."""
        fade = np.exp(-np.diff(run.grid)[:, None] / self.noise.memory)
        kicks = self.random.normal(size=(len(fade), DRAWS, 6))
        kicks *= np.sqrt(1.0 - fade**2)[:, None]
        a, x = np.empty_like(kicks), self.random.normal(size=(DRAWS, 6))
        for k, kick in enumerate(kicks):
            x = fade[k] * x + kick
            a[k] = x
        pushed = (a * self.noise.level).swapaxes(0, 1)
        if self.noise.drift:
            pushed += self._drift(run, self.noise.drift.rate)
        return np.asarray(pushed @ self.model.body.M.T)

    def _drift(self, run: ObservedRun, rate: float) -> Array:
        """Accelerations (draws, k, 6) by a current that wanders, over the integration steps."""
        push = push_by_current(self.model, run, np.zeros((len(run.time), 2)))
        at, steps = run.grid[:-1] - run.edges[0], np.diff(run.grid)
        here = np.stack([[np.interp(at, run.time, a) for a in own.T] for own in push])  # (2, 6, k)
        began = run.motion.commands.before
        kicks = self.random.normal(size=(DRAWS, 2, len(steps)))
        kicks *= rate * np.sqrt(np.append(began, steps[:-1]))
        return np.asarray(np.einsum("dck,cik->dki", np.cumsum(kicks, axis=2), here))

    def _report(self, run: ObservedRun) -> Array:
        """States (n, 13) as another measurement of the same motion would have reported them."""
        state, reading = run.motion.state.copy(), self.noise.reading
        if run.motion.binned:
            state[:, 7:] += reading * self.random.normal(size=(len(state), 6))
            return state
        period = run.frame_period
        pad = round(PAD / period)
        # as noisy as a single frame: readings are means of a group
        kicks = np.sqrt(run.group) * reading * self.random.normal(size=(len(state) + 2 * pad, 6))
        kicks += self._err_slowly(len(kicks), period)
        poses = np.hstack([kicks[:, :3], rotations.exp(kicks[:, 3:])])  # about a vehicle at rest
        poses = self.model.mocap_view.smooth(poses, period)
        inside = slice(pad, len(poses) - pad)
        smooth = filter_eta(poses, period, self.signals.filter)[inside]
        nu, _ = velocities(poses, period, self.signals)
        state[:, :3] += rotations.rotate(state[:, 3:7], smooth[:, :3])
        state[:, 3:7] = rotations.multiply(state[:, 3:7], smooth[:, 3:])
        state[:, 7:] += nu[inside]
        return state

    def _err_slowly(self, count: int, period: float) -> Array:
        """Errors (count, 6) of the cameras that last."""
        if not self.noise.colour.any():
            return np.zeros((count, 6))
        keep = np.exp(-period / self.noise.colour_memory)
        drive = self.noise.colour * np.sqrt(1.0 - keep**2)
        kicks = self.random.normal(size=(count, 6)) * drive
        return np.stack(
            [lfilter([1.0], [1.0, -k], x) for k, x in zip(keep, kicks.T, strict=True)], 1
        )
