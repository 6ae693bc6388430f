"""The form of laws that are sums of products of states at the same instant."""

from dataclasses import dataclass
from textwrap import indent
from typing import Mapping, Sequence

from rovsim.core.rounding import rounded
from rovsim.diagnosis.equations.effect_file import round_start, write_effect
from rovsim.diagnosis.equations.form import Form, Number, Part, stated
from rovsim.diagnosis.equations.products.as_effect import (
    drop_term,
    effect_of,
    follow_drag,
    list_moved,
)
from rovsim.diagnosis.equations.products.kernel_lines import write_body
from rovsim.diagnosis.equations.products.library import LawTerm
from rovsim.diagnosis.equations.products.targets import TARGETS
from rovsim.diagnosis.equations.products.wording import (
    list_quantities,
    name_coefficients,
    tell_law,
    write_equation,
)
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.laws.law import COEFFICIENTS
from rovsim.estimation.observer.hypothesis import Hypothesis, Term

PLACE_PARAMETERS = {  # unit, symbol and scale of a place's numbers
    "x": ("m", "x_0", 0.5),
    "y": ("m", "y_0", 0.5),
    "z": ("m", "z_0", 0.5),
    "width": ("m", "s", 0.2),
}
KERNEL_TEMPLATE = '''\
@staticmethod
def wrench(at, p):
    """Wrench at CO along the body's axes: ahead, starboard, down."""
{body}
'''


@dataclass(frozen=True)
class Products(Form):
    """A law of one to three terms, each a coefficient times up to three factors.

    The law of a hypothesis in this form is the effect `Law`.
    """

    terms: tuple[LawTerm, ...]

    @property
    def parts(self) -> tuple[Part, ...]:
        """The terms, in order."""
        return tuple(Part(TARGETS[t.on].group, list_quantities(t)) for t in self.terms)

    @property
    def equation(self) -> str:
        """The law in LaTeX."""
        return write_equation(self.terms)

    @property
    def meaning(self) -> str:
        """The law in a sentence."""
        return tell_law(self.terms)

    def list_numbers(self, law: Term, std: Mapping[str, float]) -> list[Number]:
        """List the coefficients in the units of their terms, then the place and its width."""
        numbers = []
        terms = zip(name_coefficients(self.terms), self.terms, effect_of(law).terms, strict=True)
        for k, (name, term, fitted) in enumerate(terms):
            value = fitted.coefficient * fitted.size
            value_std = std[COEFFICIENTS[k]] * fitted.size
            scale = rounded(max(abs(value), 1e-6), 1)
            unit = TARGETS[term.on].unit_of(term.factors)
            symbol = f"c_{k + 1}" if len(self.terms) > 1 else "c"
            numbers.append(Number(name, unit, symbol, value, value_std, scale))
        parameters = {p.name: p for p in law.parameters}
        for name in list_moved(self.terms):
            unit, symbol, scale = PLACE_PARAMETERS[name]
            value, low, high = (
                law.effect[name],
                stated(parameters[name].low),
                stated(parameters[name].high),
            )
            numbers.append(Number(name, unit, symbol, value, std[name], scale, low, high, value))
        return numbers

    def divide(self, law: Term) -> list[Effect]:
        """Return each term by itself: the law with the other coefficients set to zero."""
        names = COEFFICIENTS[: len(self.terms)]
        return [law.effect.with_values({n: 0.0 for n in names if n != name}) for name in names]

    def write(self, name: str, law: Term, numbers: Sequence[Number], story: str) -> str:
        """Write an effect whose kernel states the law as plain arithmetic."""
        code = "\n".join(write_body(name_coefficients(self.terms), self.terms, law))
        maths = [f for f in ("exp", "sqrt", "tanh") if f"{f}(" in code]
        placed = any(n.default is not None for n in numbers)
        return write_effect(
            name,
            self,
            numbers,
            story,
            base="Wrench",
            imports=f"from math import {', '.join(maths)}\n\n" if maths else "",
            method=KERNEL_TEMPLATE.format(body=indent(code, "    ")),
            start=round_start(numbers) if placed else {},
        )

    def follow(self, h: Hypothesis) -> Hypothesis:
        """Give the law the drag coefficients of the model beside it, by which moving water acts."""
        return follow_drag(h)

    def simplify(self, h: Hypothesis) -> list[tuple[Form, Hypothesis]]:
        """List the laws without one of the terms, as long as another is left."""
        if len(self.terms) == 1:
            return []
        return [
            (Products(self.terms[:k] + self.terms[k + 1 :]), drop_term(h, self.terms, k))
            for k in range(len(self.terms))
        ]
