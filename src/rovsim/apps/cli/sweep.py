"""One job of a Hydra multirun; importable, so that every launcher can send it to a worker."""

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
        if settings.out is None:
            settings = settings.model_copy(update={"out": hydra.runtime.output_dir})
        run_command(settings)
    except RovsimError as error:
        complain(str(error))


def name_run(settings: Settings, overrides: Sequence[str]) -> Settings:
    """The settings, with a name that tells one MLflow run of a sweep from another."""
    own = [word for word in overrides if word.partition("=")[0].lstrip("+") not in NAMED]
    if settings.tracking.name or not own:
        return settings
    name = " ".join([f"{settings.learner.kind}_{settings.control}", *own])
    tracking = settings.tracking.model_copy(update={"name": name})
    return settings.model_copy(update={"tracking": tracking})
