"""What stands at the start of the files of a format, by which they are recognised."""

from dataclasses import dataclass
from typing import Callable

HEAD = 1 << 16  # bytes from the start of a file: more than any header


@dataclass(frozen=True)
class Signature:
    """Whether the first bytes of a file are of a format.

    `endings`: what its name has to end in, where the format's readers go by that; `what` people
    call such a file.
    """

    matches: Callable[[bytes], bool]
    what: str = ""
    endings: tuple[str, ...] = ()


def starts_with(magic: bytes) -> Callable[[bytes], bool]:
    """Whether bytes begin with these."""
    return lambda head: head.startswith(magic)


def decoded(head: bytes) -> str | None:
    """The start of a file of text; None where it is none."""
    try:
        # the last character may be cut
        text = head.decode("utf-8-sig", errors="strict" if len(head) < HEAD else "ignore")
    except UnicodeDecodeError:
        return None
    return None if "\0" in text else text


def head_lines(head: bytes) -> list[str]:
    """Lines of text that are not empty, without remarks if there are others."""
    lines = [line for line in (decoded(head) or "").split("\n") if line.strip()]
    return [line for line in lines if not line.startswith("#")] or lines
