"""What is studied: one campaign, its runs and files, with one configuration."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Mapping, get_args

from rovsim.application.settings import Settings
from rovsim.application.study.snakemake_config import SnakemakeConfig
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.learned.settings import Control
from rovsim.learning.learner import learner
from rovsim.learning.pairs import flown_with
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.campaign_file import CampaignFile
from rovsim.measurement.loading import load_campaign
from rovsim.reporting.report_data import list_run_figures
from rovsim.simulation.synthetic_tank.description import SEALED, VEHICLE, describe, own_vehicle


@dataclass(frozen=True)
class Study:
    """`config` is Snakemake's: `campaign`, `overrides`, `effects_file`."""

    config: Mapping[str, Any]

    @cached_property
    def snakemake(self) -> SnakemakeConfig:
        """What Snakemake was told."""
        return SnakemakeConfig(self.config)

    @property
    def settings(self) -> Settings:
        """conf/ with what Snakemake was told."""
        return self.snakemake.settings

    @property
    def catalogue(self) -> Catalogue:
        """All effects, with those of the user's own files."""
        return self.snakemake.catalogue

    @property
    def synthetic(self) -> bool:
        """Whether the tank makes the campaign."""
        return self.snakemake.campaign_path is None

    @property
    def given_by(self) -> str:
        """Where the runs are described, for messages."""
        return str(self.snakemake.campaign_path or "conf/tank")

    @cached_property
    def campaign(self) -> Campaign | CampaignFile:
        """The user's campaign, or what the synthetic one will be."""
        path = self.snakemake.campaign_path
        return describe(self.settings.tank) if path is None else load_campaign(path)

    @property
    def name(self) -> str:
        """Folder under results/."""
        return self.campaign.name

    @property
    def folder(self) -> str:
        """Where the study writes."""
        return f"results/{self.name}"

    def raw(self, run: str = "") -> list[str]:
        """Raw files: of one run, with the campaign file, or all that the tank writes."""
        if isinstance(self.campaign, Campaign):
            one = self.campaign.run(run)
            return [str(self.campaign.file), *map(str, self.campaign.raw_files(one))]
        runs = [r for r in self.campaign.runs if run in ("", r.id)]
        files = [name for r in runs for name in (*r.sensor_files, r.commands)]
        own = [VEHICLE] if own_vehicle(self.settings.tank) else []
        extra = own if run else [*own, SEALED]
        return [f"{self.folder}/raw/{name}" for name in ["campaign.yaml", *extra, *files]]

    @property
    def campaign_file(self) -> str:
        """Where a rule finds the campaign."""
        return self.raw(self.runs()[0])[0]

    def runs(self, split: str = "") -> list[str]:
        """Ids of the runs, all or of one split."""
        return [run.id for run in self.campaign.runs if split in ("", run.split)]

    def train_runs(self, control: str) -> list[str]:
        """Ids of the train runs of one control."""
        return [r.id for r in self.campaign.runs if r.split == "train" and flown_with(control, r)]

    def figures(self) -> list[str]:
        """Figures of single runs, as `figure-run`."""
        figures = list_run_figures()
        return [f"{figure.name}-{run}" for run in self.runs("test") for figure in figures]

    def check(self) -> None:
        """Look at all that can be wrong with what was given, before anything is planned.

        Raises:
            BadInput: a campaign that cannot be used, no train or no test run, an unknown residual
                or control.
        """
        self.snakemake.check()
        for split in ("train", "test"):
            if not self.runs(split):
                raise BadInput(
                    f"no {split} run",
                    where=self.given_by,
                    expected="runs of both splits: train to learn from, test to report on",
                    remedy="Give each run of campaign.yaml its split.",
                )
        for kind in self.settings.study.residuals:
            learner(kind, "study.residuals")
        for name in self.settings.study.on_effects:
            kind, _, control = name.rpartition("_")
            known = get_args(Control)
            if control not in known:
                raise BadInput(
                    f"'{name}'",
                    where="study.on_effects",
                    expected=f"a residual and a control ({', '.join(known)}), as in knn_6dof",
                    remedy="Correct that value.",
                )
            learner(kind, "study.on_effects")
