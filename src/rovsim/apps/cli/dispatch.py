"""Run a command with its own part of the composed settings."""

from contextlib import nullcontext

from rovsim.application.settings import Settings, select
from rovsim.core.collector import import_large
from rovsim.core.progress import heard_by
from rovsim.dynamics.catalogue import load_catalogue


def run_command(settings: Settings) -> None:
    """Run the command that the settings name.

    Raises:
        RovsimError: what the settings ask for cannot be done.
    """
    command = import_large(f"rovsim.apps.cli.commands.{settings.command}")
    catalogue = load_catalogue(settings.effect_files)
    with heard_by() if settings.output == "quiet" else nullcontext():
        command.run(select(settings, command.Settings), catalogue)
