"""Compiled engines survive between test sessions; drawn examples are the same every time."""

import os
from pathlib import Path

from hypothesis import settings

os.environ.setdefault("ROVSIM_CACHE", str(Path(__file__).parents[1] / ".pytest_cache" / "rovsim"))

# No deadline: the first call may compile, and nothing here is a timed test.
settings.register_profile("rovsim", deadline=None, derandomize=True)
settings.load_profile("rovsim")


def pytest_collection_modifyitems(items):
    """The longest first: with several workers, none is left with a whole study at the end."""
    items.sort(key=lambda item: "workflow" not in item.path.parts)
