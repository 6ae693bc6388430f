"""Judge a special effect beside a loose vehicle file, of which any value may be wrong.

Where several file effects were accepted, other values of the file are wrong, too, mostly by too
little to be found. A dozen such values, none of them worth its penalty, may together explain what a
special effect seems to explain. So there a special effect is judged to first order with all values
of the file free, as far as such files are off (`estimation/file_effects.py`). If the file explains
it, the values are looked for together: linear and quadratic drag of opposite sign look like
friction, and neither explains anything by itself.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.odds import lr_statistic_of
from rovsim.diagnosis.selection.workspace import HOPELESS_LR, SearchWorkspace
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.estimation.candidates import Candidate
from rovsim.estimation.file_effects import (
    FILE_EFFECT_IDS,
    ONE_GAIN,
    has_loose_file,
    spread_of_file,
)
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.least_squares import eliminate_columns, solve

# Prior odds: each of some thirty special effects is missing in one of thirty cases, whereas a value
# of a loose file is wrong in any case.
PRIOR_ODDS_LR = lr_statistic_of(odds=1000.0)


class FileNumber(NamedTuple):
    """A value of the vehicle file, as a parameter of a candidate.

    Attributes:
        candidate: the file effect.
        parameter: its name.
        row: of the parameter in the workspace's Gram matrix.
        spread: how far the file may be off, in scales.
    """

    candidate: Candidate
    parameter: str
    row: int
    spread: float


class Contender(NamedTuple):
    """A fit, and the term of it that competes for a place."""

    fit: Fit
    term: Term


@dataclass(frozen=True, eq=False)
class LooseFile:
    """A vehicle file of which any value may be wrong, beside the fits of a workspace."""

    workspace: SearchWorkspace

    @cached_property
    def numbers(self) -> list[FileNumber]:
        """All values that may be wrong."""
        base, numbers = self.workspace.sensitivities.base_model, []
        for block in self.workspace.sensitivities.blocks:
            effect = block.candidate.effect
            if not block.candidate.absent or effect.id not in FILE_EFFECT_IDS:
                continue
            pairs = zip(block.derivatives, block.candidate.term().parameters, strict=True)
            for column, parameter in pairs:
                # the gain of a single thruster is a fault of that thruster, not of the file
                if effect.id != ThrusterGain.id or parameter.name in ONE_GAIN:
                    spread = spread_of_file(base, effect, parameter)
                    numbers.append(FileNumber(block.candidate, parameter.name, 1 + column, spread))
        return numbers

    @cached_property
    def _rows(self) -> list[int]:
        return [number.row for number in self.numbers]

    @cached_property
    def _spread(self) -> Array:
        return np.array([number.spread for number in self.numbers])

    def measure_cost(self, fit: Fit) -> float:
        """The sum of squares that a fit leaves with all values of the file free, to first order."""
        return self._cost_at(self.workspace.columns.gram(fit.linearised))

    def _cost_at(self, G: Array) -> float:
        return cost_within(G, self._rows, self._spread)

    def measure_doubt(self, fit: Fit) -> float:
        """How much likelier a loose file is than a right one, beside the effects of a fit.

        Twice the log of the Bayes factor, to first order, with all values of the file as uncertain
        as such files are. Each value that does not need to change counts against it.
        """
        G, spread = self.workspace.columns.gram(fit.linearised), self._spread
        H = G[np.ix_(self._rows, self._rows)]
        log_det = float(np.linalg.slogdet(np.eye(len(H)) + spread[:, None] * H * spread)[1])
        return float(G[0, 0]) - self._cost_at(G) - log_det

    def measure_loss(self, fit: Fit, term: Term) -> float:
        """By how much the sum of squares grows without one term of a fit, beside a loose file."""
        gram = self.workspace.first_order.gram_without(fit, term)
        return self._cost_at(gram) - self.measure_cost(fit)

    def find_limit(self, term: Term) -> float:
        """The least loss that justifies a term beside a loose file; 0 for a file effect."""
        if term.id in FILE_EFFECT_IDS:
            return 0.0
        return self.workspace.penalty * term.choices + PRIOR_ODDS_LR

    def explains(self, fit: Fit, name: str, without: Fit | None = None) -> bool:
        """Whether all of the file together explains what a special effect of a fit does.

        `without`: the fit without that effect; if none is given, it is made to first order.
        """
        if name in FILE_EFFECT_IDS:
            return False
        term = next(t for t in fit.hypothesis.terms if t.id == name)
        loss = (
            self.measure_loss(fit, term)
            if without is None
            else self.measure_cost(without) - self.measure_cost(fit)
        )
        return loss <= self.find_limit(term)

    def weigh(self, own: Contender, other: Contender, deviance_difference: float) -> float:
        """By how much less likely the other fit is, beside a loose file if `own` makes it loose.

        Args:
            own: the accepted effect.
            other: the effect in its place.
            deviance_difference: of the two fits as they are. It is returned where both are file
                effects, where the file is not loose, or where the other fit is hopeless.
        """
        both_of_file = own.term.id in FILE_EFFECT_IDS and other.term.id in FILE_EFFECT_IDS
        loose = has_loose_file(own.fit.hypothesis)
        if both_of_file or not loose or deviance_difference >= HOPELESS_LR:
            return deviance_difference
        difference = self.measure_cost(other.fit) - self.measure_cost(own.fit)
        return difference + self.find_limit(other.term) - self.find_limit(own.term)

    def propose(self, current: Fit) -> Hypothesis | None:
        """Add all values of the file that, to first order, are worth their penalty together.

        The gain of the thrusters is not among them. Values that are left out would seem to
        determine the common scale, and the gain would follow it away from the file's.

        Returns:
            The hypothesis with these values; None where there are none.
        """
        numbers = [n for n in self.numbers if n.candidate.effect.id != ThrusterGain.id]
        k, G = ([number.row for number in numbers], self.workspace.columns.gram(current.linearised))
        reduction = eliminate_columns(G[np.ix_(k, k)], G[k, 0], self.workspace.penalty)
        h = current.hypothesis
        for j, x in zip(reduction.chosen, reduction.x, strict=True):
            term = numbers[j].candidate.term([numbers[j].parameter])
            h = h.with_term(term.at(term.x + x))
        return h if reduction.chosen else None


def cost_within(G: Array, rows: Sequence[int], spread: Array) -> float:
    """The sum of squares that is left with some columns free within their spread.

    Args:
        G: Gram matrix (1 + c, 1 + c) of the innovations and the candidates' columns.
        rows: of it (k,), that are free.
        spread: of each (k,), in scales.
    """
    H, b = G[np.ix_(rows, rows)], G[rows, 0]
    return float(G[0, 0] - b @ solve(H + np.diag(spread**-2.0), b))
