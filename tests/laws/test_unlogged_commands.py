"""What a log of commands does not tell: before it, after it and in holes of a steady log."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.core.run import Commands
from rovsim.measurement.quality.unlogged_commands import find_unlogged

END = 40.0
TIMES = np.arange(0.0, END, 0.02)


def log(time, value=None):
    """A log whose commands rise from line to line, unless values (m,) are given."""
    value = 0.2 + 0.02 * time if value is None else value
    return Commands(time, np.asarray(value, dtype=float)[:, None], "demand")


def without(*spans):
    """Times of a log at 50 Hz that lacks the lines between some times."""
    kept = np.ones(len(TIMES), bool)
    for begin, end in spans:
        kept &= (begin > TIMES) | (end <= TIMES)
    return TIMES[kept]


@given(
    st.lists(st.integers(1, 36), min_size=1, max_size=4, unique=True),
    st.floats(0.4, 0.9),
    st.integers(0, 2**32 - 1),
)
def test_holes_of_a_steady_log_are_found_where_they_are(starts, lasts, seed):
    spans = sorted((float(s), s + lasts) for s in starts)
    time = without(*spans)
    random = np.random.default_rng(seed)
    inner = np.flatnonzero((random.random(len(time)) < 0.01) & (time > 0) & (time < END - 1))
    found = find_unlogged(log(np.delete(time, inner)), 0.0, END)
    np.testing.assert_allclose(found, spans, atol=0.1)  # single lines beside them may lack, too


def test_lines_that_lack_one_by_one_are_no_holes():
    lost = np.random.default_rng(1).random(len(TIMES)) < 0.02
    assert not len(find_unlogged(log(TIMES[~lost]), 0.0, END))


def test_a_log_that_only_writes_changes_has_no_holes():
    time = np.cumsum(np.random.default_rng(2).exponential(0.5, 80))
    assert not len(find_unlogged(log(time), 0.0, float(time[-1])))


def test_a_stick_that_is_held_without_lines_makes_no_holes():
    time = TIMES[TIMES % 2.0 < 1.0]
    moved = np.cumsum(np.full(len(time), 0.02))  # it goes on from where it was held
    assert not len(find_unlogged(log(time, 0.3 + np.sin(moved)), 0.0, END))


def test_a_log_that_is_silent_at_rest_has_no_holes_there():
    time = TIMES[TIMES % 4.0 < 3.0]
    value = np.where(time % 4.0 < 2.97, 0.5 + 0.1 * np.sin(time), 0.0)  # zero, then nothing
    assert not len(find_unlogged(log(time, value), 0.0, END))


def test_a_hole_between_equal_commands_is_none():
    time = without((10.0, 12.0))
    same = np.where(abs(time - 11.0) < 3.0, 0.5, np.sin(time))
    assert not len(find_unlogged(log(time, same), 0.0, END))


@pytest.mark.parametrize("pushing", [True, False])
def test_a_log_that_begins_late_or_ends_early_is_told_where_it_pushes(pushing):
    time = TIMES[(TIMES >= 6.0) & (TIMES < 35.0)]
    value = np.sin(time) if pushing else np.sin(time) * (time > 7.0) * (time < 34.0)
    found = find_unlogged(log(time, value), 0.0, END)
    np.testing.assert_allclose(found, [(0.0, 6.0), (34.98, END)] if pushing else np.empty((0, 2)))


@pytest.mark.parametrize("time", [[], [3.0]])
def test_a_log_without_steps_holds(time):
    assert find_unlogged(log(np.array(time)), 0.0, END).shape == (0, 2)
