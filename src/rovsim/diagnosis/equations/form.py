"""A form of law: of what it is made, what it says, how it is written, and how it is made simpler.

Some laws are products of what acts at the same instant, others remember. To the search, and to who
reads what it found, they are alike.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import isfinite
from typing import Mapping, Sequence

from rovsim.dynamics.effects.base import Effect
from rovsim.estimation.observer.hypothesis import Hypothesis, Term


@dataclass(frozen=True)
class Part:
    """One term of a law: what it acts `on`, and the `quantities` it varies with."""

    on: str
    quantities: tuple[str, ...]


@dataclass(frozen=True)
class Number:
    """One parameter of a written effect: in which unit, and how sure; its range and its default."""

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
    """A bound, if it is one."""
    return value if isfinite(value) else None


class Form(ABC):
    """What a law is made of; its values are those of the law itself, a term of a hypothesis."""

    @property
    @abstractmethod
    def parts(self) -> tuple[Part, ...]:
        """Its terms."""

    @property
    @abstractmethod
    def equation(self) -> str:
        """In LaTeX."""

    @property
    @abstractmethod
    def meaning(self) -> str:
        """In a sentence."""

    @abstractmethod
    def list_numbers(self, law: Term, std: Mapping[str, float]) -> list[Number]:
        """The free parameters of the law in the units of its equation; `std` of each by name."""

    @abstractmethod
    def divide(self, law: Term) -> list[Effect]:
        """Each of its terms by itself, as an effect."""

    @abstractmethod
    def write(self, name: str, law: Term, numbers: Sequence[Number], story: str) -> str:
        """Python source of the law as an effect with that id; `story`: where it comes from."""

    def follow(self, h: Hypothesis) -> Hypothesis:
        """The hypothesis with the law suited to what it stands beside."""
        return h

    @abstractmethod
    def simplify(self, h: Hypothesis) -> list[tuple["Form", Hypothesis]]:
        """The forms with one term less, and the hypothesis with the law so changed."""


def split_law(h: Hypothesis) -> tuple[Hypothesis, Term | None]:
    """A hypothesis without its law, and the law: the one effect that no catalogue lists."""
    for i, term in enumerate(h.terms):
        if not term.effect.listed:
            return h.without(i), term
    return h, None


def get_law(h: Hypothesis) -> Term:
    """The law of a hypothesis that has one."""
    found = split_law(h)[1]
    assert found is not None
    return found
