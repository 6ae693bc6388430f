"""One job of a Hydra multirun; importable, so that every launcher can send it to a worker."""

import sys
from typing import Any

from rovsim.application.settings import settings_of
from rovsim.apps.cli.dispatch import run_command
from rovsim.core.errors import RovsimError


def job(composed: Any) -> None:
    """Run the command of one combination; its results go to the job's own folder."""
    from hydra.core.hydra_config import HydraConfig

    settings = settings_of(composed)
    if settings.out is None:
        settings = settings.model_copy(update={"out": HydraConfig.get().runtime.output_dir})
    try:
        run_command(settings)
    except RovsimError as error:
        print(f"rovsim: {error}", file=sys.stderr)
        sys.exit(2)
