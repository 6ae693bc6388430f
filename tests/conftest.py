"""Compiled engines survive between test sessions; drawn examples are the same every time."""

import os
from pathlib import Path

from hypothesis import settings

os.environ.setdefault("ROVSIM_CACHE", str(Path(__file__).parents[1] / ".pytest_cache" / "rovsim"))

# No deadline: the first call may compile, and nothing here is a timed test.
settings.register_profile("rovsim", deadline=None, derandomize=True)
settings.load_profile("rovsim")
