"""List the candidate terms of a law, and evaluate the wrench of each.

Every coefficient has the unit that makes its term a force, a moment or a flow. A term along an axis
of the body has to change sign as that axis does when port and starboard are exchanged.
Accelerations are not used as factors: a force proportional to an acceleration is inertia, which the
catalogue has, and the engine knows the accelerations only once it knows all forces.
"""

from dataclasses import dataclass
from itertools import combinations
from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import matrix
from rovsim.diagnosis.equations.products.variables import LATERAL_AXES, VARIABLES, tabulate
from rovsim.diagnosis.structure.regressors import earlier_states
from rovsim.dynamics.laws.codes import (
    DEPTH,
    DIRECTION,
    DOWN,
    EAST,
    NEARNESS,
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

# m: grid of places tried, and width of each; a fit changes both.
GRID_SPACING_M, PLACE_WIDTH_M = 1.0, 0.6
MAX_PLACES = 60  # on the grid: those where the vehicle was most often


@dataclass(frozen=True)
class LawTerm:
    """A candidate term: a product of factors that acts on something.

    Attributes:
        on: code (`laws.codes`) of what the term acts on.
        factors: codes of the factors; none for a constant.
        place: m north and east in NED, of a term that fades away from a place.
    """

    on: int
    factors: tuple[int, ...]
    place: tuple[float, float] | None = None

    @property
    def kind(self) -> tuple[int, tuple[int, ...]]:
        """What the term acts on, and its factors: the same for terms that differ only by place."""
        return self.on, self.factors


KnownPlace = tuple[float | None, float | None]  # m north and east of a law's place, or None


def list_terms(
    runs: Sequence[ObservedRun], known_place: KnownPlace = (None, None)
) -> list[LawTerm]:
    """List all candidate terms that runs could show.

    Terms along axes of the world and those of a place are only listed if all axes in which the
    vehicle can move were measured.

    Args:
        runs: the runs.
        known_place: coordinates that the law's place has already. All terms of a law share one
            place, so only places with these coordinates are listed.
    """
    moving = np.flatnonzero(np.logical_and.reduce([run.axes for run in runs]))
    terms = [term for i in moving for term in list_body_terms(int(i), moving)]
    if not all((run.axes | ~run.free_axes.astype(bool)).all() for run in runs):
        return terms
    n, e = known_place
    positions = [(a if n is None else n, b if e is None else e) for a, b in list_places(runs)]
    places = list(dict.fromkeys(positions))
    return [*terms, *_along_world(), *(t for place in places for t in _list_near(place))]


def list_body_terms(i: int, moving: Array) -> Iterator[LawTerm]:
    """Yield terms along axis `i` of the body that respect the mirror symmetry of the vehicle.

    Terms that the catalogue has are left out: drags of the axis' own velocity alone, linear and
    quadratic couplings to the velocity of another axis, and what is about proportional to the
    direction of gravity (weight, buoyancy and its centre).

    Args:
        i: the axis (0 to 5).
        moving: numbers of the axes in which the vehicle moves and is measured.
    """
    for factors in _products([int(j) for j in moving]):
        odd = sum(bool(VARIABLES[k].odd) for k in factors) % 2 == 1
        if odd == (i in LATERAL_AXES) and factors not in ((i, i, i), (SIGN + i,)):
            yield LawTerm(i, factors)


def _products(axes: Sequence[int]) -> Iterator[tuple[int, ...]]:
    """Yield products of velocities along these axes and of attitude, as codes of the factors."""
    for j in axes:
        yield from ((SIZE + j,), (SIGN + j,), (j, j), (j, j, j), (SPEED, j))
        if j < 3:
            yield from ((DIRECTION, j), (SPEED, SPEED, j))
    for j, k in combinations(axes, 2):
        yield from ((j, k), (SIZE + j, k), (j, SIZE + k), (SIZE + j, SIZE + k))
        yield from ((j, j, k), (j, k, k))
    x, y = DOWN, DOWN + 1
    for k in (SIGN_OF_DOWN, SIGN_OF_DOWN + 1):
        yield (k,)
    yield from ((x, y), (x, x), (y, y))


def _along_world() -> Iterator[LawTerm]:
    """Yield terms whose direction or strength is fixed in the tank.

    These are constant forces north and east, forces and flows along NED axes that vary with place,
    water that turns about a place, and drags that vary with place. A uniform flow is left out: it
    is a current.
    """
    for on in (*range(WORLD, WATER), WATER, WATER + 1):
        for factors in ((), (NORTH,), (EAST,), (NORTH, NORTH), (EAST, EAST), (NORTH, EAST)):
            if factors or on in (WORLD, WORLD + 1):
                yield LawTerm(on, factors)
    yield LawTerm(WORLD + 2, (DEPTH,))
    yield LawTerm(WORLD + 2, (DEPTH, DEPTH))
    yield LawTerm(SWIRL, ())
    for i in range(3):
        yield from (LawTerm(i, (i, k)) for k in (NORTH, EAST, DEPTH))


def _list_near(place: tuple[float, float]) -> Iterator[LawTerm]:
    """Yield forces, flows and drags near a place, m north and east."""
    for on in (WORLD, WORLD + 1, WORLD + 2, WATER, WATER + 1, SWIRL):
        yield LawTerm(on, (NEARNESS,), place)
    for i in range(3):
        yield LawTerm(i, (NEARNESS, i), place)


def list_places(runs: Sequence[ObservedRun]) -> list[tuple[float, float]]:
    """List places on a grid that the vehicle visited, m north and east, the most visited first."""
    path = np.concatenate([run.motion.state[run.motion.usable, :2] for run in runs])
    cells, count = np.unique(
        np.round(path / GRID_SPACING_M).astype(int), axis=0, return_counts=True
    )
    order = np.argsort(-count, kind="stable")[:MAX_PLACES]
    return [(float(n) * GRID_SPACING_M, float(e) * GRID_SPACING_M) for n, e in cells[order]]


def middle_of(runs: Sequence[ObservedRun]) -> Array:
    """Mean position (3,) in NED of all runs and the width tried first, m, as one array (4,)."""
    path = np.concatenate([run.motion.state[run.motion.usable, :3] for run in runs])
    return np.append(np.mean(path, axis=0), PLACE_WIDTH_M)


def drag_of(model: Model) -> tuple[Array, Array]:
    """Linear (3,) and quadratic (3,) drag of surge, sway and heave, N s/m and N s2/m2."""
    return model.body.linear[:3], model.body.quadratic[:3]


def evaluate_wrenches(
    terms: Sequence[LawTerm], run: ObservedRun, model: Model, middle: Array
) -> Array:
    """Evaluate terms with a coefficient of 1 at the n readings of a run.

    The states are those measured a little before each reading, see `earlier_states`. For arguments
    and result see `evaluate_wrenches_at`.
    """
    return evaluate_wrenches_at(terms, earlier_states(run), model, middle)


def evaluate_wrenches_at(
    terms: Sequence[LawTerm], state: Array, model: Model, middle: Array
) -> Array:
    """Evaluate terms with a coefficient of 1 at given states.

    A flow acts through the drag, which is linearised about still water.

    Args:
        terms: c terms.
        state: (n, 13) position in NED m, quaternion body to world, body velocity m/s and rad/s.
        model: gives the drag.
        middle: (4,) place in NED and width, m, of terms that have none of their own.

    Returns:
        Wrenches (c, n, 6) along the body axes (FRD).
    """
    R, nu = matrix(state[:, 3:7]), state[:, 7:10]
    linear, quadratic = drag_of(model)
    gain = linear + 2.0 * quadratic * np.abs(nu)  # d force / d velocity of the water
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
