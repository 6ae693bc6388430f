"""Runs a benchmark at the priority of a control loop."""

import os
from contextlib import contextmanager
from typing import Iterator


@contextmanager
def as_a_control_loop() -> Iterator[str]:
    """Run before other programs, as a control loop does, where the system allows it.

    Not with real-time scheduling: Linux stops a real-time program that never waits, as a benchmark
    does not, for 50 ms in every second.

    Yields:
        A description of the priority.
    """
    try:
        priority = os.getpriority(os.PRIO_PROCESS, 0)
        os.setpriority(os.PRIO_PROCESS, 0, -20)
    except (AttributeError, OSError):
        yield "at the priority of any other program"
        return
    try:
        yield "at the highest ordinary priority (nice -20)"
    finally:
        os.setpriority(os.PRIO_PROCESS, 0, priority)
