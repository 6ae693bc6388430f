"""Effects that these runs could not show, were they there: what was not measured, or never moved.

Every tried effect has columns: how it would change what the filter could not foresee. Where even a
large change would gain less likelihood than its parameter costs, nothing can be said about it.
"""

from typing import Sequence

import numpy as np

from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.selection.candidates import list_means
from rovsim.diagnosis.selection.proposals import TRUSTED
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Means
from rovsim.dynamics.vehicle import Vehicle

LOGGED: tuple[Means, ...] = ("commands", "demands")  # without a log of them, not observable


def list_not_observable(
    workspace: SearchWorkspace, catalogue: Catalogue, vehicle: Vehicle
) -> tuple[str, ...]:
    """Ids of the tried effects that the runs cannot show, in the order of the catalogue.

    Those that need a part which the vehicle does not have are not among them.
    """
    runs = workspace.bank.runs
    shown, tried = _find_shown(workspace)
    silent = (tried - shown) | _find_unlogged(runs, catalogue, vehicle)
    return tuple(name for name in catalogue.on(vehicle) if name in silent)


def _find_shown(workspace: SearchWorkspace) -> tuple[set[str], set[str]]:
    """Effects some of whose columns can pay their price, and all that have columns."""
    needed = np.sqrt(workspace.price) / TRUSTED  # at one scale
    sizes = np.sqrt(np.diag(workspace.inner_products))
    shown, tried = set(), set()
    for block in workspace.sensitivities.blocks:
        own = block.derivatives if block.secant is None else (block.secant,)
        tried.add(block.candidate.effect.id)
        if np.any(sizes[list(own)] > needed):
            shown.add(block.candidate.effect.id)
    return shown, tried


def _find_unlogged(runs: Sequence[ObservedRun], catalogue: Catalogue, vehicle: Vehicle) -> set[str]:
    """Effects that act on commands of a kind that nobody logged."""
    means = list_means(runs, vehicle)
    needed = (*LOGGED, *(("thrusters",) if vehicle.thrusters.units else ()))
    return {
        name for name, effect in catalogue.on(vehicle).items()
        if effect.through in needed and effect.through not in means
    }  # fmt: skip
