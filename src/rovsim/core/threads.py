"""Work on all cores, in threads: compiled kernels release the interpreter's lock (GIL).

Numba's own parallel loops would double the time of compilation, and two of them must not run at
the same time in one process. What is shared out are jobs that are independent of each other, so
the results do not depend on the number of cores.
"""

import os
from concurrent.futures import ThreadPoolExecutor
from contextvars import ContextVar, copy_context
from functools import cache
from itertools import pairwise
from typing import Any, Callable, Iterable, TypeVar

import numpy as np

T = TypeVar("T")
_mapping: ContextVar[bool] = ContextVar("mapping", default=False)
PIECES_PER_CORE = 4  # of the jobs: with more pieces than cores, all end at about the same time


def count_cores() -> int:
    """How many threads may work at once: NUMBA_NUM_THREADS, or all cores of the machine."""
    from numba import config  # takes a while, and most commands never need it

    return int(config.NUMBA_NUM_THREADS)  # type: ignore[attr-defined]


@cache
def _threads(count: int, name: str) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(count, f"rovsim_{name}")


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
    slices = [slice(a, b) for a, b in pairwise(parts) if b > a]
    list(_threads(cores, "kernels").map(kernel, slices))


def map_on_cores(function: Callable[..., T], *arguments: Iterable[Any]) -> list[T]:
    """As `list(map(function, *arguments))`, NUMBA_NUM_THREADS calls at a time.

    It pays for functions that mostly run without the interpreter's lock (GIL): numpy on large
    arrays, and kernels, also on all cores. Each call sees the caller's context (`contextvars`), of
    which numpy's error handling is a part. Within such a call, others are made one by one.
    """
    rows = list(zip(*arguments, strict=True))
    cores = count_cores()
    if cores == 1 or len(rows) < 2 or _mapping.get():
        return [function(*row) for row in rows]
    contexts = [copy_context() for _ in rows]
    for context in contexts:
        context.run(_mapping.set, True)
    calls = _threads(cores, "calls").map(
        lambda context, row: context.run(function, *row), contexts, rows
    )
    return list(calls)
