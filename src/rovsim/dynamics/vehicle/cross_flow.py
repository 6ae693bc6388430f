"""Forces of products of velocities, under the names that SNAME gave their coefficients.

A name is the axis of the force (X Y Z K M N) and two or three velocities (u v w p q r):

    Yuv: -28.6       Y = -28.6 u v
    Nr|r|: -94.0     N = -94.0 r |r|        bars stand for the absolute value
    Yvv: -1310.0     Y = -1310.0 v |v|      the same velocity twice, without bars, is drag: Yv|v|
    X|q||q|: -1.9    X = -1.9 q^2           the same for both signs of q
    Xuuu: -5.9       X = -5.9 u^3

Signs are those of the source: a coefficient of drag is negative. Forces of added mass (M_A and its
Coriolis terms) are separate: in a source that has Xwq, Yur or Nur, these may contain parts of them.
"""

import re
from typing import Annotated, Any, Mapping

import numpy as np
from pydantic import PlainValidator

from rovsim.core.axes import FORCE, VELOCITY
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Effect

ABSOLUTE_VALUE = 6  # the factor 6 + i is the absolute value of velocity i
NO_FACTOR = -1
COEFFICIENT_NAME = re.compile(r"([XYZKMN])((?:[uvwpqr]|\|[uvwpqr]\|){2,3})")


def parse_product(name: str) -> tuple[int, int, int, int]:
    """Parse a name into the axis of the force and three factors: a row (4) of `Body.factors`.

    Raises:
        ValueError: not a name of a product.
    """
    match = COEFFICIENT_NAME.fullmatch(name)
    if match is None:
        raise ValueError(
            f"names of an axis {' '.join(FORCE)} and two or three velocities "
            f"{' '.join(VELOCITY)}, such as Yuv or Nr|r|, and not '{name}'"
        )
    parts = re.findall(r"\|[uvwpqr]\||[uvwpqr]", match[2])
    if len(parts) == 2 and parts[0] == parts[1] and "|" not in parts[0]:
        parts[1] = f"|{parts[1]}|"
    codes = [VELOCITY.index(part.strip("|")) + ABSOLUTE_VALUE * ("|" in part) for part in parts]
    codes += [NO_FACTOR] * (3 - len(codes))
    return FORCE.index(match[1]), codes[0], codes[1], codes[2]


def _checked(value: Any) -> dict[str, float]:
    """Validate coefficients by name, for pydantic."""
    if not isinstance(value, dict):
        raise ValueError("coefficients by name, such as {Yuv: -28.6}")
    for name, number in value.items():
        parse_product(str(name))
        usable = isinstance(number, (int, float)) and not isinstance(number, bool)
        if not usable or not -1e300 < number < 1e300:
            raise ValueError(f"a number for {name}")
    return {str(name): float(number) for name, number in value.items()}


Products = Annotated[dict[str, float], PlainValidator(_checked)]


class CrossFlow(Coefficients):
    """Forces of products of velocities in nu_r: cross-flow drag, lift of hull and fins."""

    id = "cross_flow"
    listed = False
    equation = r"\tau_i = \sum c_{ijk}\,\nu_{r,j}\,\nu_{r,k}"
    neglects = "what the products cannot say: stall, memory"
    source = "SNAME 1950, Nomenclature for treating the motion of a submerged body"
    parameters = ()

    def __init__(self, products: Mapping[str, float] | None = None) -> None:
        super().__init__()
        self.products = dict(products or {})

    def neutral(self) -> Effect:
        """The effect without products."""
        return CrossFlow()

    def enter(self, body: Body) -> None:
        """Add the products to the body."""
        names = list(self.products)
        body.products = np.concatenate([body.products, [self.products[name] for name in names]])
        factors = np.array([parse_product(name) for name in names], dtype=np.int64)
        body.factors = np.concatenate([body.factors, factors.reshape(-1, 4)])
