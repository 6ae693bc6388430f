"""What was found on the train runs of a campaign."""

from dataclasses import dataclass
from typing import Sequence

from rovsim.diagnosis.checks.commanded import list_not_commanded
from rovsim.diagnosis.equations.disturbance import ForceInTime
from rovsim.diagnosis.equations.proposal import ProposedLaw
from rovsim.diagnosis.selection.ranking import Ranked, Selected
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.diagnosis.structure.residual import Structure
from rovsim.diagnosis.uncertainty.common_scale import CommonScale
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.usable_runs import UsableRuns
from rovsim.results.diagnosis import Verdict
from rovsim.results.fitted import Correlation


@dataclass(frozen=True, eq=False)
class TrainDiagnosis:
    """What was found on the train runs.

    `usable` runs; `fit` of the base and all selected effects, None where there was too little to
    judge, and the `correlation` of its values; `structures` that are left, and whether validation
    `refused` effects that explain something; `scale` of all forces, where it is unknown;
    `not_observable` effects that the runs could not show; `proposed`: a law for what is left, where
    one holds; `stand_ins`: names that it, or half a law, makes unnecessary or others;
    `disturbance`: the force in time, where none does.
    """

    base: Model
    usable: UsableRuns
    fit: Fit | None = None
    correlation: Correlation | None = None
    selected: Sequence[Selected] = ()
    ranking: Sequence[Ranked] = ()
    rivals: Sequence[Rival] = ()
    structures: Sequence[Structure] = ()
    refused: bool = False
    scale: CommonScale | None = None
    not_observable: Sequence[str] = ()
    proposed: ProposedLaw | None = None
    stand_ins: tuple[str, ...] = ()
    disturbance: ForceInTime | None = None

    @property
    def enough(self) -> bool:
        """Whether there was enough to judge anything."""
        return self.fit is not None

    @property
    def verdict(self) -> Verdict:
        """One of the four of the contract."""
        if not self.enough:
            return "insufficient_data"
        if self.structures or self.refused:
            return "unexplained"
        if self.selected:
            return "missing_effects"
        unseen = self.usable.still or self.usable.lost
        return "insufficient_data" if unseen else "adequate"

    @property
    def not_commanded(self) -> tuple[str, ...]:
        """Thrusters, surfaces or axes that these runs never commanded."""
        return list_not_commanded(self.usable, self.base.vehicle)

    def models(self) -> list[Model]:
        """The base, then one model more for each selected effect."""
        found = [self.base]
        for one in self.selected:
            found.append((found[-1] + one.term.effect).called(f"+{one.term.id}"))
        return found
