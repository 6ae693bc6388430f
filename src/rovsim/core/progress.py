"""Show progress and an estimate of the time left on a terminal, or report it to a listener."""

import sys
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Callable, Iterable, Iterator, Mapping, Sequence, TypeVar

T = TypeVar("T")
HALFWAY_STEPS = 40  # of a stage, after which it is shown as half over
MIN_SHARE_STEP = 0.002  # share: smaller progress is not reported
Tell = Callable[[str, float | None], None]  # takes the task, and the share done (None: unknown)


def _nobody(what: str, share: float | None) -> None:
    """Ignore progress."""


class _Bar:
    """Progress of stages whose numbers of steps are unknown.

    Within a stage the share approaches the beginning of the next stage but never reaches it. If an
    earlier stage is begun again, the share does not go back.

    Args:
        what: name of the task.
        begins: share of the time that is usually over when each stage begins.
        tell: takes the reports.
    """

    def __init__(self, what: str, begins: Mapping[str, float], tell: Tell) -> None:
        self.what, self.begins, self.tell = what, begins, tell
        self.text, self.low, self.high = what, 0.0, 1.0
        self.steps, self.share = 0, 0.0  # steps of this stage; share that was reported last

    def begin(self, name: str) -> None:
        """Report that a stage begins."""
        self.low = max(self.share, self.begins.get(name, 0.0))
        self.high = min((b for b in self.begins.values() if b > self.low), default=1.0)
        self.text, self.steps = f"{self.what}: {name}", 0
        self._tell(self.low)

    def step(self) -> None:
        """Count a step, and report it if the share has changed visibly."""
        self.steps += 1
        share = self.low + (self.high - self.low) * self.steps / (self.steps + HALFWAY_STEPS)
        if share - self.share > MIN_SHARE_STEP:
            self._tell(share)

    def _tell(self, share: float) -> None:
        self.share = share
        self.tell(self.text, share)


_listener: ContextVar[Tell | None] = ContextVar("listener", default=None)
_bar: ContextVar[_Bar | None] = ContextVar("bar", default=None)


@contextmanager
def heard_by(listener: Tell = _nobody) -> Iterator[None]:
    """Report all progress to a listener instead of the terminal; by default to nobody."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


def counted(items: Sequence[T], what: str) -> Iterable[T]:
    """Iterate over items and show how many are done and how long the rest takes."""
    with _shown(what) as tell:
        for k, item in enumerate(items):
            tell(what, k / len(items))
            yield item


@contextmanager
def reported(what: str) -> Iterator[Callable[[int, int], None]]:
    """Yield a function to be called with the number of rounds done and the total number."""
    with _shown(what) as tell:
        yield lambda k, count: tell(what, k / count if count else None)


@contextmanager
def staged(what: str, begins: Mapping[str, float]) -> Iterator[None]:
    """Show the progress of long work in stages, each of which begins with `begin_stage`.

    Within a stage, every call of `step` moves the progress towards the next stage.

    Args:
        what: name of the task.
        begins: share of the time that is usually over when each stage begins.
    """
    with _shown(what) as tell:
        token = _bar.set(_Bar(what, begins, tell))
        try:
            yield
        finally:
            _bar.reset(token)


def begin_stage(name: str) -> None:
    """Report that a stage of long work begins; does nothing outside of `staged`."""
    if bar := _bar.get():
        bar.begin(name)


def step() -> None:
    """Report that one of the many steps of a stage is done; does nothing outside of `staged`."""
    if bar := _bar.get():
        bar.step()


@contextmanager
def _shown(what: str) -> Iterator[Tell]:
    """Yield what takes reports: a listener, a terminal, or a function that does nothing."""
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
