"""The study as the workflow sees it: its campaign, runs and models, settings and code digests."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Mapping

from filelock import FileLock, Timeout

from rovsim.application.configuration import compose
from rovsim.application.provenance import digest, imports_of, own_digest, provenance
from rovsim.application.sections import TrainingSettings
from rovsim.application.settings import Settings, select
from rovsim.core.errors import BadInput, unlisted
from rovsim.core.model_names import EFFECTS, NOMINAL, REFITTED, name_learned
from rovsim.core.schema import Section
from rovsim.dynamics.catalogue import Catalogue, load_catalogue
from rovsim.dynamics.model import BASELINES
from rovsim.dynamics.vehicle import vehicle_file
from rovsim.learning.learner import learner, learner_settings
from rovsim.learning.pairs import flown_with
from rovsim.learning.settings import LearnerSettings
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.campaign_file import CampaignFile
from rovsim.measurement.loading import load_campaign
from rovsim.reporting.report_data import list_run_figures
from rovsim.simulation.synthetic_tank.description import SEALED, VEHICLE, describe, own_vehicle

HELD: dict[Path, FileLock] = {}  # until the process ends
PHYSICS = (REFITTED, EFFECTS)
# What a script imports to be run at all; the values of its settings are parameters of its rule.
SURROUNDINGS = {f"rovsim.application.{name}" for name in ("snakemake_job", "sections", "settings")}
CONFIG = ("campaign", "overrides", "effects_file")  # keys of Snakemake's
DRAWN = (NOMINAL, EFFECTS, "gp_6dof")  # few enough to be told apart in a time series


@dataclass(frozen=True)
class Study:
    """One campaign, one configuration.

    `config` is Snakemake's: `campaign`, `overrides`, `effects_file`.
    """

    config: Mapping[str, Any]
    _residuals: dict[str, Mapping[str, object]] = field(default_factory=dict, init=False)

    @cached_property
    def settings(self) -> Settings:
        """conf/, with the overrides and effect files given to Snakemake."""
        composed, named = compose(self._overrides), self.config.get("effects_file")
        return composed.model_copy(update={"effects_file": named}) if named else composed

    @cached_property
    def _overrides(self) -> list[str]:
        given = self.config.get("overrides", [])
        return given.split() if isinstance(given, str) else list(given)

    @cached_property
    def catalogue(self) -> Catalogue:
        """All effects, with those of the user's own files.

        Raises:
            BadInput: one of the files cannot be used.
        """
        return load_catalogue(self.settings.effect_files)

    @cached_property
    def campaign_path(self) -> str | None:
        """The user's campaign, None for the synthetic one."""
        path = self.config.get("campaign", self.settings.campaign)
        return None if path is None else str(path)

    @cached_property
    def synthetic(self) -> bool:
        """Whether the tank makes the campaign."""
        return self.campaign_path is None

    @cached_property
    def campaign(self) -> Campaign | CampaignFile:
        """The user's campaign, or what the synthetic one will be."""
        if self.campaign_path is not None:
            return load_campaign(Path(self.campaign_path))
        return describe(self.settings.tank)

    @property
    def name(self) -> str:
        """Folder under results/."""
        return self.campaign.name

    @cached_property
    def folder(self) -> str:
        """Where the study writes."""
        return f"results/{self.name}"

    def hold(self) -> None:
        """Keep other studies of this campaign out until this process ends, however it ends.

        Snakemake's own lock is a file that outlives a process that was killed.

        Raises:
            BadInput: another process writes there.
        """
        place = Path(self.folder)
        place.mkdir(parents=True, exist_ok=True)
        HELD[place] = FileLock(place / ".study.lock", blocking=False)
        try:
            HELD[place].acquire()
        except Timeout:
            raise BadInput(
                "another study writes here",
                where=place,
                expected="one study of a campaign at a time",
                remedy="Wait until it ends, or stop it: what it finished is kept.",
            ) from None

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

    @cached_property
    def _described(self) -> list[Path]:
        """Files of the vehicle and of the user's effects: an edit changes what models do."""
        if isinstance(self.campaign, Campaign):
            vehicle = vehicle_file(self.campaign.vehicle, named_in=self.campaign.file)
        else:
            vehicle = vehicle_file(self.settings.tank.vehicle)
        return [vehicle, *self.catalogue.files]

    def runs(self, split: str = "") -> list[str]:
        """Ids of the runs, all or of one split."""
        return [run.id for run in self.campaign.runs if split in ("", run.split)]

    @cached_property
    def trained(self) -> list[str]:
        """Names of the trained models: residuals x controls that have a train run."""
        wanted = self.settings.study
        controls = [control for control in wanted.controls if self.control_runs(control)]
        return [name_learned(kind, control) for kind in wanted.residuals for control in controls]

    @cached_property
    def on_effects(self) -> list[str]:
        """Names of the residuals trained on top of the effects that were found."""
        wanted = self.settings.study.on_effects
        return [f"{EFFECTS}+{name}" for name in self.trained if name in wanted]

    @property
    def files(self) -> list[str]:
        """Models with a file of their own: all but the baselines."""
        return [*PHYSICS, *self.trained, *self.on_effects]

    @property
    def models(self) -> list[str]:
        """Every model of the study, in the order of the ladder."""
        return [*BASELINES, *self.files]

    @property
    def searched(self) -> list[str]:
        """Models searched for conditions in which they fail; the last is reported first."""
        return [*self.trained, EFFECTS, NOMINAL]

    @property
    def drawn(self) -> list[str]:
        """Models shown in time series."""
        return [m for m in DRAWN if m in self.models] or self.models[:3]

    def control_runs(self, control: str) -> list[str]:
        """Train runs of one control."""
        return [r.id for r in self.campaign.runs if r.split == "train" and flown_with(control, r)]

    def learner(self, kind: str) -> LearnerSettings:
        """Settings of one residual, whichever the configuration chose as default."""
        return learner_settings(self._residual(kind), "conf/residual")

    def _residual(self, kind: str) -> Mapping[str, object]:
        """Composed once: Hydra takes as long as all that a rule asks for beside it."""
        if kind not in self._residuals:
            self._residuals[kind] = self._compose_residual(kind)
        return self._residuals[kind]

    def _compose_residual(self, kind: str) -> Mapping[str, object]:
        kept = [word for word in self._overrides if not word.startswith("residual=")]
        if kind != self.settings.residual["kind"]:
            kept = [word for word in kept if not word.startswith("residual.")]
        return compose([*kept, f"residual={kind}"]).residual

    def training(self, residual: str, control: str) -> str:
        """What a trained residual depends on, as JSON."""
        chosen = {"residual": self._residual(residual), "control": control}
        return select(self.settings.model_copy(update=chosen), TrainingSettings).model_dump_json()

    def section(self, kind: type[Section]) -> str:
        """A part of the settings as JSON: only what a rule reads, and re-runs for."""
        return select(self.settings, kind).model_dump_json()

    def signal(self, *names: str) -> str:
        """Parts of the signal chain as JSON."""
        return self.settings.signals.model_dump_json(include=set(names))

    def code(self, script: Path, *more: str, without: str = "") -> str:
        """Digest of what a script imports, however deep: an edit re-runs what it touches.

        Args:
            script: of a rule.
            more: modules that it finds by their names.
            without: a package whose edits change nothing that the script writes.
        """
        names = [name for name in (*imports_of(script), *more) if name not in SURROUNDINGS]
        return digest(*names, without=without, described=self._described)

    def own_code(self, package: str) -> str:
        """Digest of a package alone. A recorded campaign stands when rovsim's physics is edited."""
        return own_digest(f"rovsim.{package}", self._described)

    def provenance(self) -> dict[str, Any]:
        """Settings, code and versions behind the study."""
        campaign = self.campaign if isinstance(self.campaign, Campaign) else None
        return provenance(self.settings, self.catalogue, campaign)

    def check(self) -> None:
        """Look at all that can be wrong with what was given, before anything is planned.

        Raises:
            BadInput: a campaign that cannot be used, no train or no test run, an unknown residual.
        """
        for key in self.config:
            if key not in CONFIG:
                found = f"unknown key '{key}'"
                raise unlisted(key, CONFIG, found=found, where="snakemake --config")
        for split in ("train", "test"):
            if not self.runs(split):
                raise BadInput(
                    f"no {split} run",
                    where=self.campaign_path or "conf/tank",
                    expected="runs of both splits: train to learn from, test to report on",
                    remedy="Give each run of campaign.yaml its split.",
                )
        for kind in self.settings.study.residuals:
            learner(kind, "study.residuals")
        for name in self.settings.study.on_effects:
            learner(name.rpartition("_")[0], "study.on_effects")

    def figures(self) -> list[str]:
        """Figures of single runs, as `figure-run`."""
        figures = list_run_figures()
        return [f"{figure.name}-{run}" for run in self.runs("test") for figure in figures]
