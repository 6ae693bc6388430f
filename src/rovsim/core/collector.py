"""Keep Python's garbage collector from needless work, and give free memory back to the system."""

import atexit
import ctypes
import gc
import os
from importlib import import_module
from types import ModuleType


def import_large(name: str) -> ModuleType:
    """Import a module with the garbage collector off, in four fifths of the time.

    The collector would otherwise go through hundreds of thousands of new objects a dozen times.
    """
    gc.disable()
    try:
        return import_module(name)
    finally:
        gc.freeze()
        gc.enable()


def end_at_once() -> None:
    """Let this process end without a last garbage collection, which takes up to a second."""
    atexit.register(gc.freeze)


def give_back_memory() -> None:
    """Give free memory back to the system, where the C library (glibc) would keep it.

    A server that runs for days would otherwise grow, because new work does not fit into the holes
    that old work left.
    """
    if os.name == "posix" and hasattr(library := ctypes.CDLL(None), "malloc_trim"):
        library.malloc_trim(0)
