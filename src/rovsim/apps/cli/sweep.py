"""One job of a Hydra multirun; importable, so that every launcher can send it to a worker."""

from pathlib import Path
from typing import Any, Sequence

from rovsim.application.settings import Settings, settings_of
from rovsim.apps.cli.complaint import complain
from rovsim.apps.cli.dispatch import run_command
from rovsim.core.errors import RovsimError

# What a run's name has without this, or what is the same in all of them.
NAMED = ("command", "campaign", "residual", "control", "out", "output")


def job(composed: Any) -> None:
    """Run the command of one combination; its results go to the job's own folder."""
    from hydra.core.hydra_config import HydraConfig

    hydra = HydraConfig.get()
    try:
        settings = name_run(settings_of(composed), hydra.overrides.task)
        out = choose_out(settings.out, hydra.runtime.output_dir, hydra.sweep.subdir)
        run_command(settings.model_copy(update={"out": out}))
    except RovsimError as error:
        complain(str(error))


def choose_out(given: str | None, own: str, name: str) -> str:
    """Folder of a job: `own` is Hydra's; in a folder that is given, one of the same name."""
    return own if given is None else str(Path(given, name))


def name_run(settings: Settings, overrides: Sequence[str]) -> Settings:
    """The settings, with a name that tells one MLflow run of a sweep from another."""
    own = [word for word in overrides if word.partition("=")[0].lstrip("+") not in NAMED]
    if settings.tracking.name or not own:
        return settings
    name = " ".join([f"{settings.learner.kind}_{settings.control}", *own])
    tracking = settings.tracking.model_copy(update={"name": name})
    return settings.model_copy(update={"tracking": tracking})
