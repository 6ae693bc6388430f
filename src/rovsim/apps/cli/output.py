"""Choose where a command writes, and print its result: as text, as JSON, or not at all."""

import json
import os
from pathlib import Path

from rovsim.application.settings import CommandSettings, WritingSettings
from rovsim.core.columns import fold
from rovsim.core.errors import BadInput


def say(settings: CommandSettings, text: str, content: object) -> None:
    """Print the text, its content as JSON with `output=json`, nothing with `output=quiet`."""
    if settings.output == "json":
        print(json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False))
    elif settings.output == "text":
        print(text)


def join_files(text: str, files: str, *became: str) -> str:
    """Append to a text the files that were written, and sentences on earlier files (`became`)."""
    return "\n".join([text, "", files, *(line for part in became if part for line in fold(part))])


def choose_folder(settings: WritingSettings, default: str) -> Path:
    """Return the folder that a command writes to, which need not exist yet.

    Raises:
        BadInput: the folder, or one that it is to be made in, is a file or may not be written to.
    """
    out = Path(settings.out or default)
    whole = out.absolute()
    nearest = next(place for place in (whole, *whole.parents) if place.exists())
    if nearest.is_dir() and os.access(nearest, os.W_OK):
        return out
    raise BadInput(
        "may not be written to" if nearest.is_dir() else "is not a folder",
        where=nearest,
        expected="a folder that results can be written into",
        remedy="Give another out=.",
    )
