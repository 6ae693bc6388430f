"""Long work in a process of its own: it tells how far it is, and can be cancelled."""

import multiprocessing
import time
import weakref
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any, Callable

from rovsim.core.errors import BadInput, RovsimError
from rovsim.core.progress import heard_by

FEWEST = 0.1  # share that must be done before anybody can tell how long the rest takes


@dataclass(eq=False)
class Work:
    """A function at work in another process.

    `state`: running, done, failed, cancelled. `what` it does now; `share` done, None if unknown;
    `said`: its result, or why it failed; `after` is called with the result by whoever looks.
    """

    title: str
    after: Callable[[Any], None]
    process: Any
    pipe: Connection
    begun: float = field(default_factory=time.monotonic)
    state: str = "running"
    what: str = "starting"
    share: float | None = None
    said: Any = None

    @staticmethod
    def start(title: str, after: Callable[[Any], None], function: Callable, *given: Any) -> "Work":
        """Start `function(*given)`; everything given must be able to travel between processes."""
        context = multiprocessing.get_context("spawn")  # threads and forks do not mix
        receiver, sender = context.Pipe(duplex=False)
        process = context.Process(target=_run, args=(sender, function, given), daemon=True)
        process.start()
        sender.close()
        work = Work(title, after, process, receiver)
        weakref.finalize(work, process.terminate)  # nobody waits for it any more
        return work

    def look(self) -> str:
        """Take in what the process said since; returns the state."""
        while self.state == "running" and self.pipe.poll():
            try:
                kind, *rest = self.pipe.recv()
            except EOFError:
                kind, rest = "failed", [f"it ended unexpectedly (code {self.process.exitcode})"]
            if kind == "progress":
                self.what, self.share = rest
            else:
                self.state, self.said = kind, rest[0]
        return self.state

    def cancel(self) -> None:
        """End the process; files appear whole or not at all, so nothing half-done is left."""
        if self.state == "running":
            self.state = "cancelled"
            self.process.terminate()

    @property
    def elapsed(self) -> float:
        """Seconds since the start."""
        return time.monotonic() - self.begun

    @property
    def left(self) -> float | None:
        """Seconds that are probably left, None as long as nobody can tell."""
        reliable = self.share is not None and self.share >= FEWEST
        return self.elapsed * (1.0 / self.share - 1.0) if reliable and self.share else None


@dataclass(eq=False)
class LongWork:
    """Long work, one at a time.

    `now` goes on; `said` tells of what ended last, `trouble` why it failed, until somebody has read
    it (`why`: the reason alone); `ended`: how often any has.
    """

    now: Work | None = None
    said: str = ""
    trouble: str = ""
    why: str = ""
    ended: int = 0

    def begin(
        self, title: str, after: Callable[[Any], None], function: Callable, *given: Any
    ) -> None:
        """See `Work.start`.

        Raises:
            BadInput: other work goes on.
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
        """Take in what came of it; the state of what has just ended, or nothing."""
        work = self.now
        if work is None or work.look() == "running":
            return ""
        self.now = None
        if work.state == "done":
            work.after(work.said)
        elif work.state == "failed":
            self.why, self.trouble = work.said, f"{work.title}: {work.said}"
        self.ended += 1
        self.said = {
            "done": f"{work.title}: done in {work.elapsed:.0f} s.",
            "failed": "",
            "cancelled": f"{work.title}: cancelled, nothing was changed.",
        }[work.state]
        return work.state


def reap() -> None:
    """Let processes go that have ended; the system keeps each until it is asked about it."""
    multiprocessing.active_children()


def _run(pipe: Connection, function: Callable, given: tuple) -> None:
    """In the other process."""
    with heard_by(lambda what, share: pipe.send(("progress", what, share))):
        try:
            result = ("done", function(*given))
        except RovsimError as error:
            result = ("failed", str(error))
        except Exception as error:  # a bug: say so in the browser, with the kind of it
            result = ("failed", f"an error of the program: {type(error).__name__}: {error}")
    pipe.send(result)
