"""Effects that these runs could not show, were they there: what was not measured, or never moved.

Every tried effect has columns: how it would change what the filter could not foresee. Where a
change worth looking for would often gain less likelihood than its parameter costs, nothing can be
said.
A loop on board takes demands from the mixer, so that thrusters may hardly push at all: beside one,
what acts through them is looked at anew.
"""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Requirement, StochasticCurrent
from rovsim.dynamics.effects.parameters import REFERENCE_MASS
from rovsim.dynamics.vehicle import Vehicle
from rovsim.estimation.candidates import list_means
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.sensitivities import CandidateColumns

DETECTION_STDS = 2.0  # standard deviations: found in 97 of 100 such recordings
OF_SIZE = ("N", "kg")  # units of what a larger vehicle has more of
USUAL = 2.5  # scales of a threshold: ESCs stop at 0.06; that a band of 0.3 would show tells nothing
LOGGED: tuple[Requirement, ...] = ("commands", "demands")  # without a log of them, not observable


def list_not_observable(
    selection: SearchResult, catalogue: Catalogue, vehicle: Vehicle
) -> tuple[str, ...]:
    """Ids of the tried effects that the runs cannot show, in the order of the catalogue.

    Those that need a part which the vehicle does not have are not among them.
    """
    workspace = selection.workspace
    runs = workspace.bank.runs
    blocks, base = workspace.sensitivities.blocks, workspace.sensitivities.base_model
    larger = max(1.0, vehicle.rigid_body.mass / REFERENCE_MASS)
    shown = find_shown(workspace.columns.sizes(Hypothesis(base)), blocks, workspace.penalty, larger)
    if selection.best.hypothesis.model.thrust_path.autopilots:
        driven = [block for block in blocks if block.candidate.effect.requires == "thrusters"]
        sizes = workspace.columns.sizes(selection.best.hypothesis)
        shown |= find_shown(sizes, driven, workspace.penalty, larger)
    silent = {name for name, yes in shown.items() if not yes}
    silent |= _find_unlogged(runs, catalogue, vehicle)
    if not workspace.bank.shows_drift(workspace.noise):
        silent |= {
            name for name, effect in catalogue.items() if issubclass(effect, StochasticCurrent)
        }
    silent -= {term.id for term in selection.best.hypothesis.terms}
    silent -= {rival.effect for rival in selection.named_rivals}  # tried in the place of a name
    return tuple(name for name in catalogue.on(vehicle) if name in silent)


def find_shown(
    sizes: Array, blocks: Sequence[CandidateColumns], penalty: float, larger: float
) -> dict[str, bool]:
    """Of each effect, whether a column, `sizes` (c,) long at one scale, surely is worth it.

    `larger`: than what the scales are for, that many times, is the vehicle.
    """
    needed = np.sqrt(penalty) + DETECTION_STDS
    shown: dict[str, bool] = {}
    for block in blocks:
        name = block.candidate.effect.id
        told = any(sizes[k] * more > needed for k, more in _list_telling(block, larger))
        shown[name] = shown.get(name, False) or told
    return shown


def _list_telling(block: CandidateColumns, larger: float) -> list[tuple[int, float]]:
    """The columns by any of which an effect shows, and how many scales are worth looking for."""
    candidate = block.candidate
    if block.secant is not None:
        given = candidate.start.given()
        wide = any(p.size(given[p.name]) > USUAL * p.scale for p in candidate.thresholds)
        return [] if wide else [(block.secant, 1.0)]
    units = {p.name: p.unit for p in candidate.effect.parameters}
    each = zip(candidate.sloped, block.derivatives, strict=True)
    return [
        (column, larger if units[name].startswith(OF_SIZE) else 1.0)
        for name, column in each
        if name in (candidate.effect.telling or (name,))
    ]


def _find_unlogged(runs: Sequence[ObservedRun], catalogue: Catalogue, vehicle: Vehicle) -> set[str]:
    """Effects that act on commands of a kind that nobody logged."""
    means = list_means(runs, vehicle)
    needed = (*LOGGED, *(("thrusters",) if vehicle.thrusters.units else ()))
    return {
        name
        for name, effect in catalogue.on(vehicle).items()
        if effect.requires in needed and effect.requires not in means
    }
