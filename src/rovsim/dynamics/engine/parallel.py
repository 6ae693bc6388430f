"""Run compiled kernels on all cores, in threads: kernels release the interpreter's lock (GIL).

Numba's own parallel loops would double the time of compilation, and two of them must not run at
the same time in one process. The jobs of a kernel are independent of each other, so the results do
not depend on the number of cores.
"""

import os
from concurrent.futures import ThreadPoolExecutor
from contextvars import ContextVar, copy_context
from functools import cache
from itertools import pairwise
from typing import Any, Callable, Iterable, TypeVar

import numpy as np
from numba import config

from rovsim.dynamics.engine.types import Jobs

T = TypeVar("T")
_mapping: ContextVar[bool] = ContextVar("mapping", default=False)
PIECES = 4  # of the jobs for each core: with more pieces than cores, all end at about the same time


@cache
def _threads(count: int, name: str) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(count, f"rovsim_{name}")


if hasattr(os, "register_at_fork"):  # a forked child process has none of the threads
    os.register_at_fork(after_in_child=_threads.cache_clear)


def run_jobs(kernel: Callable, jobs: Jobs, *given: Any) -> None:
    """Call `kernel(part, *given)` for parts of the jobs on all cores; it must release the GIL."""
    on_cores(lambda part: kernel(Jobs(*(values[part] for values in jobs)), *given), jobs.steps)


def on_cores(kernel: Callable[[slice], None], lengths: np.ndarray) -> None:
    """Call `kernel(part)` for parts of about equal duration, NUMBA_NUM_THREADS at a time.

    Args:
        kernel: does a slice of the jobs, without the interpreter's lock (GIL).
        lengths: (j,) relative duration of each job, in any unit.
    """
    cores = config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]
    if cores == 1 or len(lengths) < 2:
        kernel(slice(0, len(lengths)))
        return
    ends = np.cumsum(lengths)
    cuts = np.searchsorted(ends, np.linspace(0.0, ends[-1], PIECES * cores + 1)[1:-1])
    parts = [0, *np.unique(cuts), len(lengths)]
    slices = [slice(a, b) for a, b in pairwise(parts) if b > a]
    list(_threads(cores, "kernels").map(kernel, slices))


def map_on_cores(function: Callable[..., T], *arguments: Iterable[Any]) -> list[T]:
    """As `list(map(function, *arguments))`, NUMBA_NUM_THREADS calls at a time.

    It pays for functions that mostly run without the interpreter's lock (GIL): numpy on large
    arrays, and kernels, also on all cores. Each call sees the caller's context (`contextvars`), of
    which numpy's error handling is a part. Within such a call, others are made one by one.
    """
    rows = list(zip(*arguments, strict=True))
    cores = config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]
    if cores == 1 or len(rows) < 2 or _mapping.get():
        return [function(*row) for row in rows]
    contexts = [copy_context() for _ in rows]
    for context in contexts:
        context.run(_mapping.set, True)
    calls = _threads(cores, "calls").map(
        lambda context, row: context.run(function, *row), contexts, rows
    )
    return list(calls)
