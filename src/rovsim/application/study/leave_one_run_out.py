"""Hold out each run of a study once, and compare its errors with published ones."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from rovsim.application.study.models import PHYSICS_MODELS
from rovsim.application.study.study import Study
from rovsim.core.errors import BadInput
from rovsim.core.model_names import EFFECTS, NOMINAL, name_learned
from rovsim.learning.pairs import flown_with
from rovsim.measurement.campaign import Campaign
from rovsim.reporting.figures import FigureKind
from rovsim.reporting.report_data import list_study_figures


@dataclass(frozen=True)
class LeaveOneRunOut:
    """The folds of a study, one for each run; none where `folds.leave_one_run_out` is off."""

    study: Study

    @property
    def runs(self) -> list[str]:
        """Ids of the runs to be held out, one after the other."""
        return self.study.runs() if self.study.settings.folds.leave_one_run_out else []

    @cached_property
    def published(self) -> Path | None:
        """The file of published errors, beside the recordings; None if there are none."""
        name, campaign = self.study.settings.folds.published, self.study.campaign
        if name is None:
            return None
        recorded = isinstance(campaign, Campaign)
        return Path(campaign.folder if recorded else f"{self.study.folder}/raw") / name

    def check(self) -> None:
        """Check the settings of the folds before anything is planned.

        Raises:
            BadInput: there is only one run, or no file of published errors.
        """
        if len(self.runs) == 1:
            raise BadInput(
                "only one run",
                where=self.study.given_by,
                expected="two runs or more, to leave one out",
                remedy="Add runs to the campaign, or set folds.leave_one_run_out=false.",
            )
        if self.published and not self.published.is_file():
            name = self.study.settings.folds.published
            remedy = f"Put it there, or set folds.published=null. {self.study.campaign.source}"
            raise BadInput(
                "no such file",
                where=self.published,
                expected=f"published errors as csv, named by folds.published={name}",
                remedy=remedy.strip(),
            )

    def train_runs(self, fold: str, control: str) -> list[str]:
        """List the ids of runs of a control to learn from while run `fold` is held out."""
        runs = self.study.campaign.runs
        return [run.id for run in runs if run.id != fold and flown_with(control, run)]

    def models(self, fold: str) -> list[str]:
        """List models of a fold that have a file: physics, then residuals on both bases."""
        settings = self.study.settings.folds
        controls = [c for c in settings.controls if self.train_runs(fold, c)]
        pairs = [(kind, control) for kind in settings.residuals for control in controls]
        trained = [name_learned(*pair, base) for base in (NOMINAL, EFFECTS) for pair in pairs]
        return [*PHYSICS_MODELS, *trained]

    @property
    def pitfalls(self) -> bool:
        """Whether to measure what the mistakes of the thesis' public code cost."""
        return self.study.settings.folds.pitfalls

    @property
    def figures(self) -> list[FigureKind]:
        """Figures that the study draws once; of published errors only where there are any."""
        kinds = list_study_figures()
        return [kind for kind in kinds if self.published or "published_errors" not in kind.needs]

    @property
    def targets(self) -> list[str]:
        """Files that the folds add to the results of the study."""
        folder = self.study.folder
        folds = [f"{folder}/folds/{run}/comparison.json" for run in self.runs]
        parts = {"published_errors": self.published, "pitfalls": self.pitfalls}
        return [*folds, *(f"{folder}/{name}.json" for name, part in parts.items() if part)]
