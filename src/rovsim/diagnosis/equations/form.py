"""A form of law: its terms, its equation, how it is written as a file, and how it is simplified.

Some laws are products of states at the same instant, others have a memory or depend on the thrust.
The search, and whatever shows its results, treats all forms alike.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import isfinite
from typing import Mapping, Sequence

from rovsim.dynamics.effects.base import Effect
from rovsim.estimation.observer.hypothesis import Hypothesis, Term


@dataclass(frozen=True)
class Part:
    """One term of a law, as a result names it.

    Attributes:
        on: what the term acts on: an axis, `force`, `water` or `thrusters`.
        quantities: names of what the term varies with, such as `u`, `depth`, `thrust`.
    """

    on: str
    quantities: tuple[str, ...]


@dataclass(frozen=True)
class Number:
    """One parameter of a law, as it is written into the file of an effect.

    Attributes:
        name: of the parameter.
        unit: SI, as the catalogue writes it.
        symbol: LaTeX.
        value: fitted.
        std: standard deviation of the value.
        scale: size of a change that is worth looking for.
        low: least possible value; None where there is none.
        high: greatest possible value; None where there is none.
        default: value when it is not given; None where that is zero.
    """

    name: str
    unit: str
    symbol: str
    value: float
    std: float
    scale: float
    low: float | None = None
    high: float | None = None
    default: float | None = None


def stated(value: float) -> float | None:
    """A bound of a parameter; None where it is infinite."""
    return value if isfinite(value) else None


class Form(ABC):
    """What a law is made of; its values are in the law itself, which is a term of a hypothesis."""

    @property
    @abstractmethod
    def parts(self) -> tuple[Part, ...]:
        """The terms of the law."""

    @property
    @abstractmethod
    def equation(self) -> str:
        """The law in LaTeX."""

    @property
    @abstractmethod
    def meaning(self) -> str:
        """The law in a sentence."""

    @abstractmethod
    def list_numbers(self, law: Term, std: Mapping[str, float]) -> list[Number]:
        """List the free parameters of a law in the units of its equation.

        Args:
            law: at its fitted values.
            std: standard deviations of the free parameters, by name, in the units of the effect
                that the law is. These may differ from those of the equation.
        """

    @abstractmethod
    def divide(self, law: Term) -> list[Effect]:
        """Return each term of a law by itself, as an effect."""

    @abstractmethod
    def write(self, name: str, law: Term, numbers: Sequence[Number], story: str) -> str:
        """Write the law as an effect, in Python.

        Args:
            name: id of the effect.
            law: with its fitted values.
            numbers: its parameters.
            story: one line on where it comes from.
        """

    def follow(self, h: Hypothesis) -> Hypothesis:
        """Adapt the law to the other terms of the hypothesis, where it depends on them."""
        return h

    @abstractmethod
    def simplify(self, h: Hypothesis) -> list[tuple["Form", Hypothesis]]:
        """List all ways to remove one term from the law.

        Returns:
            The simpler form, and the hypothesis `h` with the law in that form.
        """


def split_law(h: Hypothesis) -> tuple[Hypothesis, Term | None]:
    """Split a hypothesis into one without a law, and the law; None where it has none.

    The law is the one effect that no catalogue lists.
    """
    for i, term in enumerate(h.terms):
        if not term.effect.listed:
            return h.without(i), term
    return h, None


def get_law(h: Hypothesis) -> Term:
    """The law of a hypothesis that must have one."""
    law = split_law(h)[1]
    assert law is not None
    return law
