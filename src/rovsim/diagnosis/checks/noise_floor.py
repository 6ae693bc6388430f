"""The noise floor: what a perfect model would score.

Its errors come from three sources, all drawn at random here: the disturbance that pushes the
vehicle while the model does not know of it, the noise of the state it starts from, and the noise of
the velocity it is compared with, both after the filter. Sizes and correlation time are those of
`noise.py`, fitted to the train runs.
"""

from dataclasses import dataclass
from typing import Iterable, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.model import Model
from rovsim.estimation.observer.drifting_current import push_by_current
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.windows import Windows
from rovsim.evaluation.scores import Moments, normalize, root_mean
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.simulation.noise_draws import NoiseDraws

DRAWS = 8  # of noise and disturbance, along all test runs; their errors are pooled


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
        measured += Moments.of(run.motion)
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
        draws = self.noise.draws(run, self.random)
        pushes = self._push(draws, run)
        again = draws.resample_measurement_noise(
            run.motion, self.model.mocap_view, self.signals, DRAWS
        )
        reported = [motion.state for motion in again]
        truth = np.tile(measured[windows.first], (DRAWS, 1, 1))
        starts = np.array([state[windows.first] for state in reported])
        models = [self.model] * DRAWS
        happened = windows.compare(models, truth, pushes)
        predicted = windows.compare(models, starts)
        at = windows.compared
        read = np.array([state[at, 7:] - measured[at, 7:] for state in reported])
        return (predicted - happened - read).reshape(-1, 6)

    def _push(self, draws: NoiseDraws, run: ObservedRun) -> Array:
        """Wrench (draws, k, 6) of the disturbance over the integration steps."""
        pushed = draws.draw_disturbance(np.diff(run.grid), DRAWS)
        if self.noise.drift:
            pushed += self._drift(run, self.noise.drift.rate)
        return np.asarray(pushed @ self.model.M.T)

    def _drift(self, run: ObservedRun, rate: float) -> Array:
        """Accelerations (draws, k, 6) by a current that wanders, over the integration steps."""
        push = push_by_current(self.model, run, np.zeros((len(run.time), 2)))
        at, steps = run.grid[:-1] - run.edges[0], np.diff(run.grid)
        here = np.stack([[np.interp(at, run.time, a) for a in own.T] for own in push])  # (2, 6, k)
        began = run.motion.commands.before
        kicks = self.random.normal(size=(DRAWS, 2, len(steps)))
        kicks *= rate * np.sqrt(np.append(began, steps[:-1]))
        return np.asarray(np.einsum("dck,cik->dki", np.cumsum(kicks, axis=2), here))
