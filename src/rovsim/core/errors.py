"""Errors a user can act on: what was found, where, what was expected, what to do."""

from difflib import get_close_matches
from typing import Iterable

LONGEST = 1000  # characters of what a message quotes
MOST = 40  # names that a message lists


class RovsimError(Exception):
    """Base of every error raised on purpose. Its text is the whole message for the user."""


class BadInput(RovsimError):
    """Input that cannot be used. The command line turns it into one message and exit code 2."""

    def __init__(self, found: str, *, where: object, expected: str, remedy: str) -> None:
        found, where = shortened(found), shortened(str(where))
        expected, remedy = shortened(expected), shortened(remedy)
        self.found, self.where, self.expected, self.remedy = found, where, expected, remedy
        # names that are all listed already are not listed twice
        advice = "" if remedy == f"Known: {expected.removeprefix('one of ')}." else f" {remedy}"
        super().__init__(f"{where}: {found}. Expected {expected}.{advice}")

    def __reduce__(self):
        # keyword-only arguments would otherwise be lost between processes
        return _rebuild, (self.found, self.where, self.expected, self.remedy)


def shortened(text: str) -> str:
    """A text on one line of bounded length: what a file holds may be anything."""
    line = one_line(text[: LONGEST + 1])
    return line if len(line) <= LONGEST else f"{line[:LONGEST]} …"


def one_line(text: str) -> str:
    """A text without line breaks and control characters: these as they are typed in Python."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def _rebuild(found: str, where: str, expected: str, remedy: str) -> BadInput:
    return BadInput(found, where=where, expected=expected, remedy=remedy)


def nearest(name: str, known: Iterable[str]) -> str:
    """Return a remedy for an unknown name: the nearest known one, else all of them."""
    names = [str(k) for k in known]
    close = get_close_matches(str(name), names, n=1, cutoff=0.5)
    if close:
        return f"Did you mean '{close[0]}'?"
    more = f" and {len(names) - MOST} more" if len(names) > MOST else ""
    return f"Known: {', '.join(names[:MOST]) or 'none'}{more}."
