"""A law that was fitted together with the effects beside it."""

from dataclasses import dataclass, replace
from typing import Iterable

from rovsim.diagnosis.equations.form import Form, get_law
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term


@dataclass(frozen=True, eq=False)
class FittedLaw:
    """A law that was fitted together with the effects beside it.

    Attributes:
        form: what the law is made of.
        fit: of the law and these effects.
        score: twice the log likelihood, less all penalties.
        rivals: equations that were tried in its place, and by how much less likely each is.
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
        """The same law, with other laws added to its rivals."""
        ranked = sorted(
            others, key=lambda law: law.score
        )  # the likeliest of an equation comes last
        differences = {law.form.equation: self.score - law.score for law in ranked}
        differences.pop(self.form.equation, None)  # the same law, fitted from another start
        return replace(self, rivals=(*self.rivals, *differences.items()))
