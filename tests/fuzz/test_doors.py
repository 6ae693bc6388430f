"""Hostile input at every door: one message or a sound result, in bounded time and memory.

`make fuzz` tries long; the tests, `ROVSIM_FUZZ` inputs a door.
"""

import os
import resource
import signal
import traceback
import zlib
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from fuzz.entry import ENTRIES
from rovsim.core.errors import RovsimError

for doors in sorted(Path(__file__).parent.glob("[!_t]*.py")):
    import_module(f"fuzz.{doors.stem}")

COUNT = int(os.environ.get("ROVSIM_FUZZ", "12"))  # inputs at each door
FIRST = int(os.environ.get("ROVSIM_FUZZ_FIRST", "0"))  # seed of the first
FEWEST = 10
LONGEST = 10.0  # s of the processor an input: the machine may be busy with something else
WAITED = 300  # s an input by the clock
MEMORY = 1 << 30  # bytes an input may add
LONGEST_MESSAGE = 5000  # characters


@contextmanager
def bounded():
    """End what takes too long; refuse memory beyond what is held already."""

    def over(*_):
        raise TimeoutError(f"longer than {LONGEST:g} s of the processor, or {WAITED} s")

    held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    before = resource.getrlimit(resource.RLIMIT_AS)
    handlers = {sign: signal.signal(sign, over) for sign in (signal.SIGALRM, signal.SIGPROF)}
    resource.setrlimit(resource.RLIMIT_AS, (held + MEMORY, before[1]))
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    signal.alarm(WAITED)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.alarm(0)
        for sign, handler in handlers.items():
            signal.signal(sign, handler)
        resource.setrlimit(resource.RLIMIT_AS, before)


def refused(entry) -> bool:
    """Whether the input was refused, which takes one message."""
    try:
        with bounded():
            entry.enter()
    except RovsimError as error:
        said = str(error)
    else:
        return False
    assert len(said) < LONGEST_MESSAGE
    return True


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # numbers near the largest overflow
@pytest.mark.parametrize("name", sorted(ENTRIES))
def test_a_door_refuses_or_takes(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    entry = ENTRIES[name](tmp_path)
    entry.prepare()
    entry.enter()  # the valid input; it may compile, which takes longer than any input may
    seeds = range(FIRST, FIRST + max(int(COUNT * entry.share), FEWEST))
    refusals, failures = 0, {}
    for seed in seeds:
        entry.damage(np.random.default_rng([zlib.crc32(name.encode()), seed]))
        try:
            refusals += refused(entry)
        except Exception as error:  # all are found in one go, each kind told once
            frame = traceback.extract_tb(error.__traceback__)[-1]
            kind = f"{type(error).__name__} at {Path(frame.filename).name}:{frame.lineno}"
            failures.setdefault(kind, []).append(seed)
    assert not failures, f"by seed (ROVSIM_FUZZ_FIRST): {failures}"
    assert refusals or not entry.refuses, "no damage was ever noticed"
