"""What each command and rule takes of the configuration (`configuration` composes it)."""

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
    """Which residuals the workflow trains, on which runs; which also on top of the effects."""

    residuals: tuple[str, ...] = ("knn", "gp", "svgp")
    controls: tuple[Control, ...] = ("3dof", "6dof")
    on_effects: tuple[str, ...] = ("knn_6dof", "gp_6dof")


class FoldSettings(Section):
    """Each run held out once.

    `published` is a csv beside the recordings, of errors that others reached on the same runs. Each
    residual is trained on the nominal model and on the effects, on the runs of each control.
    `pitfalls`: also what four mistakes of the thesis' public code cost on these runs.
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
    """The speed benchmark: calls of each own path, s for a library's, runs of `duration` s."""

    calls: PositiveInt = 100000
    warmup: PositiveInt = 200
    seconds: PositiveFloat = 60.0
    sweep_seconds: PositiveFloat = 2.0
    duration: PositiveFloat = 300.0
    page: str = "docs/benchmark_speed.md"


class BlindSettings(Section):
    """The blind benchmark: which cases, who flies and who answers; `share` of a suite's cases."""

    simulator: Literal["tank", "independent"] = "tank"
    suite: Literal[
        "quick", "standard", "full", "recordings", "equations", "laboratory", "strong"
    ] = "quick"
    share: float = Field(1.0, gt=0.0, le=1.0)
    seeds: Literal["development", "reporting"] = "reporting"
    methods: tuple[Literal["diagnosis", "stlsq", "frols"], ...] = ("diagnosis", "stlsq", "frols")
    page: str = "docs/benchmark_blind.md"


class TrackingSettings(Section):
    """Where MLflow keeps runs (`uri`) and their files (`artifacts`, for a local database).

    `name` of a run; None: residual and control.
    """

    uri: str
    artifacts: str
    name: str | None = None


class CommandSettings(Section):
    """What every command takes: effects of one's own, where it writes, what it prints.

    `out` None: a folder under results/.
    """

    effects_file: PathText | list[PathText] | None = None
    out: PathText | None
    output: Literal["text", "json", "quiet"] = "text"

    @property
    def effect_files(self) -> list[Path]:
        """Files that declare the user's own effects."""
        return [Path(name) for name in as_list(self.effects_file or [])]


class CampaignSettings(SimulationSections, CommandSettings):
    """What every command on a campaign takes."""

    campaign: PathText | None
    model: PathText | Annotated[list[PathText], Field(min_length=1)]


class WorkbenchSettings(TrainingSettings, CampaignSettings):
    """What the workbench takes: a campaign, and how it is diagnosed and learned from."""

    search: SearchSettings
    diagnosis: PathText | None
    seconds: float = 60.0
    design: DesignSettings = DesignSettings()
    port: int = Field(ge=1, le=65535)
    open: bool


class Settings(WorkbenchSettings):
    """conf/config.yaml, composed and checked; each command and rule is given its part of it."""

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
    """The part of settings that a command or a function takes."""
    return kind(**{name: getattr(settings, name) for name in kind.model_fields})
