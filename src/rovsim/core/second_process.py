"""A second process for what needs other libraries, while this one computes."""

import os
import signal
import sys
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from importlib import import_module
from multiprocessing import active_children, get_context, parent_process
from multiprocessing.process import BaseProcess
from threading import Thread
from typing import Any, Callable, Iterator

from rovsim.core.collector import end_at_once, import_large
from rovsim.core.errors import RovsimError
from rovsim.core.progress import heard_by
from rovsim.core.termination import exit_on_termination

TIMES, BETWEEN = 10, 0.5  # s, between signals to a process that must end


@contextmanager
def second_process(*modules: str, first: str | None = None) -> Iterator[Executor]:
    """An executor of one process, which imports `modules` at once and ends with this one.

    Where they are imported here already, or there is no core to spare, it is this process itself.
    Elsewhere it calls `first`, a "module:function", before that.

    Raises:
        RovsimError: somebody killed the other process.
    """
    if usable_cores() < 2 or all(module in sys.modules for module in modules):
        yield _ThisProcess()
        return
    others, executor = set(active_children()), _OtherProcess()
    try:
        if first is not None:
            executor.submit(call, first)
        executor.submit(_import, modules)
        yield executor
    except BaseException as error:
        executor.shutdown(wait=False, cancel_futures=True)
        for process in set(active_children()) - others:
            _end(process)  # nobody waits for what it does
        if isinstance(error, (BrokenProcessPool, SystemExit)):  # SystemExit is the other's
            raise RovsimError(
                "a second process was killed, perhaps for want of memory. What was computed is "
                "kept; start the command again."
            ) from None
        raise
    finally:
        executor.shutdown(cancel_futures=True)


def usable_cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _OtherProcess(ProcessPoolExecutor):
    """Hands on what it is given; does it itself where the other process is gone."""

    def __init__(self) -> None:
        super().__init__(1, get_context("spawn"), initializer=_obey_the_first)

    def submit(self, function: Callable, /, *given: Any, **named: Any) -> Future:
        try:
            return super().submit(function, *given, **named)
        except BrokenProcessPool:
            return _ThisProcess().submit(function, *given, **named)


class _ThisProcess(Executor):
    """Does at once what it is given."""

    def submit(self, function: Callable, /, *given: Any, **named: Any) -> Future:
        done: Future = Future()
        done.set_result(function(*given, **named))
        return done


def _obey_the_first() -> None:
    """End when the first process ends, and not before."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    exit_on_termination()
    first = parent_process()
    assert first is not None

    def follow() -> None:
        first.join()
        os._exit(1)

    Thread(target=follow, daemon=True).start()
    end_at_once()


def _end(process: BaseProcess) -> None:
    """End a process: it clears away what it was writing, unless that takes long."""
    for _ in range(TIMES):  # each ends one of the calls that wait for it
        process.terminate()
        process.join(BETWEEN)
        if not process.is_alive():
            return
    process.kill()


def _import(modules: tuple[str, ...]) -> None:
    for module in modules:
        import_large(module)


def call(name: str, *given: Any) -> Any:
    """Call "module:function", which the first process need not import.

    Nothing is said of its progress: the terminal may show that of something else.
    """
    module, function = name.split(":")
    with heard_by():
        return getattr(import_module(module), function)(*given)
