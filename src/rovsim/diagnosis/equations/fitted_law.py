"""A law on top of what was selected, fitted."""

from dataclasses import dataclass, replace
from typing import Iterable

from rovsim.diagnosis.equations.form import Form, get_law
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term


@dataclass(frozen=True, eq=False)
class FittedLaw:
    """A law on top of a hypothesis, fitted; `score` with the penalty of each of its numbers.

    `rivals`: equations of laws that were tried in its place, and by how much less likely each is.
    """

    form: Form
    fit: Fit
    score: float
    rivals: tuple[tuple[str, float], ...] = ()

    @property
    def law(self) -> Term:
        """The law with its fitted values."""
        return get_law(self.fit.hypothesis)

    def beats(self, others: Iterable["FittedLaw"]) -> "FittedLaw":
        """The same, with others as its rivals."""
        ranked = sorted(others, key=lambda one: one.score)  # of the same equation the likeliest
        differences = {one.form.equation: self.score - one.score for one in ranked}
        differences.pop(self.form.equation, None)  # from another place it came here
        return replace(self, rivals=(*self.rivals, *differences.items()))
