"""Check names that users give: each must be one line of text, wherever it is shown or written.

A name with a line break would leave the comment, string or cell in which it is written: in a MATLAB
function the rest of it would be a command.
"""

from pathlib import Path
from typing import Annotated, Iterable
from unicodedata import category

from pydantic import AfterValidator

from rovsim.core.errors import BadInput

# Unicode's control characters, halves of pairs, and separators of lines and of paragraphs.
BREAKING_CATEGORIES = ("Cc", "Cs", "Zl", "Zp")
EXPECTED_NAME = "a name on one line, without control characters"


def is_name(text: str) -> bool:
    """Whether a text has no characters that break its line."""
    return not any(category(c) in BREAKING_CATEGORIES for c in text)


def _name(text: str) -> str:
    if not is_name(text):
        raise ValueError(EXPECTED_NAME)
    return text


Name = Annotated[str, AfterValidator(_name)]


def as_list(given: str | Iterable[str]) -> list[str]:
    """Make a list of names from one name or several."""
    return [given] if isinstance(given, str) else list(given)


def name_of(path: Path) -> str:
    """Name a thing after its file: the stem of the file's name.

    Raises:
        BadInput: the stem holds control characters.
    """
    if is_name(path.stem):
        return path.stem
    raise BadInput(
        "the name of this file holds control characters",
        where=path,
        expected=EXPECTED_NAME,
        remedy="Rename the file.",
    )
