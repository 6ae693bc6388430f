"""A special effect beside a loose vehicle file, which may be off everywhere.

Where several effects that the file states were selected, it is off elsewhere too, mostly by too
little to be found: a dozen such numbers, none of them worth its penalty, may explain together what
a special effect seems to. So there it is judged with all of the file free, as far as such files are
off (`estimation/file_effects.py`), and to first order. Where the file explains it, its numbers are
sought together: linear and quadratic drag of opposite sign look like friction, and neither alone
explains anything.
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

# Some thirty effects, each there once in thirty times, against a coefficient of a file that is
# known to be off.
FILE_LR = lr_statistic_of(odds=1000.0)


class FileNumber(NamedTuple):
    """A parameter of a candidate that the file states.

    `row` of the workspace's Gram matrix; `spread`, in scales, how far the file may be off.
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
    """A vehicle file that may be off everywhere, beside the fits of a workspace."""

    workspace: SearchWorkspace

    @cached_property
    def numbers(self) -> list[FileNumber]:
        """All that it can be wrong about."""
        base, numbers = self.workspace.sensitivities.base_model, []
        for block in self.workspace.sensitivities.blocks:
            effect = block.candidate.effect
            if not block.candidate.absent or effect.id not in FILE_EFFECT_IDS:
                continue
            each = zip(block.derivatives, block.candidate.term().parameters, strict=True)
            for column, parameter in each:
                # one thruster's gain is off by a fault
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
        """What a fit leaves of the sum of squares with all of the file free, to first order."""
        return self._cost_at(self.workspace.columns.gram(fit.linearised))

    def _cost_at(self, G: Array) -> float:
        return cost_within(G, self._rows, self._spread)

    def measure_doubt(self, fit: Fit) -> float:
        """How much likelier a file is that is off everywhere than one that is right beside a fit.

        Twice the log of Bayes' factor, to first order, of all numbers of the file as free as
        such files are off. Each number that nothing asks for counts against it.
        """
        G, spread = self.workspace.columns.gram(fit.linearised), self._spread
        H = G[np.ix_(self._rows, self._rows)]
        needless = float(np.linalg.slogdet(np.eye(len(H)) + spread[:, None] * H * spread)[1])
        return float(G[0, 0]) - self._cost_at(G) - needless

    def measure_loss(self, fit: Fit, term: Term) -> float:
        """How much more is left beside a loose file without one term of a fit."""
        rest = self.workspace.gram_without(fit, term)
        return self._cost_at(rest) - self.measure_cost(fit)

    def find_limit(self, term: Term) -> float:
        """What a term must take away beside a loose file; nothing if it is a file effect."""
        if term.id in FILE_EFFECT_IDS:
            return 0.0
        return self.workspace.penalty * term.choices + FILE_LR

    def explains(self, fit: Fit, name: str) -> bool:
        """Whether all of the file together explains what a special effect of a fit does."""
        if name in FILE_EFFECT_IDS:
            return False
        term = next(one for one in fit.hypothesis.terms if one.id == name)
        return self.measure_loss(fit, term) <= self.find_limit(term)

    def weigh(self, own: Contender, other: Contender, deviance_difference: float) -> float:
        """How much less likely the other's fit is, beside the file where its own makes it loose.

        Both file effects, or hopeless: `deviance_difference`, what is known of the two fits as they
        are.
        """
        both = own.term.id in FILE_EFFECT_IDS and other.term.id in FILE_EFFECT_IDS
        loose = has_loose_file(own.fit.hypothesis)
        if both or not loose or deviance_difference >= HOPELESS_LR:
            return deviance_difference
        more = self.measure_cost(other.fit) - self.measure_cost(own.fit)
        return more + self.find_limit(other.term) - self.find_limit(own.term)

    def propose(self, current: Fit) -> Hypothesis | None:
        """With all of its numbers that are worth their penalty beside each other; None: nothing.

        To first order. Without the gain of the thrusters: any other number left out would seem to
        fix the common scale, and the gain would follow it away from what the file says.
        """
        numbers = [n for n in self.numbers if n.candidate.effect.id != ThrusterGain.id]
        own, G = [number.row for number in numbers], self.workspace.columns.gram(current.linearised)
        reduction = eliminate_columns(G[np.ix_(own, own)], G[own, 0], self.workspace.penalty)
        h = current.hypothesis
        for j, x in zip(reduction.chosen, reduction.x, strict=True):
            term = numbers[j].candidate.term([numbers[j].parameter])
            h = h.with_term(term.at(term.x + x))
        return h if reduction.chosen else None


def cost_within(G: Array, rows: Sequence[int], spread: Array) -> float:
    """What is left of the sum of squares with some columns free within their spread.

    Args:
        G: Gram matrix (1 + c, 1 + c) of the innovations and the candidates' columns.
        rows: of it, k that are free.
        spread: of each (k,), in scales.
    """
    H, b = G[np.ix_(rows, rows)], G[rows, 0]
    return float(G[0, 0] - b @ solve(H + np.diag(spread**-2.0), b))
