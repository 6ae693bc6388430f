"""The noise floor: the error that a perfect model would have.

It has three sources, which are drawn at random here: the disturbance that pushes the vehicle and
that no model knows, the noise of the measured state from which a window starts, and the noise of
the measured velocity with which the model is compared. The latter two have passed the filter of the
measurement. Sizes and correlation times are those of `noise.py`, fitted to the train runs.

Another source is not drawn: what thrusters that respond late were told before the log began. So
whether test runs are like the train runs is judged by windows that begin later.
"""

from dataclasses import dataclass
from typing import Iterable, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.model import Model
from rovsim.estimation.observer.drifting_current import differentiate_by_current
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.windows import Windows
from rovsim.evaluation.error_metrics import VelocityMoments, normalize, root_mean
from rovsim.measurement.quality.unlogged_commands import MEMORY_SECONDS
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.simulation.noise_draws import NoiseDraws

DRAWS_PER_RUN = 8  # of noise and disturbance along each test run; their errors are pooled
FORGOTTEN_SECONDS = 2.0 * MEMORY_SECONDS  # of commands before the log: five times a lag of 0.2 s


class NoiseFloor(NamedTuple):
    """The error of a perfect model in windows of 2 s, normalised by `error_metrics.normalize`.

    Attributes:
        error: in all of them; None where no axis moved.
        windows: how many there were in the runs.
        times: how many times the floor the model's error is, in windows that begin when thrusters
            have forgotten what was before the log; None where there are none.
    """

    error: float | None
    windows: int
    times: float | None


def simulate_noise_floor(
    model: Model,
    runs: Iterable[ObservedRun],
    noise: Noise,
    signals: SignalSettings,
    seed: int = 0,
) -> NoiseFloor | None:
    """Simulate the error of a perfect model.

    Args:
        model: whose motion stands for that of the vehicle.
        runs: at least one run.
        noise: disturbance, and noise of the readings.
        signals: the filter of the measurement.
        seed: of the draws.

    Returns:
        The noise floor; None where only parts of the pose were measured, as this function does not
        know how the noise of these passes the filter.
    """
    perfect = _PerfectModel(model, noise, signals, np.random.default_rng(seed))
    drawn, late, reached = _Squares.none(), _Squares.none(), _Squares.none()
    windows, moments = 0, VelocityMoments.nothing()
    for run in runs:
        if run.motion.measured is not None:
            return None
        of_run = Windows(run)
        errors, after = perfect.errors(of_run), _begin_late(of_run)
        drawn += _Squares.of(errors)
        late += _Squares.of(errors[:, after])
        reached += _Squares.of(of_run.compare([model])[:, after])
        windows += len(of_run.spans)
        moments += VelocityMoments.of(run.motion)
    floor, late_floor, error = (x.normalised(moments.std) for x in (drawn, late, reached))
    return NoiseFloor(floor, windows, error / late_floor if error and late_floor else None)


@dataclass(frozen=True, eq=False)
class _Squares:
    """Sum (6,) of squared velocity errors, and their number."""

    total: Array
    count: int

    @staticmethod
    def none() -> "_Squares":
        return _Squares(np.zeros(6), 0)

    @staticmethod
    def of(errors: Array) -> "_Squares":
        """Of errors (m, n, 6)."""
        return _Squares(np.square(errors).sum(axis=(0, 1)), errors.shape[0] * errors.shape[1])

    def __add__(self, other: "_Squares") -> "_Squares":
        return _Squares(self.total + other.total, self.count + other.count)

    def normalised(self, spread: Array) -> float | None:
        """Their root mean, see `error_metrics.normalize`."""
        return normalize(spread, root_mean(self.total, self.count)) if self.count else None


def _begin_late(windows: Windows) -> Array:
    """Mask (n,) of compared velocities in windows that begin some time after the log."""
    time, log = windows.run.motion.time, windows.run.motion.commands.time
    if not len(log):
        return np.ones(len(windows.number), bool)
    return np.asarray((time[windows.first] >= log[0] + FORGOTTEN_SECONDS)[windows.number])


@dataclass(frozen=True, eq=False)
class _PerfectModel:
    """A model that errs by chance alone: by the disturbance and the noise of the readings.

    Attributes:
        model: the model.
        noise: disturbance, and noise of the readings.
        signals: the filter of the measurement.
        random: draws both.
    """

    model: Model
    noise: Noise
    signals: SignalSettings
    random: np.random.Generator

    def errors(self, windows: Windows) -> Array:
        """Velocity errors (draws, n, 6) in the windows of one run, m/s and rad/s."""
        run, measured_state = windows.run, windows.run.motion.state
        draws = self.noise.draws(run, self.random)
        wrenches = self._draw_wrench(draws, run)
        noisy = draws.resample_measurement_noise(
            run.motion, self.model.mocap_view, self.signals, DRAWS_PER_RUN
        )
        reported = [motion.state for motion in noisy]
        truth = np.tile(measured_state[windows.first], (DRAWS_PER_RUN, 1, 1))
        starts = np.array([state[windows.first] for state in reported])
        models = [self.model] * DRAWS_PER_RUN
        actual = windows.compare(models, truth, wrenches)
        predicted = windows.compare(models, starts)
        at = windows.compared
        reading_errors = np.array([state[at, 7:] - measured_state[at, 7:] for state in reported])
        return np.asarray(predicted - actual - reading_errors)

    def _draw_wrench(self, draws: NoiseDraws, run: ObservedRun) -> Array:
        """Draw the disturbance of k integration steps: a wrench (draws, k, 6), N and N m."""
        disturbance = draws.draw_disturbance(np.diff(run.grid), DRAWS_PER_RUN)
        if self.noise.drift:
            disturbance += self._drift(run, self.noise.drift.rate)
        return np.asarray(disturbance @ self.model.M.T)

    def _drift(self, run: ObservedRun, rate: float) -> Array:
        """Draw a wandering current: its accelerations (draws, k, 6), m/s2 and rad/s2.

        The current is a random walk in the horizontal plane, whose `rate` is the standard deviation
        in m/s after 1 s.
        """
        per_current = differentiate_by_current(self.model, run, np.zeros((len(run.time), 2)))
        at, steps = run.grid[:-1] - run.edges[0], np.diff(run.grid)
        response = np.stack(
            [[np.interp(at, run.time, a) for a in p.T] for p in per_current]
        )  # (2, 6, k)
        lead = run.motion.commands.before
        kicks = self.random.normal(size=(DRAWS_PER_RUN, 2, len(steps)))
        kicks *= rate * np.sqrt(np.append(lead, steps[:-1]))
        return np.asarray(np.einsum("dck,cik->dki", np.cumsum(kicks, axis=2), response))
