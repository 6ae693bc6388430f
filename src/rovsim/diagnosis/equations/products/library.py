"""Candidate terms of an equation, and the wrench of each.

Dimensions are kept since every coefficient has the unit that its term needs; what acts on the
vehicle along its own axes must turn with the mirror of port and starboard as its axis does.
Accelerations are no factors: a force proportional to one is inertia, which the catalogue has, and
the engine has none before all forces are known.
"""

from dataclasses import dataclass
from itertools import combinations
from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import matrix
from rovsim.diagnosis.equations.products.variables import ODD, VARIABLES, tabulate
from rovsim.diagnosis.structure.regressors import earlier_states
from rovsim.dynamics.effects.law_codes import (
    DEEP,
    DIRECTION,
    DOWN,
    EAST,
    NEAR,
    NORTH,
    SIGN,
    SIGN_OF_DOWN,
    SIZE,
    SPEED,
    SWIRL,
    WATER,
    WORLD,
)
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.observed_run import ObservedRun

SPACING, WIDTH = 1.0, 0.6  # m: places tried, and how wide each is; the fit moves both
MOST_PLACES = 60  # those where the vehicle was most often


@dataclass(frozen=True)
class LawTerm:
    """What a term acts on, and its factors, as `law_codes` numbers them.

    `place` m north and east, of terms that fade away from one.
    """

    on: int
    factors: tuple[int, ...]
    place: tuple[float, float] | None = None

    @property
    def kind(self) -> tuple[int, tuple[int, ...]]:
        """The same for terms that differ by their place alone."""
        return self.on, self.factors


Known = tuple[float | None, float | None]  # m north and east of a law's place, where it has one


def list_terms(runs: Sequence[ObservedRun], known: Known = (None, None)) -> list[LawTerm]:
    """All candidate terms that these runs could show; at places that suit what is known of one."""
    moving = np.flatnonzero(np.logical_and.reduce([run.axes for run in runs]))
    terms = [term for i in moving for term in list_body_terms(int(i), moving)]
    if not all((run.axes | ~run.free_axes.astype(bool)).all() for run in runs):
        return terms
    n, e = known
    wanted = [(a if n is None else n, b if e is None else e) for a, b in list_places(runs)]
    places = list(dict.fromkeys(wanted))
    return [*terms, *_along_world(), *(t for one in places for t in _at(one))]


def list_body_terms(i: int, moving: Array) -> Iterator[LawTerm]:
    """Terms along one axis of the body that turn with the mirror as it does.

    But for those that the catalogue has: drags of one velocity, and linear and quadratic couplings.
    """
    for factors in _products([int(j) for j in moving]):
        odd = sum(bool(VARIABLES[k].odd) for k in factors) % 2 == 1
        if odd == (i in ODD) and factors not in ((i, i, i), (SIGN + i,)):
            yield LawTerm(i, factors)


def _products(axes: Sequence[int]) -> Iterator[tuple[int, ...]]:
    for j in axes:
        yield from ((SIZE + j,), (SIGN + j,), (j, j), (j, j, j), (SPEED, j))
        if j < 3:
            yield from ((DIRECTION, j), (SPEED, SPEED, j))
    for j, k in combinations(axes, 2):
        yield from ((j, k), (SIZE + j, k), (j, SIZE + k), (SIZE + j, SIZE + k))
        yield from ((j, j, k), (j, k, k))
    x, y, z = range(DOWN, DOWN + 3)
    for k in (x, y, z, SIGN_OF_DOWN, SIGN_OF_DOWN + 1):
        yield (k,)
    yield from ((x, y), (x, z), (y, z), (x, x), (y, y))


def _along_world() -> Iterator[LawTerm]:
    """Forces and flows whose direction is fixed in the tank; a uniform flow is a current."""
    for on in (*range(WORLD, WATER), WATER, WATER + 1):
        for factors in ((), (NORTH,), (EAST,), (NORTH, NORTH), (EAST, EAST), (NORTH, EAST)):
            if factors or on in (WORLD, WORLD + 1):
                yield LawTerm(on, factors)
    yield LawTerm(WORLD + 2, (DEEP,))
    yield LawTerm(WORLD + 2, (DEEP, DEEP))
    yield LawTerm(SWIRL, ())
    for i in range(3):
        yield from (LawTerm(i, (i, k)) for k in (NORTH, EAST, DEEP))


def _at(place: tuple[float, float]) -> Iterator[LawTerm]:
    """What acts near one place."""
    for on in (WORLD, WORLD + 1, WORLD + 2, WATER, WATER + 1, SWIRL):
        yield LawTerm(on, (NEAR,), place)
    for i in range(3):
        yield LawTerm(i, (NEAR, i), place)


def list_places(runs: Sequence[ObservedRun]) -> list[tuple[float, float]]:
    """Places (north, east) on a grid that the vehicle came by, the most visited first."""
    path = np.concatenate([run.motion.state[run.motion.usable, :2] for run in runs])
    cells, count = np.unique(np.round(path / SPACING).astype(int), axis=0, return_counts=True)
    order = np.argsort(-count, kind="stable")[:MOST_PLACES]
    return [(float(n) * SPACING, float(e) * SPACING) for n, e in cells[order]]


def middle_of(runs: Sequence[ObservedRun]) -> Array:
    """Mean place (3,) NED m of all runs, and the width m that is tried first."""
    path = np.concatenate([run.motion.state[run.motion.usable, :3] for run in runs])
    return np.append(np.mean(path, axis=0), WIDTH)


def drag_of(model: Model) -> tuple[Array, Array]:
    """Linear and quadratic drag (3,) of surge, sway and heave."""
    return model.body.linear[:3], model.body.quadratic[:3]


def push(terms: Sequence[LawTerm], run: ObservedRun, model: Model, middle: Array) -> Array:
    """Wrench (c, n, 6) of terms with a coefficient of 1 at the readings of a run.

    `middle`: place (3,) NED m and width m of terms that have none of their own.
    """
    return push_at(terms, earlier_states(run), model, middle)


def push_at(terms: Sequence[LawTerm], state: Array, model: Model, middle: Array) -> Array:
    """Wrench (c, n, 6) of terms with a coefficient of 1 at states (n, 13)."""
    R, nu = matrix(state[:, 3:7]), state[:, 7:10]
    linear, quadratic = drag_of(model)
    gain = linear + 2.0 * quadratic * np.abs(nu)  # d drag / d velocity of the water
    tables = {}
    wrenches = np.zeros((len(terms), len(state), 6))
    for out, term in zip(wrenches, terms, strict=True):
        if term.place not in tables:
            place = middle.copy()
            if term.place is not None:
                place[:2] = term.place
            tables[term.place] = tabulate(state, place)
        table = tables[term.place]
        value = np.prod(table[list(term.factors)], axis=0) if term.factors else np.ones(len(state))
        if term.on < WORLD:
            out[:, term.on] = value
        elif term.on < WATER:
            out[:, :3] = value[:, None] * R[:, term.on - WORLD, :]
        elif term.on < SWIRL:
            out[:, :3] = gain * value[:, None] * R[:, term.on - WATER, :]
        else:
            turning = -table[EAST, :, None] * R[:, 0, :] + table[NORTH, :, None] * R[:, 1, :]
            out[:, :3] = gain * value[:, None] * turning
    return wrenches
