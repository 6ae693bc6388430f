"""Progress with an estimate of the time left, on terminals only."""

import sys
from contextlib import contextmanager
from typing import Callable, Iterable, Iterator, Sequence, TypeVar

T = TypeVar("T")


def counted(items: Sequence[T], what: str) -> Iterable[T]:
    """Iterate over items and show how many are done and how long the rest takes."""
    if not sys.stderr.isatty():
        return items
    from rich.console import Console
    from rich.progress import track

    return track(items, description=what, console=Console(stderr=True), transient=True)


@contextmanager
def reported(what: str) -> Iterator[Callable[[int, int], None]]:
    """Yield a function to be called with rounds done and rounds in all."""
    if not sys.stderr.isatty():
        yield lambda done, total: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task(what, total=None)
        yield lambda done, total: bars.update(task, completed=done, total=total)


@contextmanager
def staged(what: str) -> Iterator[Callable[[str], None]]:
    """Yield a function to be called with the name of each stage as it begins."""
    if not sys.stderr.isatty():
        yield lambda name: None
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task(what, total=None)
        yield lambda name: bars.update(task, description=f"{what}: {name}")
