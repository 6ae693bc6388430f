"""Compiled kernels on all cores, in threads: they need no interpreter, so none waits for another.

Numba's own parallel loops take as long to compile as all the rest, and must not run twice at once
in a process. A kernel's jobs are independent, so the numbers do not depend on how many cores.
"""

import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from typing import Any, Callable

import numpy as np
from numba import config

from rovsim.dynamics.engine.types import Jobs

PIECES = 4  # for each core, so that none waits long for the last


@cache
def _threads(count: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(count, "rovsim")


if hasattr(os, "register_at_fork"):  # where processes fork, a child has none of the threads
    os.register_at_fork(after_in_child=_threads.cache_clear)


def run_jobs(kernel: Callable, jobs: Jobs, *given: Any) -> None:
    """`kernel(jobs, *given)`, shared by the cores; the kernel must not need the interpreter."""
    on_cores(lambda part: kernel(Jobs(*(values[part] for values in jobs)), *given), jobs.steps)


def on_cores(kernel: Callable[[slice], None], lengths: np.ndarray) -> None:
    """Call `kernel(part)` for parts of jobs that take about as long; NUMBA_NUM_THREADS at once.

    Args:
        kernel: works off a slice of the jobs, without the interpreter's lock.
        lengths: how long each job (j,) takes, in any unit.
    """
    cores = config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]
    if cores == 1 or len(lengths) < 2:
        kernel(slice(0, len(lengths)))
        return
    ends = np.cumsum(lengths)
    cuts = np.searchsorted(ends, np.linspace(0.0, ends[-1], PIECES * cores + 1)[1:-1])
    parts = [0, *np.unique(cuts), len(lengths)]
    slices = [slice(a, b) for a, b in pairwise(parts) if b > a]
    list(_threads(cores).map(kernel, slices))
