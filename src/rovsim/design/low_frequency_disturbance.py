"""What disturbs the vehicle for long in the train runs, and the model does not know of.

The disturbance that `noise.py` fits remembers 3 s at most and has no mean: a force that lasts (a
buoyancy, a current, drag that the model lacks) would not be foreseen. Here it is measured: an
observer whose disturbance hardly forgets follows the runs, and its estimates are averaged over
blocks. A mean that the short disturbance does not explain lasts, and so does such a spread.
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
from rovsim.estimation.observer.observed_run import BLOCK, ObservedRun, number_blocks

LASTING = 100.0  # s, memory of the observer's disturbance: longer than any block
CHANCE = 2.0  # standard errors: less is not told from the short disturbance
LARGE, SURE = 2.0, 3.0  # of what passes by in a block, and standard errors: the model errs


@dataclass(frozen=True, eq=False)
class LowFrequencyDisturbance:
    """Accelerations per axis, m/s2 and rad/s2, in the body's axes.

    `mean` (6,) lasts as long as a flight, a part of size `spread` (6,) about a block. `large`
    (6,): axes along which the mean is more than what passes by in a block, and surely so.
    """

    mean: Array
    spread: Array
    large: Array

    @staticmethod
    def none() -> "LowFrequencyDisturbance":
        """Of a model to which nothing is unknown but the short disturbance."""
        return LowFrequencyDisturbance(np.zeros(6), np.zeros(6), np.zeros(6, bool))

    @staticmethod
    def of_blocks(blocks: Array, seconds: float, noise: Noise) -> "LowFrequencyDisturbance":
        """What lasts, of the mean disturbances (b, 6) of blocks of so many seconds each."""
        if not len(blocks):
            return LowFrequencyDisturbance.none()
        chance = noise.disturbance_std * np.sqrt(
            gauss_markov.variance_of_mean(noise.correlation_time / seconds)
        )
        count, mean = len(blocks), blocks.mean(axis=0)
        error = chance / np.sqrt(count)
        varied = blocks.var(axis=0, ddof=1) if count > 1 else np.zeros(6)
        # of a variance of n + 1 numbers by chance: a standard error is sqrt(2 / n) of it
        usual = chance**2 * (1.0 + CHANCE * np.sqrt(2.0 / max(count - 1, 1)))
        return LowFrequencyDisturbance(
            np.where(np.abs(mean) > CHANCE * error, mean, 0.0),
            np.sqrt(np.where(varied > usual, varied - chance**2, 0.0)),
            np.abs(mean) > np.maximum(LARGE * chance, SURE * error),
        )

    def draw(self, steps: int, h: float, random: np.random.Generator) -> Array:
        """Accelerations (steps, 6) over steps of h s."""
        return self.mean + self.spread * gauss_markov.draw(steps, h / BLOCK, random)


def estimate_disturbance(
    model: Model,
    runs: Sequence[ObservedRun],
    noise: Noise,
    error_dynamics: Sequence[AxisErrorDynamics],
) -> LowFrequencyDisturbance:
    """What pushes the vehicle for long in the train runs, and a model does not know of.

    Args:
        model: fitted to them.
        runs: the train runs.
        noise: of the readings, and the short disturbance.
        error_dynamics: how errors of the six axes go on.
    """
    slow = Noise(noise.disturbance_std, np.full(6, LASTING), noise.measurement_std)
    blocks: list[Array] = []
    for run in runs:
        blocks += _average(run, _follow(model, run, design_filters(slow, error_dynamics, run)))
    return LowFrequencyDisturbance.of_blocks(np.array(blocks) * model.body.free, BLOCK, noise)


def _follow(model: Model, run: ObservedRun, filters: RunFilters) -> Array:
    """The disturbance (n, 6) that an observer finds at the readings."""
    e = np.nan_to_num(observe([model], run, filters)[0])
    found, decay = np.zeros(e.T.shape), filters.decay(np.array([run.period]))[0]
    for first, last in run.innovation_segments:
        for i, gain in enumerate(filters.gains[2]):
            found[first:last, i] = scipy.signal.lfilter([gain], [1.0, -decay[i]], e[i, first:last])
    return found


def _average(run: ObservedRun, push: Array) -> list[Array]:
    """Means (6,) over blocks of at least half of the usual length."""
    settled, number = push[run.settled], number_blocks([run])
    parts = (settled[number == k] for k in np.unique(number))
    return [own.mean(axis=0) for own in parts if len(own) * run.period > 0.5 * BLOCK]
