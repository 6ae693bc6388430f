"""What could be missing: every effect of the catalogue, from each of its starting values."""

from dataclasses import dataclass
from typing import Sequence

from rovsim.core.errors import BadInput
from rovsim.diagnosis.observer.hypothesis import Term
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect, Smoothing, Wander


@dataclass(frozen=True, eq=False)
class Candidate:
    """An effect at the values a fit starts from; at its defaults it changes nothing."""

    effect: type[Effect]
    start: Effect
    free: tuple[str, ...]

    @property
    def absent(self) -> bool:
        """Whether the start is the effect's absence: its columns can then be judged singly."""
        return not self.start.given()

    def term(self, free: Sequence[str] | None = None) -> Term:
        """The candidate as a term of a hypothesis, with all or only some parameters free."""
        return Term(self.start, self.free if free is None else tuple(free))


def list_candidates(runs: Sequence[ObservedRun], catalogue: Catalogue) -> list[Candidate]:
    """All candidates that these runs could show."""
    site = runs[0].motion.site
    found = []
    for cls in catalogue.values():
        if issubclass(cls, Smoothing | Wander):  # camera.py tells of the one, none of the other
            continue
        for values in cls.starts_at(site):
            start = cls(**values)
            if _can_act(start, runs):
                found.append(Candidate(cls, start, cls.free_at(values)))
    return found


def _can_act(start: Effect, runs: Sequence[ObservedRun]) -> bool:
    """Whether all runs have what the effect needs."""
    try:
        for one in runs:
            start.check(one.motion.site, one.motion.commands.kind)
    except BadInput:
        return False
    return True
