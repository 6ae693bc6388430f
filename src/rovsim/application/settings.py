"""Settings: Hydra composes them from conf/ once, here; the library gets plain typed values."""

from pathlib import Path
from typing import Annotated, Any, Literal, Sequence

from pydantic import Field, PositiveFloat, PositiveInt, model_validator

from rovsim.application.sections import SimulationSections, TimingSettings, TrainingSettings
from rovsim.core.errors import BadInput, RovsimError, nearest, unlisted
from rovsim.core.names import as_list
from rovsim.core.schema import PathText, S, Section, checked
from rovsim.core.shipped import conf_folders, conf_names
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


def compose(overrides: Sequence[str]) -> Settings:
    """Compose conf/config.yaml with Hydra overrides.

    Raises:
        BadInput: an override Hydra does not understand, or a value that does not fit.
    """
    from hydra import compose as hydra_compose
    from hydra import initialize_config_dir

    from rovsim.application.conf_search import first_folder

    words = [_allow_unlisted(word) for word in overrides]
    try:
        with initialize_config_dir(first_folder(), version_base="1.3"):
            return settings_of(hydra_compose("config", overrides=words))
    except RovsimError:
        raise
    except Exception as error:  # Hydra's own, and what odd words make it stumble over
        raise _refused(overrides, str(error)) from None


def _allow_unlisted(word: str) -> str:
    """An override of the tank that Hydra takes though no file of `conf/tank` lists its key.

    A tank lists what is special about it; what else there is, `TankSettings` checks.
    """
    return f"++{word}" if word.startswith("tank.") else word


def _refused(overrides: Sequence[str], message: str) -> BadInput:
    """What is wrong with an override that Hydra refused, and what was probably meant."""
    chosen = [word for word in overrides if _is_choice(word)]
    for word in overrides:
        key, _, value = word.lstrip("+~").partition("=")
        options = conf_names(key) if key else []
        if options and value not in options:
            return unlisted(value, options, found=f"there is no {key} '{value}'", where=word)
        if key and not options and key.split(".")[0] not in ("hydra", "hydra/launcher"):
            known = _keys(chosen)
            if key not in known and key in message:
                return BadInput(
                    f"there is no key '{key}'",
                    where=word,
                    expected="a key of conf/config.yaml",
                    remedy=nearest(key, known),
                )
    if message.startswith("Ambiguous value"):
        word = next((word for word in overrides if word in message), overrides[0])
        return BadInput(
            f"several values ({word})",
            where=f"overrides {' '.join(overrides)}",
            expected="one value of each key",
            remedy="Add -m: then each value is a run of a sweep; or put a list into brackets.",
        )
    return BadInput(
        message.split("\n")[0].removeprefix("LexerNoViableAltException: ").rstrip("."),
        where=f"overrides {' '.join(overrides)}",
        expected="key=value with keys of conf/config.yaml and options of its groups",
        remedy="See docs/configuration.md for the keys.",
    )


def _is_choice(word: str) -> bool:
    """Whether an override chooses one of a group's options."""
    key, _, value = word.partition("=")
    return value in conf_names(key) if key else False


def _keys(chosen: Sequence[str]) -> list[str]:
    """Every key of the configuration with these options, dotted, and every group."""
    from rovsim.core.mappings import flattened

    groups = [path.name for folder in conf_folders() for path in folder.iterdir() if path.is_dir()]
    return [*groups, *flattened(compose(chosen).model_dump(mode="json"))]


def settings_of(composed: Any) -> Settings:
    """Typed settings of a composed Hydra configuration."""
    from omegaconf import OmegaConf

    plain = OmegaConf.to_container(composed, resolve=True)
    if isinstance(plain, dict):
        plain.pop("hydra", None)
    return checked(Settings, plain, "configuration")
