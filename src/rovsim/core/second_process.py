"""A second process for work that needs other libraries, while this one computes."""

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

MAX_SIGNALS, SIGNAL_INTERVAL_S = 10, 0.5  # to a process that must end


@contextmanager
def second_process(*modules: str, first: str | None = None) -> Iterator[Executor]:
    """Yield an executor with one other process, which ends with this one.

    If the modules are already imported here, or no core is free, the executor works in this
    process instead.

    Args:
        modules: modules that the other process imports at once.
        first: function that it calls before that, as "module:function".

    Raises:
        RovsimError: the other process was killed.
    """
    if usable_cores() < 2 or all(module in sys.modules for module in modules):
        yield _ThisProcess()
        return
    existing, executor = set(active_children()), _OtherProcess()
    try:
        if first is not None:
            executor.submit(call, first)
        executor.submit(_import, modules)
        yield executor
    except BaseException as error:
        executor.shutdown(wait=False, cancel_futures=True)
        for process in set(active_children()) - existing:
            _end(process)  # its results are not needed any more
        if isinstance(error, (BrokenProcessPool, SystemExit)):  # SystemExit is the other's
            raise RovsimError(
                "a second process was killed, perhaps for want of memory. What was computed is "
                "kept; start the command again."
            ) from None
        raise
    finally:
        executor.shutdown(cancel_futures=True)


def usable_cores() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _OtherProcess(ProcessPoolExecutor):
    """Runs functions in the other process, or in this one if the other has died."""

    def __init__(self) -> None:
        super().__init__(1, get_context("spawn"), initializer=_obey_the_first)
        # A call of its own: the pool would print how a signal ended the initializer.
        super().submit(exit_on_termination)

    def submit(self, function: Callable, /, *given: Any, **named: Any) -> Future:
        try:
            return super().submit(function, *given, **named)
        except BrokenProcessPool:
            return _ThisProcess().submit(function, *given, **named)


class _ThisProcess(Executor):
    """Runs functions at once, in this process."""

    def submit(self, function: Callable, /, *given: Any, **named: Any) -> Future:
        future: Future = Future()
        future.set_result(function(*given, **named))
        return future


def _obey_the_first() -> None:
    """Let the second process end when the first one ends, and ignore Ctrl-C until then."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    first = parent_process()
    assert first is not None

    def follow() -> None:
        first.join()
        os._exit(1)

    Thread(target=follow, daemon=True).start()
    end_at_once()


def _end(process: BaseProcess) -> None:
    """End a process; it may clear away unfinished files, but is killed if that takes long."""
    for _ in range(MAX_SIGNALS):  # each signal ends one of the calls that the process waits for
        process.terminate()
        process.join(SIGNAL_INTERVAL_S)
        if not process.is_alive():
            return
    process.kill()


def _import(modules: tuple[str, ...]) -> None:
    for module in modules:
        import_large(module)


def call(name: str, *given: Any) -> Any:
    """Call a function named "module:function", which the first process need not import.

    Its progress is not shown: the terminal may show that of another task.
    """
    module, function = name.split(":")
    with heard_by():
        return getattr(import_module(module), function)(*given)
