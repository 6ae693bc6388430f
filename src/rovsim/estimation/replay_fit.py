"""Fit the values with which a model replays best, for a model that is known to be incomplete.

The likelihood of the innovations takes everything that is left for noise. Where unknown physics is
left, its disturbance absorbs slow errors, and the values that predict the next reading best make a
replay drift away. So the values are fitted once more to what users see: velocity and acceleration
in windows. How sure they are is then taken from how much the windows disagree, not from the noise
(sandwich.py, with windows as clusters).
"""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.threads import map_on_cores
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import PRIOR_STD, Fit, fit_noise_only
from rovsim.estimation.levenberg_marquardt import levenberg_marquardt
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.residual_source import Linearised, evaluate_possible, linearise
from rovsim.estimation.observer.sandwich import estimate_covariance_of_few
from rovsim.estimation.observer.windows import Windows
from rovsim.estimation.prior import Prior

WINDOW_SECONDS = 10.0  # twice the longest horizon of the contract: the open loop is judged as well
MIN_SPREAD = 1e-3  # m/s, rad/s (and per s): an axis that hardly moves does not count


@dataclass(frozen=True, eq=False)
class Replays:
    """Errors of velocity and acceleration of replays, each over its standard deviation.

    The replays start from the measured state in every window.
    """

    runs: tuple[ObservedRun, ...]

    @cached_property
    def windows(self) -> list[Windows]:
        """The windows of each run."""
        return [Windows(run, WINDOW_SECONDS) for run in self.runs]

    @cached_property
    def spread(self) -> tuple[Array, Array]:
        """Standard deviations (6,) of the measured velocity and of the measured acceleration."""
        nu = np.concatenate([run.motion.nu[run.motion.usable] for run in self.runs])
        nu_dot = np.concatenate([run.motion.nu_dot[run.motion.usable] for run in self.runs])
        return np.maximum(np.std(nu, axis=0), MIN_SPREAD), np.maximum(
            np.nanstd(nu_dot, axis=0), MIN_SPREAD
        )

    def evaluate(self, models: Sequence[Model]) -> list[Array]:
        """Scaled errors (m, 6, n) of m models on each run; NaN for models that are impossible."""

        def of_run(windows: Windows) -> Array:
            count = len(windows.number) + int(np.sum(_follows(windows)))
            return evaluate_possible(models, count, partial(self._compare, windows))

        return map_on_cores(of_run, self.windows)

    def _compare(self, windows: Windows, models: Sequence[Model]) -> Array:
        velocity, acceleration = self.spread
        nu, time = windows.compare(models), windows.run.motion.time[windows.compared]
        step = np.diff(nu, axis=1) / np.diff(time)[:, None]
        errors = [nu / velocity, step[:, _follows(windows)] / acceleration]
        return soften(np.concatenate(errors, axis=1)).swapaxes(1, 2)

    def linearise(self, at: Hypothesis) -> Linearised:
        """Errors of a hypothesis, and their derivatives to its parameters."""
        return linearise(at, self.evaluate)

    def whiten(self, e: Sequence[Array], noise: Noise) -> Array:
        """Errors (..., 6, n) of all runs, one run after the other; `noise` plays no part."""
        return np.concatenate(e, axis=-1)

    def number(self) -> Array:
        """Number (n,) of the window that each error belongs to, counted over all runs."""
        parts, count = [], 0
        for windows in self.windows:
            numbers = windows.number + count
            parts += [numbers, numbers[1:][_follows(windows)]]
            count = int(numbers.max(initial=count - 1)) + 1
        return np.concatenate(parts)


def _follows(windows: Windows) -> Array:
    """For each velocity but the first (n-1,), whether it is in the window of the one before."""
    return np.diff(windows.number) == 0


def soften(x: Array) -> Array:
    """Limit the influence of large errors: their squares then grow like |x| (soft L1).

    Triggs et al. 2000, Bundle Adjustment - A Modern Synthesis.
    """
    return np.sign(x) * np.sqrt(2.0 * (np.sqrt(1.0 + x**2) - 1.0))


def fit_to_replays(fit: Fit, bank: FilterBank) -> Fit:
    """Fit the parameters of a hypothesis to replays.

    Args:
        fit: of the innovations; its values are the start.
        bank: the runs, and the filters of that fit.

    Returns:
        The hypothesis at the values that replay best, with their covariance, and the noise that
        its innovations then have.
    """
    source = Replays(bank.runs)
    linearised = _fit(fit, source)
    covariance = estimate_covariance_of_few(
        source.whiten(linearised.e, fit.noise),
        source.whiten(linearised.J, fit.noise),
        source.number(),
    )
    fresh = bank.redesign(linearised.hypothesis.model, fit.noise)
    observed = fit_noise_only(fresh.linearise(linearised.hypothesis), fresh, fit.noise)
    return replace(observed, covariance=covariance)


def fit_without(fit: Fit, runs: Sequence[ObservedRun], left_out: Sequence[ObservedRun]) -> Model:
    """The model of a fit at the values that replay all runs best but those that are left out."""
    kept_runs = tuple(run for run in runs if all(run is not r for r in left_out))
    return _fit(fit, Replays(kept_runs)).hypothesis.model


def _fit(fit: Fit, source: Replays) -> Linearised:
    prior = Prior.around(fit.hypothesis.x, PRIOR_STD)
    return levenberg_marquardt(fit.hypothesis, source, fit.noise, prior)
