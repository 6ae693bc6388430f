"""Does the current wander? Told from innovations, and from other pushes that wander."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.core.odds import lr_statistic_of
from rovsim.dynamics.effects.current import CurrentDrift
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.innovations import accelerate, observe
from rovsim.estimation.observer.noise import CurrentPath, RunFilters, whiten_run
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.random_walk import RandomWalk, WalkRate, fit_common, list_terms
from rovsim.simulation.measured_states import undo_mocap_view

CURRENT_STEP = 0.05  # m/s, a usual current
TYPICAL_RATE = 0.005  # m/s per sqrt(s), a usual drift, or N per sqrt(s)
# Likelihood-ratio statistic. Where no current wandered, physics outside of the catalogue reached 4
# in eight of nine development cases, and a jet in one corner 11 (a force along the tank 330);
# where one did, it was thousands.
MIN_LR_OF_DRIFT = 25.0
# Along the way of a vehicle: an eddy a sixth as wide as the tank is seen.
MAX_HALF_WAVES = 6
MIN_EXTENT = 1e-9  # m
# Against a force that wanders, along the tank or along the body.
MIN_LR_MARGIN = lr_statistic_of(odds=1000.0)


class DriftFit(NamedTuple):
    """The likeliest drift of the current, and by how much it is likelier than what else may wander.

    `lr_margin`: its likelihood-ratio statistic less that of what else comes close, if that does.
    """

    rate: WalkRate
    lr_margin: float

    @property
    def sure(self) -> bool:
        """Whether the current wanders."""
        return self.rate.lr_statistic > MIN_LR_OF_DRIFT and self.lr_margin > MIN_LR_MARGIN


AccelerationsOnRun = Callable[[Model, ObservedRun], Array]


@dataclass(frozen=True, eq=False)
class MovingWater:
    """A model that runs along the measurement, corrected by filters, in water that moves.

    All is linearised about `paths` of the current; without them it rests.
    """

    model: Model
    runs: tuple[ObservedRun, ...]
    run_filters: tuple[RunFilters, ...]
    paths: tuple[CurrentPath, ...] = ()

    @cached_property
    def walk(self) -> RandomWalk:
        """A current that wanders, north and east."""
        return self._walk(self._per_current)

    @cached_property
    def _per_current(self) -> list[Array]:
        """Accelerations (2, n, 6) of each run per m/s of a faster current."""
        pairs = zip(self.runs, self._currents, strict=True)
        return [differentiate_by_current(self.model, run, current) for run, current in pairs]

    @cached_property
    def bends(self) -> list[Array]:
        """Accelerations (n, 6) of each run that the current's own size adds to its linear push.

        Drag grows with the square of the speed through the water, so that a push found about still
        water is wrong by some newtons where the water moves at 0.1 m/s.
        """
        if not self.paths:
            return [np.zeros((len(run.time), 6)) for run in self.runs]
        accelerations = []
        for run, current, linear in zip(self.runs, self._currents, self._per_current, strict=True):
            in_still_water = _accelerate(self.model, run, np.zeros_like(current))
            change = _accelerate(self.model, run, current) - in_still_water
            accelerations.append(change - np.einsum("dni,nd->ni", linear, current))
        return accelerations

    @property
    def _currents(self) -> list[Array]:
        """The current (n, 2) at the readings of each run."""
        if not self.paths:
            return [np.zeros((len(run.time), 2)) for run in self.runs]
        return [path.at(run.time) for run, path in zip(self.runs, self.paths, strict=True)]

    def find_drift(self, z: Sequence[Array], run_filters: Sequence[RunFilters]) -> DriftFit:
        """How the current most likely wanders.

        Args:
            z: innovations (6, m) of each run, whitened axis by axis.
            run_filters: the filters that made them so.
        """
        rate = self.walk.fit_rate(z, run_filters)
        if rate.lr_statistic < MIN_LR_OF_DRIFT:
            return DriftFit(rate, rate.lr_statistic)
        force_statistics = [force.fit_rate(z, run_filters).lr_statistic for force in self._forces]
        by_place = self._lr_by_place(z, run_filters, self._by_lines)
        if not self.paths:  # about its own path what wanders is always likelier than a steady flow
            flow = self._lr_by_place(z, run_filters, self._by_eddies)
            if flow - rate.lr_statistic > MIN_LR_MARGIN:
                return DriftFit(rate, rate.lr_statistic - flow)
        return DriftFit(rate, rate.lr_statistic - max(0.0, by_place, *force_statistics))

    def varies_with_place(self, z: Sequence[Array], run_filters: Sequence[RunFilters]) -> bool:
        """Whether a steady flow through the tank may be what seems to wander: an eddy, a jet."""
        rate = self.walk.fit_rate(z, run_filters)
        flow = self._lr_by_place(z, run_filters, self._by_eddies)
        return rate.lr_statistic - flow < MIN_LR_MARGIN

    @cached_property
    def _forces(self) -> list[RandomWalk]:
        """Forces that wander."""
        forces = ([evaluate(self.model, run) for run in self.runs] for evaluate in _FORCES)
        return [self._walk(accelerations) for accelerations in forces]

    @cached_property
    def _by_lines(self) -> list[Array]:
        return self._show_flow(_lines(self.runs))

    @cached_property
    def _by_eddies(self) -> list[Array]:
        return self._show_flow(_eddies(self.runs))

    def _show_flow(self, fields: Sequence[Array]) -> list[Array]:
        """Innovations (2 k, 6, n) of each run by each part of a steady flow.

        `fields` (k, n) of each run: how each part of it varies along the way.
        """
        inputs = zip(
            self.runs, self.run_filters, fields, self._per_current, self.bends, strict=True
        )
        return [self._show(*run_inputs) for run_inputs in inputs]

    def _lr_by_place(
        self, z: Sequence[Array], run_filters: Sequence[RunFilters], shown: Sequence[Array]
    ) -> float:
        """Likelihood-ratio statistic of a current that is steady, of another size at every place.

        A vehicle that moves through it meets a current that wanders. `shown`: by each part of it.
        """
        inputs = zip(shown, self.runs, self.run_filters, run_filters, strict=True)
        return fit_common([whiten_run(*run_inputs) for run_inputs in inputs], z).lr_statistic

    def shows_drift(self, run_filters: Sequence[RunFilters]) -> bool:
        """Whether a drift worth looking for would be told from none."""
        (rate,) = CurrentDrift.parameters
        return self.walk.expected_lr(rate.scale, run_filters) > MIN_LR_OF_DRIFT

    def _walk(self, per_unit: Sequence[Array]) -> RandomWalk:
        inputs = zip(self.runs, self.run_filters, per_unit, self.bends, strict=True)
        columns = (
            self._show(run, filters, list_terms(run), *per_unit_and_bend)
            for run, filters, *per_unit_and_bend in inputs
        )
        return RandomWalk(self.runs, tuple(columns), self.run_filters)

    def _show(
        self, run: ObservedRun, filters: RunFilters, terms: Array, per_unit: Array, bend: Array
    ) -> Array:
        """Innovations (k d, 6, n) by terms (k, n) along pushes (d, n, 6)."""
        unit_accelerations = (terms[:, None, :, None] * per_unit).reshape(-1, *bend.shape)
        accelerations = np.concatenate([bend[None], bend + TYPICAL_RATE * unit_accelerations])
        e = observe([self.model] * len(accelerations), run, filters, accelerations)
        return np.asarray((e[0] - e[1:]) / TYPICAL_RATE)  # what a model does not foresee


def _places(runs: Sequence[ObservedRun]) -> list[Array]:
    """Place (3, n) in m at the readings of each run."""
    return [np.nan_to_num(run.motion.eta[run.innovation_samples, :3].T) for run in runs]


def _lines(runs: Sequence[ObservedRun]) -> list[Array]:
    """One and the place in m from their middle (4, n) at the readings of each run."""
    places = _places(runs)
    middle = np.mean(np.hstack(places), axis=1, keepdims=True)
    return [np.vstack([np.ones(p.shape[1]), p - middle]) for p in places]


def _eddies(runs: Sequence[ObservedRun]) -> list[Array]:
    """Half waves (k, n) along both sides of where the vehicles were, and the depth."""
    places = _places(runs)
    low, high = (f(np.hstack(places), axis=1)[:, None] for f in (np.min, np.max))
    waves = [(k, j) for k in range(MAX_HALF_WAVES + 1) for j in range(MAX_HALF_WAVES + 1 - k)]

    def vary(place: Array) -> Array:
        x, y, z = (place - low) / np.maximum(high - low, MIN_EXTENT)
        modes = [np.cos(np.pi * k * x) * np.cos(np.pi * j * y) / (1 + k + j) for k, j in waves]
        return np.stack([*modes, z - 0.5])

    return [vary(place) for place in places]


def differentiate_by_current(model: Model, run: ObservedRun, current: Array) -> Array:
    """Accelerations (2, n, 6) per m/s by which the water moves faster north, and east."""
    accelerations = []
    for step in CURRENT_STEP * np.eye(2):
        ahead, back = (_accelerate(model, run, current + sign * step) for sign in (1.0, -1.0))
        accelerations.append((ahead - back) / (2.0 * CURRENT_STEP))
    return np.stack(accelerations)


def _accelerate(model: Model, run: ObservedRun, current: Array) -> Array:
    """Accelerations (n, 6) at the measured states in water that moves by `current` (n, 2).

    A vehicle in a uniform current moves as it would, relative to it, in still water (Fossen 2021,
    property 10.1): no effect need know of it.
    """
    states = undo_mocap_view(model, run.motion).state[run.innovation_samples]
    states = np.where(np.isfinite(states).all(axis=1)[:, None], states, _AT_REST)
    water = np.column_stack([current, np.zeros(len(current))])
    in_body = np.einsum("nij,ni->nj", rotations.matrix(states[:, 3:7]), water)
    states[:, 7:10] -= in_body
    accelerations = accelerate(model, run, run.innovation_samples, states[None])[0]
    # the current as seen from a body that turns
    accelerations[:, :3] += np.cross(in_body, states[:, 10:])
    return accelerations


def _accelerate_along_tank(model: Model, run: ObservedRun) -> Array:
    """Accelerations (2, n, 6) per newton to the north, and to the east."""
    R = rotations.matrix(run.motion.state[run.innovation_samples, 3:7])
    wrench = np.zeros((2, len(R), 6))
    wrench[:, :, :3] = R[:, :2].swapaxes(0, 1)
    return np.asarray(np.nan_to_num(wrench) @ model.body.M_inv.T)


def _accelerate_along_body(axes: Sequence[int]) -> AccelerationsOnRun:
    """Accelerations (d, n, 6) of 1 m/s2 along some axes of the body."""

    def evaluate(model: Model, run: ObservedRun) -> Array:
        rows = np.zeros((len(axes), len(run.innovation_samples), 6))
        for row, axis in zip(rows, axes, strict=True):
            row[:, axis] = 1.0
        return rows

    return evaluate


_AT_REST = np.eye(13)[3]
_FORCES = (_accelerate_along_tank, *map(_accelerate_along_body, ((0, 1), (0,), (1,))))
