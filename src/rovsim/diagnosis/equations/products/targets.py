"""What a term of a law may act on: an axis of the body or of NED, flowing or turning water."""

from dataclasses import dataclass
from typing import Sequence

from rovsim.core.axes import AXES, FORCE, FORCE_UNITS
from rovsim.diagnosis.equations.products.variables import VARIABLES, write_unit
from rovsim.dynamics.laws.codes import EAST, NORTH

WORLD_FORCES, FLOWS = ("Fn", "Fe", "Fd"), ("vn", "ve")  # in code


@dataclass(frozen=True)
class Head:
    """The left side of one of a law's equations.

    Attributes:
        latex: symbol in LaTeX.
        code: variable in a kernel.
        inner_latex: a further factor of the term on the right side, with its sign; empty for none.
        inner_code: the same factor in a kernel.
    """

    latex: str
    code: str
    inner_latex: str = ""
    inner_code: str = ""


@dataclass(frozen=True)
class TermTarget:
    """What a term acts on.

    Attributes:
        name: for names of coefficients.
        group: name of a body axis, `force` for one along NED axes, or `water`.
        heads: left sides of its equations.
        acts: noun phrase for sentences.
        newtons: unit of a force, N or N m; empty for a flow.
        meters: power of m in the unit of a flow.
        seconds: power of s in the unit of a flow.
    """

    name: str
    group: str
    heads: tuple[Head, ...]
    acts: str
    newtons: str = ""
    meters: int = 0
    seconds: int = 0

    @property
    def is_water(self) -> bool:
        """Whether it is moving water, which acts through the drag."""
        return self.group == "water"

    def unit_of(self, factors: Sequence[int]) -> str:
        """SI unit of the coefficient of a product of these factors, given by their codes."""
        variables = [VARIABLES[k] for k in factors]
        powers = {
            "m": self.meters - sum(v.meters for v in variables),
            "s": self.seconds - sum(v.seconds for v in variables),
            "rad": -sum(v.radians for v in variables),
        }
        return write_unit(powers, self.newtons)


def _along_body() -> list[TermTarget]:
    """Forces and moments along the six body axes."""
    kinds = ("force",) * 3 + ("moment",) * 3
    return [
        TermTarget(axis, axis, (Head(letter, letter),), f"a {axis} {kind}", newtons=unit)
        for axis, letter, kind, unit in zip(AXES, FORCE, kinds, FORCE_UNITS, strict=True)
    ]


def _along_world() -> list[TermTarget]:
    """Forces along the NED axes."""
    latex, towards = ("F_n", "F_e", "F_d"), ("towards north", "towards east", "downwards")
    return [
        TermTarget(name, "force", (Head(symbol, code),), f"a force {direction}", newtons="N")
        for name, symbol, code, direction in zip(
            ("north", "east", "down"), latex, WORLD_FORCES, towards, strict=True
        )
    ]


def _of_water() -> list[TermTarget]:
    """Flows north and east, and water that turns about a vertical axis."""
    vn, ve = (Head(f"v_{code[1]}", code) for code in FLOWS)
    turning = (
        Head(vn.latex, vn.code, "-" + VARIABLES[EAST].latex, " * -east"),
        Head(ve.latex, ve.code, VARIABLES[NORTH].latex, " * north"),
    )
    return [
        TermTarget("water north", "water", (vn,), "water that moves north", meters=1, seconds=-1),
        TermTarget("water east", "water", (ve,), "water that moves east", meters=1, seconds=-1),
        TermTarget("swirl", "water", turning, "water that turns about a place", seconds=-1),
    ]


# In the order of `laws.codes`, so that a code is an index.
TARGETS = (*_along_body(), *_along_world(), *_of_water())
