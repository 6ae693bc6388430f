"""Any law of up to three terms as one effect: its terms are data, so that nothing is recompiled.

A term is a coefficient, what it acts on (an axis or the water), and up to three factors. Codes of
these are among the effect's parameters (`laws.codes`). A test compares this kernel with the effect
file that is written for a law.
"""

from dataclasses import dataclass
from math import exp, sqrt, tanh
from typing import Sequence

from rovsim.dynamics.compilation.compiled import inlined, internal
from rovsim.dynamics.effects.base import Parameter, Wrench
from rovsim.dynamics.effects.dry_friction import SMOOTHING_SPEED
from rovsim.dynamics.engine.vectors import into_body
from rovsim.dynamics.laws.codes import (
    DEPTH,
    DIRECTION,
    DOWN,
    EAST,
    NO_FACTOR,
    NORTH,
    SIGN,
    SIGN_OF_DOWN,
    SIZE,
    SPEED,
    SWIRL,
    VELOCITY,
    WATER,
    WORLD,
)

MAX_TERMS, MAX_FACTORS = 3, 3
TERM_LENGTH = 3 + MAX_FACTORS  # parameters of a term
COEFFICIENTS = tuple(f"c{k}" for k in range(1, MAX_TERMS + 1))  # parameters fitted, by term
SIGN_WIDTH = SMOOTHING_SPEED  # of the sign of a velocity: as in friction of the catalogue
TILT_SIGN_WIDTH = 0.05  # 3 degrees: width of the sign of the NED z axis in body axes
MIN_SPEED = 0.02  # m/s: below, a direction of motion fades


@inlined
def speed(v):
    """Speed of translation of a velocity (6), m/s."""
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@inlined
def away(at, x, y):
    """Distance north and east, m, from the place x, y in MoCap coordinates."""
    return at.position[0] - x * at.axes[0], at.position[1] - y * at.axes[1]


@inlined
def of_velocity(k, v):
    """Factor k of the velocity v (6): a component, its size or sign, the speed, or 1 / speed."""
    if k < SIZE:
        return v[k - VELOCITY]
    if k < SIGN:
        return abs(v[k - SIZE])
    if k < DOWN:
        return tanh(v[k - SIGN] / SIGN_WIDTH)
    U = speed(v)
    return U if k == SPEED else 1.0 / sqrt(U * U + MIN_SPEED * MIN_SPEED)


@inlined
def of_place(k, at, x, y, z, s):
    """Factor k of the place x, y, z: distance north, east or down, m; or nearness of width s."""
    north, east = away(at, x, y)
    if k == NORTH:
        return north
    if k == EAST:
        return east
    if k == DEPTH:
        return at.position[2] - z * at.axes[2]
    return exp(-(north * north + east * east) / (2.0 * s * s))


@inlined
def factor(code, at, p):
    """Value of a factor by its code; 1 for no factor."""
    k = int(code)
    if k == NO_FACTOR:
        return 1.0
    if k < DOWN or k in (SPEED, DIRECTION):
        return of_velocity(k, at.nu_r)
    if k < SIGN_OF_DOWN:
        return at.R[2][k - DOWN]
    if k < SPEED:
        return tanh(at.R[2][k - SIGN_OF_DOWN] / TILT_SIGN_WIDTH)
    return of_place(k, at, p.x, p.y, p.z, p.width)


@internal
def term(at, p, k):
    """Term k: coefficient, size and factors. Inlined, it would double an engine's compile time."""
    value = p[TERM_LENGTH * k] * p[TERM_LENGTH * k + 1]
    if value != 0.0:
        for j in range(MAX_FACTORS):
            value *= factor(p[TERM_LENGTH * k + 3 + j], at, p)
    return value


@inlined
def total(p, on, values):
    """Sum of the terms that act on `on`."""
    subtotal = 0.0
    for k in range(MAX_TERMS):
        if int(p[TERM_LENGTH * k + 2]) == on:
            subtotal += values[k]
    return subtotal


@inlined
def drag_change(linear, quadratic, v, water):
    """Change of the drag force of one axis with a velocity v when the water moves at `water`."""
    w = v - water
    return (linear + quadratic * abs(v)) * v - (linear + quadratic * abs(w)) * w


