"""The candidates' columns, whitened under one noise, with the accepted effects in place.

Columns of one noise can be converted to those of another. But loops on board take demands from the
mixer, so that thrusters push differently beside them. All columns are then made anew, once for each
set of loops.
"""

from dataclasses import dataclass, field
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.model import Model
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import gram, project_out
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.residual_source import Linearised
from rovsim.estimation.sensitivities import Sensitivities, relinearise_candidates

# Of the square of a derivative: if one has turned by more, the accepted effects changed columns.
# Chosen on a marker 0.1 m beside CO, which turned its own by 0.2: one drag passed for another.
MAX_TURNED_SQUARE = 0.1
# Of a column's own square, in six digits: what free parameters leave less of is theirs.
MIN_UNEXPLAINED_SHARE = 1e-6


class _White(NamedTuple):
    """Columns (c, m) of the candidates, white, and their Gram matrix (c, c)."""

    columns: Array
    gram: Array


@dataclass(frozen=True, eq=False)
class WhiteColumns:
    """The candidates' columns under one noise.

    Attributes:
        bank: the runs, and filters that suit the noise.
        sensitivities: the columns as they were last linearised, beside the loops of the base.
        noise: under which the columns are white.
    """

    bank: FilterBank
    sensitivities: Sensitivities
    noise: Noise
    _by_loops: dict[tuple, Sensitivities] = field(default_factory=dict)
    _white: dict[tuple, _White] = field(default_factory=dict)
    _grams: WeakKeyDictionary[Linearised, Array] = field(default_factory=WeakKeyDictionary)

    def under(self, bank: FilterBank, noise: Noise) -> "WhiteColumns":
        """The same columns under another noise, with filters that suit it."""
        return WhiteColumns(bank, self.sensitivities, noise, self._by_loops)

    def sensitivities_at(self, at: Hypothesis) -> Sensitivities:
        """The columns beside the loops on board that a hypothesis has; made once for such loops."""
        loops = _list_loops(at.model)
        if loops == _list_loops(self.sensitivities.base_model):
            return self.sensitivities
        if loops not in self._by_loops:
            self._by_loops[loops] = self._relinearise(at)
        return self._by_loops[loops]

    def relinearised(self, at: Hypothesis) -> "WhiteColumns":
        """The columns made anew with all effects of a hypothesis in place."""
        loops, sensitivities = _list_loops(at.model), self._relinearise(at)
        if loops == _list_loops(self.sensitivities.base_model):
            return WhiteColumns(self.bank, sensitivities, self.noise, self._by_loops)
        by_loops = self._by_loops | {loops: sensitivities}
        return WhiteColumns(self.bank, self.sensitivities, self.noise, by_loops)

    def _relinearise(self, at: Hypothesis) -> Sensitivities:
        bank = self.bank.redesign(at.model, self.noise)
        return relinearise_candidates(bank, at, self.sensitivities)

    def have_changed(self, linearised: Linearised) -> bool:
        """Whether the accepted effects have changed their own derivatives, and so perhaps others.

        Always False where axes drive each other: the columns are then made anew with every noise.
        """
        h = linearised.hypothesis
        if self.bank.coupled:
            return False
        by_name = {
            (block.candidate.effect.id, name): column
            for block in reversed(self.sensitivities_at(h).blocks)
            for name, column in zip(block.candidate.sloped, block.derivatives, strict=True)
        }
        names = [(term.id, name) for term in h.terms for name in term.free]
        pairs = [(k, by_name[name]) for k, name in enumerate(names) if name in by_name]
        rows = self.bank.flatten([J.astype(np.float32) for J in linearised.J], self.noise)
        columns = self._whiten(h).columns
        return any(_measure_turned(rows[k], columns[j]) > MAX_TURNED_SQUARE for k, j in pairs)

    def _whiten(self, at: Hypothesis) -> _White:
        loops = _list_loops(at.model)
        if loops not in self._white:
            sensitivities = self.sensitivities_at(at)
            columns = sensitivities.bank.flatten(sensitivities.columns, self.noise)
            self._white[loops] = _White(columns, gram(columns).astype(float))
        return self._white[loops]

    def sizes(self, at: Hypothesis) -> Array:
        """Lengths (c,) of the whitened columns, beside the loops on board of a hypothesis."""
        return np.sqrt(np.diag(self._whiten(at).gram))

    def gram(self, linearised: Linearised) -> Array:
        """Gram matrix (1 + c, 1 + c) of the innovations and the candidates' columns.

        What the free parameters of the hypothesis can explain is projected out of both. The result
        is kept, since proposals, swaps and a loose file all need it.
        """
        if linearised not in self._grams:
            self._grams[linearised] = self._multiply(linearised)
        return self._grams[linearised]

    def _multiply(self, linearised: Linearised) -> Array:
        rows = [row.astype(np.float32) for row in linearised.rows]
        white_rows = self.bank.flatten(rows, self.noise)
        columns, gram_columns = self._whiten(linearised.hypothesis)
        cross = white_rows @ columns.T
        G = np.block([[gram(white_rows), cross], [cross.T, gram_columns]])
        places = [0, *range(len(white_rows), len(G))]
        projected = project_out(G, range(1, len(white_rows)))[np.ix_(places, places)]
        explained = 1 + np.flatnonzero(
            np.diag(projected)[1:] < MIN_UNEXPLAINED_SHARE * np.diag(gram_columns)
        )
        projected[explained], projected[:, explained] = 0.0, 0.0
        projected.setflags(write=False)
        return projected


def _measure_turned(a: Array, b: Array) -> float:
    """Share of the square of a that is not along b."""
    return 1.0 - float((a @ b) ** 2 / max((a @ a) * (b @ b), 1e-30))


def _list_loops(model: Model) -> tuple:
    """Key of the loops on board: the demands that they take, and their modes; empty without any."""
    return tuple(
        (
            loop.mixer_demand(np.eye(6)).tobytes(),
            *(loop[p.name] for p in loop.parameters if not p.fitted),
        )
        for loop in model.thrust_path.autopilots
    )
