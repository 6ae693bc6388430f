"""Treat SIGTERM, with which schedulers and services end a process, like Ctrl-C, to clean up."""

import signal
import sys
import threading
from contextlib import contextmanager
from types import FrameType
from typing import Iterator, NoReturn

SIGTERM_EXIT = 128 + signal.SIGTERM  # that a shell reports for a process that SIGTERM ended


class Terminated(KeyboardInterrupt):
    """Raised when SIGTERM asks this process to end."""


@contextmanager
def heeding_termination() -> Iterator[None]:
    """Let SIGTERM raise `Terminated` once; does nothing outside of the main thread."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = signal.signal(signal.SIGTERM, _terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, previous)


def exit_on_termination() -> None:
    """Let SIGTERM end this process by `SystemExit`, so that it leaves no unfinished file."""
    signal.signal(signal.SIGTERM, _exit)


def _terminate(*_: int | FrameType | None) -> NoReturn:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # a second signal must not disturb the clean-up
    raise Terminated


def _exit(*_: int | FrameType | None) -> NoReturn:
    sys.exit(SIGTERM_EXIT)
