"""Work on all cores, in threads: compiled code that lets go of the interpreter need not wait."""

import os
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from functools import cache
from typing import Callable, Sequence, TypeVar

A = TypeVar("A")
B = TypeVar("B")


@cache
def threads(name: str, count: int) -> ThreadPoolExecutor:
    """The pool of so many threads of a name. Those of one pool must not wait for each other."""
    return ThreadPoolExecutor(count, f"rovsim-{name}")


if hasattr(os, "register_at_fork"):  # where processes fork, a child has none of the threads
    os.register_at_fork(after_in_child=threads.cache_clear)


def side_by_side(work: Callable[[A], B], things: Sequence[A], cores: int) -> list[B]:
    """`[work(one) for one in things]`, `cores` at once; not for work that does this itself."""
    if cores == 1 or len(things) < 2:
        return [work(one) for one in things]
    contexts = [copy_context() for _ in things]  # NumPy's treatment of what is not finite
    each = threads("runs", cores).map(lambda own, one: own.run(work, one), contexts, things)
    return list(each)
