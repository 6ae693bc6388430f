"""Work on all cores, in threads: compiled kernels release the interpreter's lock (GIL).

Numba's own parallel loops would double the time of compilation, and two of them must not run at
the same time in one process. What is shared out are jobs that are independent of each other, so
the results do not depend on the number of cores.

A job may share out parts of its own work. Whoever shares out from within a job does these parts
itself, from the last one on, and threads that have nothing else to do take them from the first one
on. So no more threads work than there are cores, and none waits for work that nobody has begun.
"""

import os
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import ContextVar, copy_context
from functools import cache, partial
from itertools import pairwise
from threading import Event, Lock
from typing import Any, Callable, Generic, Iterable, Sequence, TypeVar

import numpy as np

T = TypeVar("T")
# Of the job that this thread does: set once nobody waits any more for what it gives.
_abandoned: ContextVar[Event | None] = ContextVar("abandoned", default=None)
PIECES_PER_CORE = 4  # of the jobs: with more pieces than cores, all end at about the same time


class Abandoned(Exception):
    """Raised within a job that nobody waits for any more."""


def count_cores() -> int:
    """How many threads may work at once: NUMBA_NUM_THREADS, or all cores of the machine."""
    from numba import config  # takes a while, and most commands never need it

    return int(config.NUMBA_NUM_THREADS)  # type: ignore[attr-defined]


@cache
def _threads(count: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(count, "rovsim")


if hasattr(os, "register_at_fork"):  # a forked child process has none of the threads
    os.register_at_fork(after_in_child=_threads.cache_clear)


def on_cores(kernel: Callable[[slice], None], lengths: np.ndarray) -> None:
    """Call `kernel(part)` for parts of about equal duration, NUMBA_NUM_THREADS at a time.

    Args:
        kernel: does a slice of the jobs, without the interpreter's lock (GIL).
        lengths: (j,) relative duration of each job, in any unit.
    """
    cores = count_cores()
    if cores == 1 or len(lengths) < 2:
        kernel(slice(0, len(lengths)))
        return
    ends = np.cumsum(lengths)
    cuts = np.searchsorted(ends, np.linspace(0.0, ends[-1], PIECES_PER_CORE * cores + 1)[1:-1])
    parts = [0, *np.unique(cuts), len(lengths)]
    _share_out([partial(kernel, slice(a, b)) for a, b in pairwise(parts) if b > a])


def map_on_cores(function: Callable[..., T], *arguments: Iterable[Any]) -> list[T]:
    """As `list(map(function, *arguments))`, NUMBA_NUM_THREADS calls at a time.

    It pays for functions that mostly run without the interpreter's lock (GIL): numpy on large
    arrays, and kernels, also on all cores. Each call sees the caller's context (`contextvars`), of
    which numpy's error handling is a part. What is raised is the exception of the first call that
    fails; the others then end before their next kernel, as they do where the caller is interrupted.
    """
    rows = list(zip(*arguments, strict=True))
    if count_cores() == 1 or len(rows) < 2:
        return [function(*row) for row in rows]
    return _share_out([partial(function, *row) for row in rows])


class _Job(Generic[T]):
    """A call that is made once, by whoever comes first."""

    def __init__(self, call: Callable[[], T], abandoned: Event) -> None:
        self._call, self._claim, self._context = call, Lock(), copy_context()
        self._context.run(_abandoned.set, abandoned)
        self._outcome: Future[T] = Future()

    def do(self) -> None:
        """Make the call, unless another thread did or does."""
        if not self._claim.acquire(blocking=False):
            return
        try:
            self._outcome.set_result(self._context.run(self._call))
        except BaseException as error:  # whoever waits for the result raises it
            self._outcome.set_exception(error)

    def wait(self) -> T:
        """What the call gives, once it is made."""
        return self._outcome.result()


def _share_out(calls: Sequence[Callable[[], T]]) -> list[T]:
    """What calls give, in their order; they are shared out among threads."""
    inherited = _abandoned.get()
    if inherited is not None and inherited.is_set():
        raise Abandoned
    abandoned = inherited or Event()
    jobs = [_Job(call, abandoned) for call in calls]
    for job in jobs:
        _threads(count_cores()).submit(job.do)
    if inherited is not None:
        for job in reversed(jobs):
            job.do()
        return [job.wait() for job in jobs]
    try:
        return [job.wait() for job in jobs]
    finally:
        abandoned.set()
