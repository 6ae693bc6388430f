"""The diagnosis of the train runs of a campaign: all that was found on them."""

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

    Attributes:
        base: the model that was diagnosed.
        usable: the runs that could be used, and what was neither moved nor measured in them.
        fit: of the base and all selected effects; None where there was too little to judge.
        correlation: of the fitted values.
        selected: accepted effects, first the one that removes most error.
        ranking: every effect as the only addition to the base.
        rivals: effects that could stand in the place of selected ones.
        structures: what the remainder still depends on.
        refused: whether hold-out validation removed effects that explain something.
        scale: common factor of all forces and inertias; None where it is known.
        not_observable: ids of effects that the runs could not show.
        proposed: a law for what is left; None where no law holds.
        stand_ins: ids of selected effects that a law makes unnecessary or changes, proposed or not.
        disturbance: what is left as a force in time, where no law holds.
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
        """Whether there was enough data to judge anything."""
        return self.fit is not None

    @property
    def verdict(self) -> Verdict:
        """The verdict, as `diagnosis.json` has it.

        `unexplained` where something is left but noise; else `missing_effects` where effects were
        selected; else `adequate`, unless an axis did not move or the model diverged in a run.
        """
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
        """The base, then models with one selected effect more each."""
        models = [self.base]
        for s in self.selected:
            models.append((models[-1] + s.term.effect).called(f"+{s.term.id}"))
        return models
