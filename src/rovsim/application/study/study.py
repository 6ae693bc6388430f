"""A study: one campaign, its runs and files, and one configuration."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Mapping, get_args

from rovsim.application.settings import Settings
from rovsim.application.study.snakemake_config import SnakemakeConfig
from rovsim.core.errors import BadInput, closest
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.learned.settings import Control
from rovsim.learning.learner import learner
from rovsim.learning.pairs import flown_with
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.campaign_file import CampaignFile
from rovsim.measurement.loading import load_campaign
from rovsim.reporting.report_data import list_run_figures
from rovsim.simulation.synthetic_tank.description import (
    TRUTH_FILE,
    VEHICLE_FILE,
    describe_campaign,
    own_vehicle,
)


@dataclass(frozen=True)
class Study:
    """A study of one campaign.

    Attributes:
        config: Snakemake's: `campaign`, `overrides`, `effects_file`.
    """

    config: Mapping[str, Any]

    @cached_property
    def snakemake(self) -> SnakemakeConfig:
        """The configuration that Snakemake was given, parsed."""
        return SnakemakeConfig(self.config)

    @property
    def settings(self) -> Settings:
        """Settings of conf/, with the overrides given to Snakemake."""
        return self.snakemake.settings

    @property
    def catalogue(self) -> Catalogue:
        """All effects, with those of the user's own files."""
        return self.snakemake.catalogue

    @property
    def synthetic(self) -> bool:
        """Whether the campaign is a synthetic one, recorded in the simulated tank."""
        return self.snakemake.campaign_path is None

    @property
    def given_by(self) -> str:
        """Path of what describes the runs, for messages."""
        return str(self.snakemake.campaign_path or "conf/tank")

    @cached_property
    def campaign(self) -> Campaign | CampaignFile:
        """The user's campaign, or the description of a synthetic one that is yet to be made."""
        path = self.snakemake.campaign_path
        return describe_campaign(self.settings.tank) if path is None else load_campaign(path)

    @property
    def name(self) -> str:
        """Name of the campaign, and of the study's folder under results/."""
        return self.campaign.name

    @property
    def folder(self) -> str:
        """Folder that the study writes to."""
        return f"results/{self.name}"

    @property
    def campaign_file(self) -> str:
        """Path of the campaign file."""
        if isinstance(self.campaign, Campaign):
            return str(self.campaign.file)
        return f"{self.folder}/raw/campaign.yaml"

    def raw(self, run: str) -> list[str]:
        """List the raw files of one run."""
        if isinstance(self.campaign, Campaign):
            return [str(path) for path in self.campaign.raw_files(self.campaign.run(run))]
        runs = [r for r in self.campaign.runs if r.id == run]
        return [f"{self.folder}/raw/{name}" for r in runs for name in (*r.sensor_files, r.commands)]

    def compared(self, run: str) -> list[str]:
        """List raw files of a test run and of the train runs that it may copy; else none."""
        if run not in self.runs("test"):
            return []
        return [path for other in (run, *self.runs("train")) for path in self.raw(other)]

    @property
    def tank_files(self) -> list[str]:
        """All files of a synthetic campaign: its description, and the raw files of its runs."""
        beside = [VEHICLE_FILE, TRUTH_FILE] if own_vehicle(self.settings.tank) else [TRUTH_FILE]
        description = [self.campaign_file, *(f"{self.folder}/raw/{name}" for name in beside)]
        return [*description, *(path for run in self.runs() for path in self.raw(run))]

    def runs(self, split: str = "") -> list[str]:
        """List the ids of all runs, or of those of one split."""
        return [run.id for run in self.campaign.runs if split in ("", run.split)]

    def train_runs(self, control: str) -> list[str]:
        """List the ids of the train runs of one control."""
        return [r.id for r in self.campaign.runs if r.split == "train" and flown_with(control, r)]

    def figures(self) -> list[str]:
        """List the figures of single test runs, as `figure-run`."""
        figures = list_run_figures()
        return [f"{figure.name}-{run}" for run in self.runs("test") for figure in figures]

    def check(self) -> None:
        """Check configuration and campaign before anything is planned.

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
        for kind in self.settings.folds.residuals:  # even where no run is left out
            learner(kind, "folds.residuals")
        for name in self.settings.study.on_effects:
            kind, _, control = name.rpartition("_")
            controls = get_args(Control)
            if control not in controls:
                raise BadInput(
                    f"'{name}'",
                    where="study.on_effects",
                    expected=f"a residual and a control ({', '.join(controls)}), as in knn_6dof",
                    remedy=closest(control, controls) or "Correct that value.",
                )
            learner(kind, "study.on_effects")
