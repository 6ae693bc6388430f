"""From composed settings to a command, which sees its own part of them."""

import importlib
from contextlib import nullcontext

from rovsim.application.settings import Settings, select
from rovsim.core.progress import heard_by
from rovsim.dynamics.catalogue import load_catalogue


def run_command(settings: Settings) -> None:
    """Run the command that the settings name.

    Raises:
        RovsimError: what the settings ask for cannot be done.
    """
    catalogue = load_catalogue(settings.effect_files)
    command = importlib.import_module(f"rovsim.apps.cli.commands.{settings.command}")
    with heard_by() if settings.output == "quiet" else nullcontext():
        command.run(select(settings, command.Settings), catalogue)
