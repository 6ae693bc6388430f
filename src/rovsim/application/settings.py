"""Settings that each command and rule takes from the configuration (see `configuration`)."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, PositiveFloat, PositiveInt, model_validator

from rovsim.application.sections import SimulationSections, TimingSettings, TrainingSettings
from rovsim.core.names import as_list
from rovsim.core.schema import PathText, S, Section
from rovsim.design.settings import DesignSettings
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.learned.settings import Control
from rovsim.simulation.synthetic_tank.settings import TankSettings


class StudySettings(Section):
    """Which residuals the workflow trains.

    Attributes:
        residuals: kinds that are trained on the nominal model.
        controls: of the runs to learn from; each residual is trained once for each.
        on_effects: residuals, as kind_control, that are also trained on top of the effects found.
    """

    residuals: tuple[str, ...] = ("knn", "gp", "svgp")
    controls: tuple[Control, ...] = ("3dof", "6dof")
    on_effects: tuple[str, ...] = ("knn_6dof", "gp_6dof")


class FoldSettings(Section):
    """Cross-validation in which each run is held out once.

    Attributes:
        leave_one_run_out: whether this is done.
        published: csv beside the recordings, of errors that others reached on the same runs.
        pitfalls: whether to measure what four mistakes of the thesis' public code cost on them.
        residuals: kinds that are trained, on the nominal model and on the effects.
        controls: of the runs to learn from; each residual is trained once for each.
    """

    leave_one_run_out: bool = False
    published: PathText | None = None
    pitfalls: bool = False
    residuals: tuple[str, ...] = ("knn", "gp")
    controls: tuple[Control, ...] = ("6dof",)

    @model_validator(mode="after")
    def _only_held_out_runs(self) -> "FoldSettings":
        if (self.published or self.pitfalls) and not self.leave_one_run_out:
            raise ValueError("published numbers and pitfalls only with leave_one_run_out=true")
        return self


class BenchSettings(Section):
    """The speed benchmark.

    Attributes:
        calls: of each of rovsim's own predictors.
        warmup: calls before these, not timed.
        seconds: for which a library is called.
        sweep_seconds: the same in the sweeps of sizes.
        duration: of the simulated runs, s.
        page: file that is written.
    """

    calls: PositiveInt = 100000
    warmup: PositiveInt = 200
    seconds: PositiveFloat = 60.0
    sweep_seconds: PositiveFloat = 2.0
    duration: PositiveFloat = 300.0
    page: str = "docs/benchmark_speed.md"


class BlindSettings(Section):
    """The blind benchmark.

    Attributes:
        simulator: that makes the recordings.
        suite: of cases.
        share: of the suite's cases that are run, 0 to 1.
        seeds: those to develop with, or those to report on.
        methods: that have to find the hidden effects.
        page: file that is written.
    """

    simulator: Literal["tank", "independent"] = "tank"
    suite: Literal[
        "quick", "standard", "full", "recordings", "equations", "laboratory", "strong"
    ] = "quick"
    share: float = Field(1.0, gt=0.0, le=1.0)
    seeds: Literal["development", "reporting"] = "reporting"
    methods: tuple[Literal["diagnosis", "stlsq", "frols"], ...] = ("diagnosis", "stlsq", "frols")
    page: str = "docs/benchmark_blind.md"


class TrackingSettings(Section):
    """Where MLflow keeps runs.

    Attributes:
        uri: of the database or server.
        artifacts: folder of the runs' files, for a local database.
        name: of a run; None: residual and control.
    """

    uri: str
    artifacts: str
    name: str | None = None


class CommandSettings(Section):
    """Settings of every command.

    Attributes:
        effects_file: files that declare the user's own effects.
        output: what it prints.
    """

    effects_file: PathText | list[PathText] | None = None
    output: Literal["text", "json", "quiet"] = "text"

    @property
    def effect_files(self) -> list[Path]:
        """Files that declare the user's own effects."""
        return [Path(name) for name in as_list(self.effects_file or [])]


class WritingSettings(CommandSettings):
    """Settings of commands that write where `out` says.

    Attributes:
        out: file or folder; None: a place under results/.
    """

    out: PathText | None


class CampaignSettings(SimulationSections, WritingSettings):
    """Settings of every command on a campaign.

    Attributes:
        campaign: folder of the campaign; None where none was given (the study: a synthetic one).
        model: names of built-in models, or model files.
    """

    campaign: PathText | None
    model: PathText | Annotated[list[PathText], Field(min_length=1)]


class WorkbenchSettings(TrainingSettings, CampaignSettings):
    """Settings of the workbench: a campaign, and how it is diagnosed and learned from.

    Attributes:
        search: how a diagnosis searches.
        diagnosis: file of a diagnosis to show; None: the workbench makes one.
        seconds: of a planned flight.
        design: how a flight is planned.
        port: of the server.
        open: whether a browser is opened.
    """

    search: SearchSettings
    diagnosis: PathText | None
    seconds: float = 60.0
    design: DesignSettings = DesignSettings()
    port: int = Field(ge=1, le=65535)
    open: bool


class Settings(WorkbenchSettings):
    """conf/config.yaml, composed and checked; each command and rule gets its part of it.

    Attributes:
        command: module of the command that is run.
        tank: the synthetic tank.
        effects: of a diagnosis, by id, that are added to a model; None: the selected ones.
        to: the model that effects are added to, or the simulator that a model is written for.
        between: two effects that a planned flight should tell apart.
        know: parameters, as effect.parameter, that a planned flight should make better known.
        fly: log of commands that the tank flies as one more train run.
        files: files and folders of recordings to be looked into.
        force: whether a campaign.yaml that is there is replaced.
        study: which residuals the workflow trains.
        folds: each run held out once.
        timing: of the inference of residuals.
        bench: the speed benchmark.
        blind: the blind benchmark.
        tracking: where MLflow keeps runs.
    """

    command: str | None = None
    tank: TankSettings
    effects: list[str] | None = None
    to: PathText = "nominal"
    between: list[str] | None = None
    know: list[str] | None = None
    fly: PathText | None = None
    files: list[PathText] = Field(default_factory=list)
    force: bool = False
    study: StudySettings
    folds: FoldSettings
    timing: TimingSettings
    bench: BenchSettings
    blind: BlindSettings
    tracking: TrackingSettings


def select(settings: Section, kind: type[S]) -> S:
    """Select the part of settings that a command or a function takes.

    Args:
        settings: that have at least the fields of `kind`.
        kind: class of the part.
    """
    return kind(**{name: getattr(settings, name) for name in kind.model_fields})
