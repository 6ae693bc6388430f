"""Forces of products of velocities, under the names that SNAME gave their coefficients.

A name is the axis of the force (X Y Z K M N) and two or three velocities (u v w p q r):

    Yuv: -28.6       Y = -28.6 u v
    Nr|r|: -94.0     N = -94.0 r |r|        bars take the size
    Yvv: -1310.0     the same as Yv|v|: twice the same velocity is v |v|, as drag is written
    X|q||q|: -1.9    q^2, which pushes alike either way
    Xuuu: -5.9       u u u

Signs are the source's: what brakes is negative. Forces of added mass (M_A and its Coriolis terms)
are not among them: a source that writes Xwq, Yur or Nur may hold parts of those.
"""

import re
from typing import Annotated, Any, Mapping

import numpy as np
from pydantic import PlainValidator

from rovsim.core.axes import FORCE, VELOCITY
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Effect

SIZE = 6  # a factor of 6 + i is the size of velocity i
NO_FACTOR = -1
NAME = re.compile(r"([XYZKMN])((?:[uvwpqr]|\|[uvwpqr]\|){2,3})")


def parse_product(name: str) -> tuple[int, int, int, int]:
    """Axis of the force and its factors, as `Body.factors` has them.

    Raises:
        ValueError: no such name.
    """
    found = NAME.fullmatch(name)
    if found is None:
        raise ValueError(
            f"names of an axis {' '.join(FORCE)} and two or three velocities "
            f"{' '.join(VELOCITY)}, such as Yuv or Nr|r|, and not '{name}'"
        )
    parts = re.findall(r"\|[uvwpqr]\||[uvwpqr]", found[2])
    if len(parts) == 2 and parts[0] == parts[1] and "|" not in parts[0]:
        parts[1] = f"|{parts[1]}|"
    codes = [VELOCITY.index(part.strip("|")) + SIZE * ("|" in part) for part in parts]
    codes += [NO_FACTOR] * (3 - len(codes))
    return FORCE.index(found[1]), codes[0], codes[1], codes[2]


def _checked(value: Any) -> dict[str, float]:
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
    """Forces of products of velocities through the water: cross-flow drag, hull and fin lift."""

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
        """No products."""
        return CrossFlow()

    def enter(self, body: Body) -> None:
        """Add the products."""
        names = list(self.products)
        body.products = np.concatenate([body.products, [self.products[name] for name in names]])
        factors = np.array([parse_product(name) for name in names], dtype=np.int64)
        body.factors = np.concatenate([body.factors, factors.reshape(-1, 4)])
