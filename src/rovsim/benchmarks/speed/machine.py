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
    """Run before other programs, as a control loop does, where the system allows it; says if.

    Not with real-time scheduling: Linux stops a real-time program that never waits, as a benchmark
    does not, for 50 ms in every second.
    """
    try:
        before = os.getpriority(os.PRIO_PROCESS, 0)
        os.setpriority(os.PRIO_PROCESS, 0, -20)
    except (AttributeError, OSError):
        yield "at the priority of any other program"
        return
    try:
        yield "at the highest ordinary priority (nice -20)"
    finally:
        os.setpriority(os.PRIO_PROCESS, 0, before)