@dataclass(frozen=True)
class Product:
    """One term of a law, with its values.

    Attributes:
        coefficient: fitted; of the order of what the term makes.
        size: fixed, by which the coefficient is multiplied.
        on: code (`laws.codes`) of what the term acts on.
        factors: codes of its factors, up to three.
    """

    coefficient: float
    size: float
    on: int
    factors: tuple[int, ...]


def _name(k: int) -> tuple[str, ...]:
    """Names of the parameters of term k, in their order; the fitted coefficient is the first."""
    factors = (f"factor{k}{j}" for j in range(1, MAX_FACTORS + 1))
    return COEFFICIENTS[k - 1], f"size{k}", f"on{k}", *factors


def _term(k: int) -> tuple[Parameter, ...]:
    """Parameters of term k: fitted coefficient; fixed size, what it acts on, and factors."""
    coefficient, *fixed = _name(k)
    return (
        Parameter(coefficient, "1", f"c_{k}", scale=1.0),
        *(
            Parameter(name, "1", name, default=float(NO_FACTOR), scale=1.0, fitted=False)
            for name in fixed
        ),
    )


class Law(Wrench):
    """Up to three terms of products of velocities, attitude and place."""

    id = "law"
    listed = False
    equation = r"\tau = \sum_k c_k\,e_k \prod_j f_{kj}"
    neglects = "what is not a product of its factors"
    source = "definition"
    parameters = (
        *_term(1),
        *_term(2),
        *_term(3),
        Parameter("x", "m", "x_0", scale=0.5),
        Parameter("y", "m", "y_0", scale=0.5),
        Parameter("z", "m", "z_0", scale=0.5),
        Parameter("width", "m", "s", low=0.15, high=5.0, default=0.5, scale=0.2),
        *(Parameter(f"linear{i}", "N s/m", "d", scale=1.0, fitted=False) for i in range(3)),
        *(Parameter(f"quadratic{i}", "N s2/m2", "d", scale=1.0, fitted=False) for i in range(3)),
    )

    @staticmethod
    def of(terms: Sequence[Product], **others: float) -> "Law":
        """Make the law of up to three terms.

        Args:
            terms: in the order of their parameters.
            others: values of the other parameters: place, width and drag.
        """
        values = dict(others)
        for k, term in enumerate(terms, start=1):
            numbers = (term.coefficient, term.size, float(term.on), *map(float, term.factors))
            values |= dict(zip(_name(k), numbers, strict=False))
        return Law(**values)

    @property
    def terms(self) -> tuple[Product, ...]:
        """The terms, in the order of their parameters."""
        rows = self.values[: MAX_TERMS * TERM_LENGTH].reshape(MAX_TERMS, TERM_LENGTH)
        return tuple(
            Product(
                float(c), float(size), int(on), tuple(int(f) for f in factors if f != NO_FACTOR)
            )
            for c, size, on, *factors in rows
            if on != NO_FACTOR
        )

    @property
    def others(self) -> dict[str, float]:
        """Values of the other parameters that differ from their default, by name."""
        names = [p.name for p in self.parameters[MAX_TERMS * TERM_LENGTH :]]
        return {name: value for name, value in self.given().items() if name in names}

    @staticmethod
    def wrench(at, p):
        """Sum of the terms along body and NED axes, and the change of drag by moving water."""
        t = (term(at, p, 0), term(at, p, 1), term(at, p, 2))
        world = (total(p, WORLD, t), total(p, WORLD + 1, t), total(p, WORLD + 2, t))
        f = into_body(at.R, world)
        X, Y, Z = total(p, 0, t) + f[0], total(p, 1, t) + f[1], total(p, 2, t) + f[2]
        north, east = away(at, p.x, p.y)
        vn, ve, turns = total(p, WATER, t), total(p, WATER + 1, t), total(p, SWIRL, t)
        vn, ve = vn - turns * east, ve + turns * north
        if vn != 0.0 or ve != 0.0:
            v = into_body(at.R, (vn, ve, 0.0))
            X += drag_change(p.linear0, p.quadratic0, at.nu_r[0], v[0])
            Y += drag_change(p.linear1, p.quadratic1, at.nu_r[1], v[1])
            Z += drag_change(p.linear2, p.quadratic2, at.nu_r[2], v[2])
        return X, Y, Z, total(p, 3, t), total(p, 4, t), total(p, 5, t)
