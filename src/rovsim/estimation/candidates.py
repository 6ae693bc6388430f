"""What may be missing: every effect of the catalogue, from each of its starting values."""

from dataclasses import dataclass, field
from typing import Mapping, Sequence

import numpy as np

from rovsim.core.errors import BadInput
from rovsim.core.run import Site
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import (
    Effect,
    MeasurementFilter,
    Parameter,
    Requirement,
    StochasticCurrent,
    Wrench,
)
from rovsim.dynamics.vehicle import Vehicle
from rovsim.estimation.observer.hypothesis import Term
from rovsim.estimation.observer.observed_run import ObservedRun

DIGITS = 6  # of a command: closer ones differ by rounding errors


@dataclass(frozen=True, eq=False)
class Candidate:
    """An effect that may be missing, at the values that a fit starts from.

    Attributes:
        effect: its class; at its defaults it changes nothing.
        start: with the values that a fit starts from.
        free: names of the parameters that are fitted.
        resolutions: of its thresholds, by name, as far as the command logs tell values apart.
    """

    effect: type[Effect]
    start: Effect
    free: tuple[str, ...]
    resolutions: Mapping[str, float] = field(default_factory=dict)

    @property
    def absent(self) -> bool:
        """Whether the effect changes nothing at its start: each column is then judged by itself."""
        return not self.start.given()

    @property
    def thresholds(self) -> list[Parameter]:
        """Free parameters that are thresholds: values are tried, since derivatives tell nothing."""
        return [p for p in self.effect.parameters if p.tried and p.name in self.free]

    @property
    def sloped(self) -> tuple[str, ...]:
        """Free parameters whose derivatives are of use: all but thresholds."""
        return tuple(k for k in self.free if k not in {p.name for p in self.thresholds})

    def term(self, free: Sequence[str] | None = None) -> Term:
        """The candidate as a term of a hypothesis, with all or only some parameters free."""
        names = self.free if free is None else tuple(free)
        return Term(self.start, names, resolutions=self.resolutions)


def list_candidates(
    runs: Sequence[ObservedRun], catalogue: Catalogue, vehicle: Vehicle
) -> list[Candidate]:
    """All candidates that could act in these runs of a vehicle."""
    site, means = runs[0].motion.site, list_means(runs, vehicle)
    log_step = find_log_step(runs)
    candidates = []
    for cls in catalogue.on(vehicle).values():
        if issubclass(cls, MeasurementFilter | StochasticCurrent):
            continue  # camera.py and drifting_current.py look for these
        if cls.requires not in means:
            continue
        # as for pulses in whole microseconds: two steps of a log, between which no command lies
        resolutions = {p.name: max(p.resolution, 2.0 * log_step) for p in cls.parameters if p.tried}
        for values in _list_starts(cls, site):
            start = cls(**values)
            if _can_act(start, runs):
                candidates.append(Candidate(cls, start, cls.free_at(values), resolutions))
    return candidates


def find_log_step(runs: Sequence[ObservedRun]) -> float:
    """The least difference between two sizes of logged thruster commands; 0 where there is none.

    A log of percents or of pulses in steps of 5 us tells no thresholds apart that lie between them.
    """
    logs = [run.motion.commands for run in runs]
    sizes = [np.empty(0), *(np.abs(c.value).ravel() for c in logs if c.kind == "thruster")]
    differing = np.diff(np.unique(np.round(np.concatenate(sizes), DIGITS)))
    return float(np.min(differing)) if len(differing) else 0.0


def _list_starts(cls: type[Effect], site: Site) -> list[dict[str, float]]:
    """Where fits of an effect begin; thresholds at each value that is tried."""
    starts = list(cls.starts_at(site))
    for p in cls.parameters:
        if p.tried:
            combinations = [start | {p.name: value} for start in starts for value in p.tried]
            starts = [
                start for k, start in enumerate(combinations) if start not in combinations[:k]
            ]
    return starts


def list_means(runs: Sequence[ObservedRun], vehicle: Vehicle) -> set[Requirement]:
    """Through what effects can act in these runs of a vehicle: thrusters, surfaces, demands, …"""
    commands = [source.motion.commands for source in runs if len(source.motion.commands.time)]
    kinds = {source.kind for source in commands}
    conditions: dict[Requirement, object] = {
        "nothing": True,
        "commands": commands,
        "demands": "demand" in kinds,
        "thrusters": kinds - {"wrench"},
        "surfaces": True,
        "waterplane": True,
    }
    return {means for means, met in conditions.items() if met} - vehicle.lacking


def _can_act(start: Effect, runs: Sequence[ObservedRun]) -> bool:
    """Whether all runs have what the effect needs."""
    logged = [set(run.motion.commands.auxiliary) for run in runs]
    if isinstance(start, Wrench) and not all(
        set(start.channels) <= channels for channels in logged
    ):
        return False
    try:
        for run in runs:
            start.check(run.motion.site, run.motion.commands.kind)
    except BadInput:
        return False
    return True
