"""Recognise the format of a file by its first bytes."""

from dataclasses import dataclass
from typing import Callable

HEAD_BYTES = 1 << 16  # from the start of a file: more than any header


@dataclass(frozen=True)
class FileSignature:
    """How files of a format are recognised.

    Attributes:
        matches: says whether the first bytes of a file are of this format.
        what: name of such a file, for people.
        endings: endings of the file name, one of which the format's reader needs; empty for any.
    """

    matches: Callable[[bytes], bool]
    what: str = ""
    endings: tuple[str, ...] = ()


def starts_with(magic: bytes) -> Callable[[bytes], bool]:
    """Make a function that says whether bytes begin with `magic`."""
    return lambda head: head.startswith(magic)


def decoded(head: bytes) -> str | None:
    """Decode the first bytes of a file as UTF-8; None where it is not a text file."""
    try:
        # the last character may be cut
        text = head.decode("utf-8-sig", errors="strict" if len(head) < HEAD_BYTES else "ignore")
    except UnicodeDecodeError:
        return None
    return None if "\0" in text else text


def head_lines(head: bytes) -> list[str]:
    """Lines of text that are not empty; without comment lines (#) unless there are only those."""
    lines = [line for line in (decoded(head) or "").split("\n") if line.strip()]
    return [line for line in lines if not line.startswith("#")] or lines
