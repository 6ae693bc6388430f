"""Compiled engines survive between sessions, drawn examples are the same, a test uses one core."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

TESTS = Path(__file__).parent
os.environ.setdefault("ROVSIM_CACHE", str(TESTS.parent / ".pytest_cache" / "rovsim"))

# The matrices are small: waiting for its siblings costs a BLAS thread more than it computes. Read
# when NumPy and torch are loaded, so it stands before every import of them; jobs inherit it.
for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

# No deadline: the first call may compile, and nothing here is a timed test.
settings.register_profile("rovsim", deadline=None, derandomize=True)
settings.load_profile("rovsim")


def pytest_collection_modifyitems(items):
    """The longest first; a browser, for which one mostly waits, beside the jobs of the study.

    Each of two workers begins with one half of the list.
    """
    first, browser, rest = [], [], []
    groups = {"workflow": first, "browser": browser}
    for item in items:
        groups.get(item.path.relative_to(TESTS).parts[0], rest).append(item)
    half = len(items) // 2 - len(first)
    items[:] = [*first, *rest[:half], *browser, *rest[half:]]


@pytest.fixture
def one_figure_a_run(monkeypatch):
    """`rovsim compare` draws each run once: for tests of its numbers (test_cli draws them all)."""
    monkeypatch.setattr("rovsim.apps.cli.commands.compare.PER_RUN", ("velocities",))
