"""Refuse keys of the configuration that a command does not use and would silently ignore."""

import re
from typing import Sequence

from rovsim.application.settings import Settings
from rovsim.apps.cli.completion import commands, own_keys
from rovsim.core.collector import import_large
from rovsim.core.errors import BadInput
from rovsim.core.shipped import conf_file, conf_names

# Sections that may stand beside any command: a sweep's, and what scripts give to all alike.
COMMON_SECTIONS = ("command", "hydra", "experiment", "seed", "tracking")
MAX_NAMED_COMMANDS = 3  # asked for; of a key that most take, none can be meant


def require_taken(command: str, overrides: Sequence[str]) -> None:
    """Refuse overrides of sections that a command does not use; Hydra refuses unknown sections.

    Raises:
        BadInput: there is such an override.
    """
    fields = import_large(f"rovsim.apps.cli.commands.{command}").Settings.model_fields
    for word in overrides:
        key = word.lstrip("+~").partition("=")[0]
        name = section(key)
        if name in Settings.model_fields and name not in (*fields, *COMMON_SECTIONS):
            raise BadInput(
                f"`rovsim {command}` does not use '{key}'",
                where="command line",
                expected=f"keys that it takes (`rovsim {command} --help`)",
                remedy=_remedy(name),
            )


def section(key: str) -> str:
    """Return the section of the settings that a key belongs to, as the file of its group says."""
    options = conf_names(key)
    if options and (path := conf_file(f"{key}/{options[0]}.yaml")):
        package = re.search(r"@package (\w+)", path.read_text(encoding="utf-8"))
        return package[1] if package else key
    return key.split(".")[0].split("/")[0]


def _remedy(name: str) -> str:
    """Suggest the commands whose help names a section."""
    users = [user for user in commands() if name in {section(key) for key in own_keys(user)}]
    if not 0 < len(users) <= MAX_NAMED_COMMANDS:
        return "Leave it out."
    names = ", ".join(f"`rovsim {user}`" for user in users)
    return f"Leave it out, or did you mean {names}?"
