"""Progress with an estimate of the time left: on a terminal, or told to whoever listens."""

import sys
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Callable, Iterable, Iterator, Mapping, Sequence, TypeVar

T = TypeVar("T")
Tell = Callable[[str, float | None], None]  # what is done, and the share done (None: unknown)


def _nobody(what: str, share: float | None) -> None:
    """Say nothing."""


_listener: ContextVar[Tell | None] = ContextVar("listener", default=None)


@contextmanager
def heard_by(listener: Tell = _nobody) -> Iterator[None]:
    """Tell all progress to a listener instead of the terminal; by default to nobody."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


def counted(items: Sequence[T], what: str) -> Iterable[T]:
    """Iterate over items and show how many are done and how long the rest takes."""
    with _shown(what) as tell:
        for done, item in enumerate(items):
            tell(what, done / len(items))
            yield item


@contextmanager
def reported(what: str) -> Iterator[Callable[[int, int], None]]:
    """Yield a function to be called with rounds done and rounds in all."""
    with _shown(what) as tell:
        yield lambda done, total: tell(what, done / total if total else None)


@contextmanager
def staged(what: str, begins: Mapping[str, float]) -> Iterator[Callable[[str], None]]:
    """Yield a function to be called with the name of each stage as it begins.

    `begins`: share of the time that is usually over when a stage begins.
    """
    with _shown(what) as tell:
        yield lambda name: tell(f"{what}: {name}", begins.get(name))


@contextmanager
def _shown(what: str) -> Iterator[Tell]:
    """Where progress goes: to the listener, onto a terminal, or nowhere."""
    listener = _listener.get()
    if listener is not None or not sys.stderr.isatty():
        tell = listener or _nobody
        tell(what, None)
        yield tell
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeRemainingColumn

    columns = (
        SpinnerColumn(), TextColumn("{task.description}"), BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"), TimeRemainingColumn(elapsed_when_finished=True),
    )  # fmt: skip
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task(what, total=None)
        yield lambda text, share: bars.update(
            task, description=text, total=None if share is None else 1.0, completed=share or 0.0
        )
