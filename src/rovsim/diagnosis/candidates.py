"""What could be missing: every effect of the catalogue, from each of its starting values."""

from dataclasses import dataclass
from typing import Sequence

from rovsim.diagnosis.hypothesis import Term
from rovsim.diagnosis.watch import Watch
from rovsim.effects import catalogue
from rovsim.effects.base import Effect


@dataclass(frozen=True, eq=False)
class Candidate:
    """An effect at the values a fit starts from; at its defaults it changes nothing."""

    effect: type[Effect]
    start: Effect
    free: tuple[str, ...]

    @property
    def absent(self) -> bool:
        """Whether the start is the absence of the effect, where its columns can be judged singly."""
        return not self.start.given()

    def term(self, free: Sequence[str] | None = None) -> Term:
        """The candidate as a term of a hypothesis, with all or only some parameters free."""
        return Term(self.start, self.free if free is None else tuple(free))


def candidates(watches: Sequence[Watch]) -> list[Candidate]:
    """All candidates that these runs could show."""
    site = watches[0].motion.site
    kinds = {w.motion.commands.kind for w in watches}
    found = []
    for cls in catalogue().values():
        if not cls.can_act(site, kinds):
            continue
        for start in cls.starts_at(site):
            free = tuple(p.name for p in cls.parameters if p.fitted)
            found.append(Candidate(cls, cls(**start), free))
    return found
