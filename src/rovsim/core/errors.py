"""Errors a user can act on: what was found, where, what was expected, what to do."""

from contextlib import contextmanager
from difflib import get_close_matches
from typing import Iterable, Iterator, Sequence

MAX_QUOTED_CHARACTERS = 1000  # of a text that a message quotes
MAX_LISTED_NAMES = 40  # that a message lists


class RovsimError(Exception):
    """Base of every error raised on purpose. Its text is the whole message for the user."""


class BadInput(RovsimError):
    """Input that cannot be used. The command line turns it into one message and exit code 2.

    Attributes:
        found: what was found.
        where: the file, and the place in it.
        expected: what should be there.
        remedy: what the user can do, in whole sentences.
    """

    def __init__(self, found: str, *, where: object, expected: str, remedy: str) -> None:
        found, where = shortened(found), shortened(str(where))
        expected, remedy = shortened(expected), shortened(remedy)
        self.found, self.where, self.expected, self.remedy = found, where, expected, remedy
        super().__init__(f"{where}: {found}. Expected {expected}. {remedy}".rstrip())

    def __reduce__(self):
        # keyword-only arguments would otherwise be lost between processes
        return _rebuild, (self.found, self.where, self.expected, self.remedy)


def shortened(text: str) -> str:
    """Bring the text of any file to one line of at most `MAX_QUOTED_CHARACTERS`."""
    line = one_line(text[: MAX_QUOTED_CHARACTERS + 1])
    return line if len(line) <= MAX_QUOTED_CHARACTERS else f"{line[:MAX_QUOTED_CHARACTERS]} …"


def one_line(text: str) -> str:
    """Write line breaks and control characters of a text as Python's escape sequences."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def _rebuild(found: str, where: str, expected: str, remedy: str) -> BadInput:
    return BadInput(found, where=where, expected=expected, remedy=remedy)


@contextmanager
def located(file: object) -> Iterator[None]:
    """Add the name of a file to errors that only say where in the file they are.

    Raises:
        BadInput: the error, with the file in front of its place.
    """
    try:
        yield
    except BadInput as error:
        where = error.where if str(file) in error.where else f"{file}, {error.where}"
        raise BadInput(
            error.found, where=where, expected=error.expected, remedy=error.remedy
        ) from None


def unlisted(name: str, known_names: Iterable[str], *, found: str, where: object) -> BadInput:
    """Make the error for an unknown name: it lists the known ones and suggests the nearest."""
    names = [str(k) for k in known_names]
    return BadInput(
        found, where=where, expected=f"one of {', '.join(names)}", remedy=closest(name, names)
    )


def nearest(name: str, known_names: Iterable[str]) -> str:
    """Return a remedy for an unknown name: the nearest known one, else all of them."""
    names = [str(k) for k in known_names]
    more = f" and {len(names) - MAX_LISTED_NAMES} more" if len(names) > MAX_LISTED_NAMES else ""
    return closest(name, names) or f"Known: {', '.join(names[:MAX_LISTED_NAMES]) or 'none'}{more}."


def closest(name: str, names: Sequence[str]) -> str:
    """Ask whether the nearest name was meant; empty where none is near."""
    close = get_close_matches(str(name), names, n=1, cutoff=0.5)
    return f"Did you mean '{close[0]}'?" if close else ""
