"""Show the progress of long work in one line of a notebook's cell."""

import sys
from contextlib import contextmanager
from typing import Iterator

from rovsim.core.progress import heard_by

MAX_LINES = 20  # a notebook keeps what a cell wrote


@contextmanager
def in_a_cell() -> Iterator[None]:
    """Show progress in the running cell; does nothing outside a notebook."""
    if "ipykernel" not in sys.modules:
        yield
        return
    shown = ""

    def tell(what: str, share: float | None) -> None:
        nonlocal shown
        percent = "" if share is None else f" {round(MAX_LINES * share) * 100 // MAX_LINES} %"
        line = f"{what}{percent}"
        if line != shown:
            print(f"\r{line:<78}", end="", flush=True)
            shown = line

    with heard_by(tell):
        yield
    print(f"\r{'':<78}\r", end="", flush=True)
