"""Python's garbage collector, kept from what is no garbage: large imports."""

import atexit
import gc
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
