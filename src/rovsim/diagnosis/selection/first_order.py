"""What additions and removals would change, judged to first order.

The penalty of a parameter is 2 log P for P columns to choose from (risk inflation criterion, Foster
& George 1994): chance alone rarely pays it, so a family of many members is not favoured over a
single number.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.proposals import Proposal, rank_proposals
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.least_squares import gram, newton_step
from rovsim.estimation.observer.residual_source import Linearised
from rovsim.estimation.white_columns import WhiteColumns


@dataclass(frozen=True, eq=False)
class Removed:
    """A hypothesis without one of its terms, judged to first order.

    Attributes:
        hypothesis: without the term.
        gram: (1 + c, 1 + c) of the innovations that it leaves and of the candidates' columns, see
            `WhiteColumns.gram`.
        ss_increase: by how much the sum of squared innovations is larger without the term.
        others: all candidates as replacements of the term, the best first.
    """

    hypothesis: Hypothesis
    gram: Array
    ss_increase: float
    others: list[Proposal]


@dataclass(frozen=True, eq=False)
class FirstOrder:
    """Judges additions to a fit, and removals from it, without fitting again.

    What was judged is kept as long as the columns are.

    Attributes:
        columns: how each candidate would change the innovations of the runs, whitened.
    """

    columns: WhiteColumns
    _proposed: dict[tuple, list[Proposal]] = field(default_factory=dict)
    _removed: dict[tuple, list[Removed]] = field(default_factory=dict)

    @cached_property
    def penalty(self) -> float:
        """Penalty of a free parameter, to be subtracted from a likelihood-ratio statistic."""
        return 2.0 * float(np.log(self.columns.sensitivities.count))

    def propose(self, current: Fit) -> list[Proposal]:
        """All candidates as additions to the current fit, judged to first order, the best first.

        Empty where the current model diverges.
        """
        if not current.is_finite:
            return []
        key = current.hypothesis.key
        if key not in self._proposed:
            self._proposed[key] = self._rank(self.columns.gram(current.linearised))
        return self._proposed[key]

    def remove_each(self, current: Fit) -> list[Removed]:
        """Without each term of the current hypothesis in turn, the others refitted to first order.

        The result is kept, since swaps are tried one after the other.
        """
        key = current.hypothesis.key
        if key not in self._removed:
            self._removed[key] = self._remove_each(current)
        return self._removed[key]

    def _remove_each(self, current: Fit) -> list[Removed]:
        removed, rss = [], float(self.columns.gram(current.linearised)[0, 0])
        for linearised in self._without(current, [(term,) for term in current.hypothesis.terms]):
            G = self.columns.gram(linearised)
            removed.append(Removed(linearised.hypothesis, G, float(G[0, 0]) - rss, self._rank(G)))
        return removed

    def gram_without(self, current: Fit, term: Term) -> Array:
        """The Gram matrix of the current hypothesis without one of its terms."""
        if removals := self._removed.get(current.hypothesis.key):
            return removals[current.hypothesis.terms.index(term)].gram
        return self.columns.gram(self._without(current, [(term,)])[0])

    def drop(self, current: Fit, groups: Sequence[Sequence[Term]]) -> list[Hypothesis]:
        """Without each group of terms in turn, the other terms refitted to first order.

        Where the model without the group diverges, the other terms keep their values.
        """
        return [self._step(linearised) for linearised in self._without(current, groups)]

    def _step(self, linearised: Linearised) -> Hypothesis:
        """The hypothesis at the values for which a Gauss-Newton step predicts the least errors."""
        if not linearised.is_finite:
            return linearised.hypothesis
        step = newton_step(gram(self.columns.bank.flatten(linearised.rows, self.columns.noise)))
        return linearised.hypothesis.at(linearised.hypothesis.x + step)

    def _without(self, current: Fit, groups: Sequence[Sequence[Term]]) -> list[Linearised]:
        """Without each group of terms in turn: innovations anew, derivatives of the current fit."""
        h, J = current.hypothesis, current.linearised.J
        hypotheses = [
            replace(h, terms=tuple(t for t in h.terms if t not in group)) for group in groups
        ]
        e = self.columns.bank.evaluate([r.model for r in hypotheses])
        linearised = []
        for k, (hypothesis, group) in enumerate(zip(hypotheses, groups, strict=True)):
            pairs = zip(h.terms, h.columns, strict=True)
            positions = [j for term, columns in pairs if term in group for j in columns]
            J_reduced = [np.delete(of_run, positions, axis=0) for of_run in J]
            linearised.append(Linearised(hypothesis, [of_run[k] for of_run in e], J_reduced))
        return linearised

    def _rank(self, G: Array) -> list[Proposal]:
        """All candidates, the best first; none where the model diverges."""
        if not np.isfinite(G).all():
            return []
        return rank_proposals(G, self.columns.sensitivities.blocks, self.penalty)
