"""Candidate terms of an equation, and how each would show in what the model did not foresee.

Dimensions are kept since every coefficient has the unit that its term needs; what acts on the
vehicle along its own axes must turn with the mirror of port and starboard as its axis does.
Accelerations are no factors: a force proportional to one is inertia, which the catalogue has, and
the engine has none before all forces are known.
"""

from dataclasses import dataclass
from itertools import combinations
from typing import Any, Callable, Iterator, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.signal import lfilter

from rovsim.core.rotations import matrix
from rovsim.diagnosis.checks.regressors import earlier_states
from rovsim.diagnosis.equations.products.variables import (
    DEEP,
    DIRECTION,
    EAST,
    NEAR,
    NORTH,
    ODD,
    SPEED,
    SWIRL,
    VARIABLES,
    WATER,
    WORLD,
    tabulate,
)
from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.noise import RunFilters
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.model import Model

SPACING, WIDTH = 1.0, 0.6  # m: places tried, and how wide each is; the fit moves both
MOST_PLACES = 60
NEGLIGIBLE = 1e-9  # of an axis' acceleration per newton


@dataclass(frozen=True)
class LawTerm:
    """What a term acts on, and its factors, as `variables` numbers them.

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
        if odd == (i in ODD) and factors not in ((i, i, i), (12 + i,)):
            yield LawTerm(i, factors)


def _products(axes: Sequence[int]) -> Iterator[tuple[int, ...]]:
    for j in axes:
        yield from ((6 + j,), (12 + j,), (j, j), (j, j, j), (SPEED, j))
        if j < 3:
            yield from ((DIRECTION, j), (SPEED, SPEED, j))
    for j, k in combinations(axes, 2):
        yield from ((j, k), (6 + j, k), (j, 6 + k), (6 + j, 6 + k), (j, j, k), (j, k, k))
    for k in (18, 19, 20, 21, 22):
        yield (k,)
    yield from ((18, 19), (18, 20), (19, 20), (18, 18), (19, 19))


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


@dataclass(frozen=True, eq=False)
class Columns:
    """Terms, the size (c,) of each per unit coefficient, and inner products of what they do.

    `products` (1 + c, 1 + c) of whitened innovations and the terms' columns, each of unit size;
    what was fitted is projected out. One for all readings, and one `parts` for each block of time.
    `middle` (4,): place NED m and width m of terms that have none of their own.
    """

    terms: tuple[Any, ...]
    size: Array
    parts: tuple[Array, ...]
    middle: Array

    @property
    def products(self) -> Array:
        """Over all blocks."""
        return np.asarray(sum(self.parts))


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


def respond_to(pushes: Array, model: Model, run: ObservedRun, filters: RunFilters) -> Array:
    """How wrenches (c, n, 6) would show in whitened settled innovations (6, c, m) of a run."""
    accelerations = pushes @ model.body.M_inv.T
    out = np.zeros((6, len(pushes), int(run.settled.sum())), np.float32)
    whole = np.empty(pushes.shape[:2])
    for i in np.flatnonzero(run.axes):
        own = accelerations[:, :, i]
        acts = np.flatnonzero(np.abs(own).max(axis=1) > NEGLIGIBLE)
        if not len(acts):
            continue
        b, a = filters.filters[i].response
        for first, last in run.innovation_segments:
            whole[acts, first:last] = lfilter(b, a, own[acts, first:last], axis=1)
        out[i, acts] = whole[acts][:, run.settled]
    return out


Push = Callable[[Sequence[Any], ObservedRun, Model, Array], Array]  # as `push`


def project(
    terms: Sequence[Any],
    model: Model,
    bank: FilterBank,
    white: Array,
    fitted: Array,
    run_filters: Sequence[RunFilters],
    block: Array,
    middle: Array,
    push: Push = push,
) -> Columns:
    """Inner products of all terms' columns with what is left.

    Args:
        terms: the candidates.
        model: what they are added to.
        bank: the runs.
        white: whitened innovations (6, m) of all runs.
        fitted: derivatives (k, 6, m) of what was fitted, whose directions are left out.
        run_filters: filters that made them white, one for each run.
        block: number (m,) of the part of the runs that each lies in.
        middle: see `push`.
        push: wrenches of terms, if they are of another kind.
    """
    size = _measure_size(terms, model, bank.runs, middle, push)
    acts = np.flatnonzero(size > 0.0)
    kept = tuple(terms[int(k)] for k in acts)
    rows = 1 + len(acts) + len(fitted)
    parts = {int(k): np.zeros((rows, rows)) for k in np.unique(block)}
    first = 0
    for run, filters in zip(bank.runs, run_filters, strict=True):  # columns of one run at a time
        pushes = push(kept, run, model, middle) / size[acts, None, None]
        columns = respond_to(pushes, model, run, filters)
        at = slice(first, first + columns.shape[2])
        every = [white[:, None, at], columns, fitted[:, :, at].swapaxes(0, 1)]
        whole = np.concatenate(every, axis=1, dtype=np.float32)
        for k in np.unique(block[at]):
            own = whole[:, :, block[at] == k]
            parts[int(k)] += sum(axis @ axis.T for axis in own)
        first = at.stop
    own_parts = _without(list(parts.values()), 1 + len(acts))
    return Columns(kept, size[acts], tuple(own_parts), middle)


def _measure_size(
    terms: Sequence[Any], model: Model, runs: Sequence[ObservedRun], middle: Array, push: Push
) -> Array:
    """Root mean square (c,) of the wrench of each term with a coefficient of 1, over all runs."""
    square, count = np.zeros(len(terms)), 0
    for run in runs:
        own = push(terms, run, model, middle)
        square, count = square + np.sum(own**2, axis=(1, 2)), count + own.shape[1]
    return np.asarray(np.sqrt(square / count))


def _without(parts: Sequence[Array], kept: int) -> list[Array]:
    """Products (kept, kept) of each part, the directions behind those taken out as in the whole."""
    whole = np.asarray(sum(parts))
    if len(whole) == kept:
        return list(parts)
    H = whole[kept:, kept:]
    scale = np.sqrt(np.maximum(np.diag(H), 1e-300))
    along = -np.linalg.lstsq(
        H / np.outer(scale, scale), whole[kept:, :kept] / scale[:, None], 1e-9
    )[0]
    T = np.vstack([np.eye(kept), along / scale[:, None]])
    return [T.T @ part @ T for part in parts]
