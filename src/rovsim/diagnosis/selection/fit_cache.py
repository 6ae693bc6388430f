"""Fits under one noise, each of which is made only once."""

from dataclasses import dataclass, field

import numpy as np

from rovsim.estimation.fit import Fit, fit, fit_or_give_up
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.noise import Noise


@dataclass(frozen=True, eq=False)
class FitCache:
    """Fits by their start and the prior about it, all with the same filters and the same noise.

    Attributes:
        bank: the runs, and the filters.
        noise: under which the fits are made.
    """

    bank: FilterBank
    noise: Noise
    _fitted: dict[tuple, Fit] = field(default_factory=dict)
    _given_up: dict[tuple, float] = field(default_factory=dict)

    def fit(self, start: Hypothesis, prior_std: float) -> Fit:
        """Fit a hypothesis, as `estimation.fit` does."""
        key = start.key, prior_std
        if key not in self._fitted:
            self._fitted[key] = fit(start, self.bank, self.noise, prior_std)
        return self._fitted[key]

    def fit_or_give_up(
        self, start: Hypothesis, current: Fit, least: float, prior_std: float
    ) -> Fit | None:
        """As `fit`, but None as soon as `two_log_likelihood` is not expected to reach `least`.

        Args:
            start: the hypothesis to fit.
            current: a fit whose derivatives are taken at first, as far as they have the same
                parameters.
            least: what is to be reached.
            prior_std: see `estimation.fit`.
        """
        key = start.key, prior_std
        if key not in self._fitted and least < self._given_up.get(key, np.inf):
            linearised = self.bank.linearise(start, current.linearised)
            result = fit_or_give_up(linearised, self.bank, self.noise, least, prior_std)
            if result is None:
                self._given_up[key] = least
            else:
                self._fitted[key] = result
        return self._fitted.get(key)

    def has_fitted(self, start: Hypothesis) -> bool:
        """Whether that start was fitted already, without a prior."""
        return (start.key, np.inf) in self._fitted
