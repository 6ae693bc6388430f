"""SIGTERM, by which schedulers and services end a process, as Ctrl-C: what was begun is undone."""

import signal
import sys
import threading
from contextlib import contextmanager
from types import FrameType
from typing import Iterator, NoReturn

CODE = 128 + signal.SIGTERM  # what a shell makes of a process that this signal ended


class Terminated(KeyboardInterrupt):
    """Somebody asked this process to end."""


@contextmanager
def heeding_termination() -> Iterator[None]:
    """Let SIGTERM raise `Terminated` once, where this thread may say so."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def exit_on_termination() -> None:
    """Let SIGTERM end this process the ordinary way, so that it leaves no half of a file."""
    signal.signal(signal.SIGTERM, _exit)


def _terminate(*_: int | FrameType | None) -> NoReturn:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # nothing disturbs what is now cleared away
    raise Terminated


def _exit(*_: int | FrameType | None) -> NoReturn:
    sys.exit(CODE)
