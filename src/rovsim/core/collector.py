"""Memory: the collector is kept from what is no garbage, and what is free is given back."""

import atexit
import ctypes
import gc
import os
from importlib import import_module
from types import ModuleType


def import_large(name: str) -> ModuleType:
    """Import a module and all that it imports, in four fifths of the time.

    The collector would go through hundreds of thousands of new objects a dozen times.
    """
    gc.disable()
    try:
        return import_module(name)
    finally:
        gc.freeze()
        gc.enable()


def end_at_once() -> None:
    """Let this process end without a last look at all objects, which takes up to a second."""
    atexit.register(gc.freeze)


def give_back_memory() -> None:
    """Give memory that is free back to the system, where the C library keeps it (glibc).

    A server that lives for days would seem to grow otherwise: new work finds the holes of the old
    too small.
    """
    if os.name == "posix" and hasattr(library := ctypes.CDLL(None), "malloc_trim"):
        library.malloc_trim(0)
