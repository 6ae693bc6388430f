"""One job of a Hydra multirun; importable, so that every launcher can send it to a worker."""

import importlib
import sys
from contextlib import nullcontext
from typing import Any

from rovsim.application.settings import settings_of
from rovsim.core.errors import RovsimError
from rovsim.core.progress import heard_by
from rovsim.dynamics.catalogue import load_catalogue


def job(composed: Any) -> None:
    """Run the command of one combination; its results go to the job's own folder."""
    from hydra.core.hydra_config import HydraConfig

    settings = settings_of(composed)
    if settings.out is None:
        settings = settings.model_copy(update={"out": HydraConfig.get().runtime.output_dir})
    try:
        catalogue = load_catalogue(settings.effect_files)
        with heard_by() if settings.output == "quiet" else nullcontext():
            command = importlib.import_module(f"rovsim.apps.cli.commands.{settings.command}")
            command.run(settings, catalogue)
    except RovsimError as error:
        print(f"rovsim: {error}", file=sys.stderr)
        sys.exit(2)
