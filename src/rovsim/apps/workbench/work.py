"""Long work in another process, which reports its progress and can be cancelled."""

import multiprocessing
import time
import weakref
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any, Callable

from rovsim.core.errors import BadInput, RovsimError
from rovsim.core.progress import heard_by

MIN_DONE_SHARE = 0.1  # that must be done before anybody can tell how long the rest takes


@dataclass(eq=False)
class Work:
    """A function that runs in another process.

    Attributes:
        title: of the work.
        after: to be called with the result.
        process: that it runs in.
        pipe: that progress and result come through.
        begun: when it was started, s of the monotonic clock.
        state: running, done, failed or cancelled.
        what: it does at present.
        share: of the work that is done, 0 to 1; None if unknown.
        outcome: the result, or why it failed.
    """

    title: str
    after: Callable[[Any], None]
    process: Any
    pipe: Connection
    begun: float = field(default_factory=time.monotonic)
    state: str = "running"
    what: str = "starting"
    share: float | None = None
    outcome: Any = None

    @staticmethod
    def start(title: str, after: Callable[[Any], None], function: Callable, *given: Any) -> "Work":
        """Start `function(*given)` in another process; function and arguments must be picklable."""
        context = multiprocessing.get_context("spawn")  # threads and forks do not mix
        receiver, sender = context.Pipe(duplex=False)
        process = context.Process(target=_run, args=(sender, function, given), daemon=True)
        process.start()
        sender.close()
        work = Work(title, after, process, receiver)
        weakref.finalize(work, process.terminate)  # ends it once the work is forgotten
        return work

    def look(self) -> str:
        """Read all messages of the process since the last call; returns the state."""
        while self.state == "running" and self.pipe.poll():
            try:
                kind, *rest = self.pipe.recv()
            except EOFError:
                kind, rest = "failed", [f"it ended unexpectedly (code {self.process.exitcode})"]
            if kind == "progress":
                self.what, self.share = rest
            else:
                self.state, self.outcome = kind, rest[0]
        return self.state

    def cancel(self) -> None:
        """End the process; files are written whole or not at all, so none is left incomplete."""
        if self.state == "running":
            self.state = "cancelled"
            self.process.terminate()

    @property
    def elapsed(self) -> float:
        """Seconds since the start."""
        return time.monotonic() - self.begun

    @property
    def left(self) -> float | None:
        """Estimated remaining time, s; None before `MIN_DONE_SHARE` of the work is done."""
        reliable = self.share is not None and self.share >= MIN_DONE_SHARE
        return self.elapsed * (1.0 / self.share - 1.0) if reliable and self.share else None


@dataclass(eq=False)
class LongWork:
    """Long work, one after the other.

    Attributes:
        now: the work that is running; None where none is.
        message: a sentence on the work that ended last.
        trouble: why work failed, with its title, until the user has read it.
        why: the same without the title.
        ended: how often work has ended.
    """

    now: Work | None = None
    message: str = ""
    trouble: str = ""
    why: str = ""
    ended: int = 0

    def begin(
        self, title: str, after: Callable[[Any], None], function: Callable, *given: Any
    ) -> None:
        """Start work, see `Work.start`.

        Raises:
            BadInput: other work is running.
        """
        if self.now is not None:
            raise BadInput(
                f"'{self.now.title}' goes on",
                where="workbench",
                expected="one long work at a time",
                remedy="Wait for its end, or cancel it.",
            )
        self.now = Work.start(title, after, function, *given)

    def settle(self) -> str:
        """Load the result of work that has just ended; returns its state, or "" if none has."""
        work = self.now
        if work is None or work.look() == "running":
            return ""
        self.now = None
        if work.state == "done":
            work.after(work.outcome)
        elif work.state == "failed":
            self.why, self.trouble = work.outcome, f"{work.title}: {work.outcome}"
        self.ended += 1
        self.message = {
            "done": f"{work.title}: done in {work.elapsed:.0f} s.",
            "failed": "",
            "cancelled": f"{work.title}: cancelled, nothing was changed.",
        }[work.state]
        return work.state


def reap() -> None:
    """Release processes that have ended, which the system keeps until it is asked about them."""
    multiprocessing.active_children()


def _run(pipe: Connection, function: Callable, given: tuple) -> None:
    """Run a function in the other process, and send progress and result through the pipe."""
    with heard_by(lambda what, share: pipe.send(("progress", what, share))):
        try:
            result = ("done", function(*given))
        except RovsimError as error:
            result = ("failed", str(error))
        except Exception as error:  # a bug: say so in the browser, with the kind of it
            result = ("failed", f"an error of the program: {type(error).__name__}: {error}")
    pipe.send(result)
