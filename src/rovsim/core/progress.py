"""Progress with an estimate of the time left: on a terminal, or told to whoever listens."""

import sys
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Callable, Iterable, Iterator, Mapping, Sequence, TypeVar

T = TypeVar("T")
HALF = 40  # steps of a stage after which it is shown as half over
FINEST = 0.002  # share: less is not told
Tell = Callable[[str, float | None], None]  # what is done, and the share done (None: unknown)


def _nobody(what: str, share: float | None) -> None:
    """Say nothing."""


class _Bar:
    """How far stages are, of which nobody knows how many steps they have.

    Within a stage the share nears the next one's begin, and never gets there; what is begun again
    goes on from where it was.
    """

    def __init__(self, what: str, begins: Mapping[str, float], tell: Tell) -> None:
        self.what, self.begins, self.tell = what, begins, tell
        self.text, self.low, self.high = what, 0.0, 1.0
        self.steps, self.share = 0, 0.0  # in this stage; as told

    def begin(self, name: str) -> None:
        """Tell that a stage begins."""
        self.low = max(self.share, self.begins.get(name, 0.0))
        self.high = min((b for b in self.begins.values() if b > self.low), default=1.0)
        self.text, self.steps = f"{self.what}: {name}", 0
        self._tell(self.low)

    def step(self) -> None:
        """Tell that it goes on, if anybody would see that."""
        self.steps += 1
        share = self.low + (self.high - self.low) * self.steps / (self.steps + HALF)
        if share - self.share > FINEST:
            self._tell(share)

    def _tell(self, share: float) -> None:
        self.share = share
        self.tell(self.text, share)


_listener: ContextVar[Tell | None] = ContextVar("listener", default=None)
_bar: ContextVar[_Bar | None] = ContextVar("bar", default=None)


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

    `begins`: share of the time that is usually over when a stage begins. Between two stages every
    `step` that is told goes on towards the next.
    """
    with _shown(what) as tell:
        bar = _Bar(what, begins, tell)
        token = _bar.set(bar)
        try:
            yield bar.begin
        finally:
            _bar.reset(token)


def step() -> None:
    """Tell that one of the many steps of a stage is done; nothing where no stages are shown."""
    if bar := _bar.get():
        bar.step()


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
        SpinnerColumn(),
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeRemainingColumn(elapsed_when_finished=True),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task(what, total=None)
        yield lambda text, share: bars.update(
            task, description=text, total=None if share is None else 1.0, completed=share or 0.0
        )
