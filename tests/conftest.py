"""Compiled engines survive between sessions, drawn examples are the same, a test uses one core."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

from sketches import draw_few

os.environ.setdefault("ROVSIM_CACHE", str(Path(__file__).parents[1] / ".pytest_cache" / "rovsim"))

# The matrices are small: waiting for its siblings costs a thread more than it computes, and the
# other cores have tests of their own. Read when NumPy, Numba and torch are loaded, so it stands
# before every import of them; jobs inherit it.
for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

# No deadline: the first call may compile, and nothing here is a timed test.
settings.register_profile("rovsim", deadline=None, derandomize=True)
settings.load_profile("rovsim")


def pytest_collection_modifyitems(items):
    """The longest first: with several workers, none is left with a whole study at the end."""
    items.sort(key=lambda item: "workflow" not in item.path.parts)


@pytest.fixture
def few_figures(monkeypatch):
    """`compare` and `diagnose` draw one figure of each kind."""
    draw_few(monkeypatch)
