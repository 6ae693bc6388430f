"""Find effects that the runs could not show, as too little was measured, moved or commanded.

Every tried effect has columns: how much it would change the innovations of the filter. If a change
of a size worth looking for would often raise the likelihood by less than the penalty of its
parameter, the search could not find the effect, and nothing can be said about it.

A control loop on board changes what the mixer is told, so that thrusters may hardly push at all.
If such a loop was accepted, effects that act through thrusters are judged once more beside it.
"""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import REFERENCE_MASS, Requirement, StochasticCurrent
from rovsim.dynamics.vehicle import Vehicle
from rovsim.estimation.candidates import list_means
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.sensitivities import CandidateColumns

DETECTION_STDS = 2.0  # standard deviations: found in 97 of 100 such recordings
# How units begin of parameters that grow with the size of a vehicle.
SIZE_DEPENDENT_UNITS = ("N", "kg")
# Scales of a threshold. ESCs stop at 0.06: that a deadband of 0.3 would show says nothing of that.
MAX_THRESHOLD_SCALES = 2.5
# not observable where nobody logged them
LOG_REQUIREMENTS: tuple[Requirement, ...] = ("commands", "demands", "thrusters")


def list_not_observable(
    selection: SearchResult, catalogue: Catalogue, vehicle: Vehicle
) -> tuple[str, ...]:
    """List the ids of effects that the runs cannot show, in the order of the catalogue.

    Effects of parts that the vehicle does not have are left out, and so are accepted effects and
    their rivals.

    Args:
        selection: the result of a search.
        catalogue: all effects.
        vehicle: the vehicle.
    """
    workspace = selection.workspace
    runs = workspace.bank.runs
    blocks, base = workspace.sensitivities.blocks, workspace.sensitivities.base_model
    mass_ratio = max(1.0, vehicle.rigid_body.mass / REFERENCE_MASS)
    observable = find_shown(
        workspace.columns.sizes(Hypothesis(base)), blocks, workspace.penalty, mass_ratio
    )
    if selection.best.hypothesis.model.thrust_path.autopilots:
        driven = [block for block in blocks if block.candidate.effect.requires == "thrusters"]
        sizes = workspace.columns.sizes(selection.best.hypothesis)
        observable |= find_shown(sizes, driven, workspace.penalty, mass_ratio)
    unobservable = {name for name, flag in observable.items() if not flag}
    unobservable |= _find_unlogged(runs, catalogue, vehicle)
    if not workspace.bank.shows_drift(workspace.noise):
        unobservable |= {
            name for name, effect in catalogue.items() if issubclass(effect, StochasticCurrent)
        }
    unobservable -= {term.id for term in selection.best.hypothesis.terms}
    # those tried instead of an accepted one
    unobservable -= {rival.effect for rival in selection.named_rivals}
    return tuple(name for name in catalogue.on(vehicle) if name in unobservable)


def find_shown(
    sizes: Array, blocks: Sequence[CandidateColumns], penalty: float, larger: float
) -> dict[str, bool]:
    """Tell of each effect whether the runs would show it.

    They would if a change worth looking for surely raises the likelihood by more than the penalty.

    Args:
        sizes: lengths (c,) of the whitened columns, for a change of each parameter by one scale.
        blocks: which columns belong to which effect.
        penalty: of a parameter, in twice the log likelihood.
        larger: how many times heavier the vehicle is than the one that the scales are meant for.
    """
    threshold = np.sqrt(penalty) + DETECTION_STDS
    observable: dict[str, bool] = {}
    for block in blocks:
        name = block.candidate.effect.id
        detectable = any(
            sizes[k] * factor > threshold for k, factor in _list_telling(block, larger)
        )
        observable[name] = observable.get(name, False) or detectable
    return observable


def _list_telling(block: CandidateColumns, larger: float) -> list[tuple[int, float]]:
    """List the columns by any of which an effect shows, each with the scales worth looking for.

    None where the effect was tried with an unusually large threshold: that it would show there does
    not say that it would show with a usual one.
    """
    candidate = block.candidate
    if block.secant is not None:
        values = candidate.start.given()
        too_large = any(
            p.size(values[p.name]) > MAX_THRESHOLD_SCALES * p.scale for p in candidate.thresholds
        )
        return [] if too_large else [(block.secant, 1.0)]
    units = {p.name: p.unit for p in candidate.effect.parameters}
    pairs = zip(candidate.sloped, block.derivatives, strict=True)
    return [
        (column, larger if units[name].startswith(SIZE_DEPENDENT_UNITS) else 1.0)
        for name, column in pairs
        if name in (candidate.effect.telling or (name,))
    ]


def _find_unlogged(runs: Sequence[ObservedRun], catalogue: Catalogue, vehicle: Vehicle) -> set[str]:
    """Find the ids of effects that act on a kind of commands that nobody logged."""
    means = list_means(runs, vehicle)
    return {
        name
        for name, effect in catalogue.on(vehicle).items()
        if effect.requires in LOG_REQUIREMENTS and effect.requires not in means
    }
