"""The machine, and how a control loop would run on it."""

import os
import platform
from contextlib import contextmanager, suppress
from typing import Iterator


def machine() -> str:
    """Processor, cores and Python."""
    name = platform.processor() or platform.machine()
    with suppress(OSError, StopIteration), open("/proc/cpuinfo", encoding="utf-8") as info:
        name = next(line.split(":")[1].strip() for line in info if "model name" in line)
    return f"{name}, {os.cpu_count()} cores, Python {platform.python_version()}"


@contextmanager
def as_a_control_loop() -> Iterator[str]:
    """Run with real-time priority, as a control loop does, where the system allows it.

    Without it a deadline may be missed because another program had its turn; says which it was.
    """
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    except (AttributeError, OSError):
        yield "as any other program"
        return
    try:
        yield "real-time priority (SCHED_FIFO)"
    finally:
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
