"""Disturbances that last: what pushes the vehicle for long in the train runs, beyond the model.

The disturbance that `noise.py` fits has a correlation time of 3 s at most, and no mean. So it does
not predict a force that lasts (a buoyancy, a current, drag that the model lacks). Such forces are
estimated here: an observer with a much longer correlation time follows the runs, and its estimates
are averaged over blocks. If the short disturbance does not explain the mean of the blocks, or their
spread, a lasting disturbance is the cause.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core import gauss_markov
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.innovations import observe
from rovsim.estimation.observer.kalman import AxisErrorDynamics
from rovsim.estimation.observer.noise import Noise, RunFilters, design_filters
from rovsim.estimation.observer.observed_run import BLOCK_SECONDS, ObservedRun, number_blocks

OBSERVER_MEMORY_SECONDS = 100.0  # of its disturbance: longer than any block
MIN_STANDARD_ERRORS = 2.0  # less may be the short disturbance
# Times what passes by in a block, and standard errors: beyond both the model errs.
MIN_NOISE_RATIO, CERTAIN_STANDARD_ERRORS = 2.0, 3.0


@dataclass(frozen=True, eq=False)
class LowFrequencyDisturbance:
    """A lasting disturbance: accelerations (6,) in the body's axes, m/s2 and rad/s2.

    Attributes:
        mean: the part that lasts as long as a flight.
        spread: standard deviation of a part that lasts about as long as a block.
        large: (6,) axes on which the mean surely is larger than what the short disturbance does to
            the mean of a block.
    """

    mean: Array
    spread: Array
    large: Array

    @staticmethod
    def none() -> "LowFrequencyDisturbance":
        """No lasting disturbance."""
        return LowFrequencyDisturbance(np.zeros(6), np.zeros(6), np.zeros(6, bool))

    @staticmethod
    def of_blocks(blocks: Array, seconds: float, noise: Noise) -> "LowFrequencyDisturbance":
        """Estimate it from the mean disturbances (b, 6) of b blocks of `seconds` each.

        `noise` says what the short disturbance alone would do to such means.
        """
        if not len(blocks):
            return LowFrequencyDisturbance.none()
        noise_std = noise.disturbance_std * np.sqrt(
            gauss_markov.variance_of_mean(noise.correlation_time / seconds)
        )
        count, mean = len(blocks), blocks.mean(axis=0)
        error = noise_std / np.sqrt(count)
        variance = blocks.var(axis=0, ddof=1) if count > 1 else np.zeros(6)
        # a variance of n + 1 normal numbers has a standard error of sqrt(2 / n) times itself
        limit = noise_std**2 * (1.0 + MIN_STANDARD_ERRORS * np.sqrt(2.0 / max(count - 1, 1)))
        return LowFrequencyDisturbance(
            np.where(np.abs(mean) > MIN_STANDARD_ERRORS * error, mean, 0.0),
            np.sqrt(np.where(variance > limit, variance - noise_std**2, 0.0)),
            np.abs(mean) > np.maximum(MIN_NOISE_RATIO * noise_std, CERTAIN_STANDARD_ERRORS * error),
        )

    def draw(self, steps: int, h: float, random: np.random.Generator) -> Array:
        """Draw accelerations (steps, 6) over steps of h s."""
        return self.mean + self.spread * gauss_markov.draw(steps, h / BLOCK_SECONDS, random)


def estimate_disturbance(
    model: Model,
    runs: Sequence[ObservedRun],
    noise: Noise,
    error_dynamics: Sequence[AxisErrorDynamics],
) -> LowFrequencyDisturbance:
    """Estimate the lasting disturbance in the train runs that a model lacks.

    Args:
        model: fitted to them.
        runs: the train runs.
        noise: of the readings, and the short disturbance.
        error_dynamics: how an error of the model grows or decays on each of the six axes.
    """
    slow = Noise(noise.disturbance_std, np.full(6, OBSERVER_MEMORY_SECONDS), noise.measurement_std)
    blocks: list[Array] = []
    for run in runs:
        blocks += _average(
            run, _estimate_at_readings(model, run, design_filters(slow, error_dynamics, run))
        )
    return LowFrequencyDisturbance.of_blocks(
        np.array(blocks) * model.body.free, BLOCK_SECONDS, noise
    )


def _estimate_at_readings(model: Model, run: ObservedRun, filters: RunFilters) -> Array:
    """The disturbance (n, 6) that the filters estimate at the readings, m/s2 and rad/s2."""
    e = np.nan_to_num(observe([model], run, filters)[0])
    force, decay = np.zeros(e.T.shape), filters.decay(np.array([run.period]))[0]
    for first, last in run.innovation_segments:
        for i, gain in enumerate(filters.gains[2]):
            force[first:last, i] = scipy.signal.lfilter([gain], [1.0, -decay[i]], e[i, first:last])
    return force


def _average(run: ObservedRun, disturbance: Array) -> list[Array]:
    """Means (6,) of a push (n, 6) over blocks; those shorter than half a block are left out."""
    settled, number = disturbance[run.settled], number_blocks([run])
    blocks = (settled[number == k] for k in np.unique(number))
    return [block.mean(axis=0) for block in blocks if len(block) * run.period > 0.5 * BLOCK_SECONDS]
