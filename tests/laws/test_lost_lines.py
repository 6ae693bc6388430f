"""Lines that a command log lost are put where they were due, and nothing else is touched."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.core.run import Commands
from rovsim.estimation.observer.lost_lines import (
    MAX_LOST_IN_A_ROW,
    MAX_LOST_SHARE,
    fill_lost_lines,
)

LINES = 200


def log(columns: int = 2) -> Commands:
    """Commands on straight lines, which a line that was lost is on as well."""
    time = 3.0 + 0.02 * np.arange(LINES)
    return Commands(time, time[:, None] * np.linspace(-0.1, 0.1, columns), "thruster")


def without(commands: Commands, lost) -> Commands:
    kept = np.isin(np.arange(len(commands.time)), lost, invert=True)
    return replace(commands, time=commands.time[kept], value=commands.value[kept])


@given(st.sets(st.integers(1, LINES - 2), max_size=int(MAX_LOST_SHARE * LINES / 2)))
def test_commands_on_straight_lines_come_back(lost):
    rows = [k for k in lost if not {k - 1, k - 2, k - 3} <= lost]  # never four in a row
    whole = log()
    found = fill_lost_lines(without(whole, rows))
    np.testing.assert_allclose(found.time, whole.time)
    np.testing.assert_allclose(found.value, whole.value)


def test_lines_are_due_where_a_jittering_log_lost_them():
    whole = log()
    jitter = np.random.default_rng(0).normal(scale=5e-4, size=LINES)
    jittering = replace(whole, time=whole.time + jitter)
    found = fill_lost_lines(without(jittering, [50, 120, 121]))
    np.testing.assert_allclose(found.time, whole.time, atol=3e-3)


@pytest.mark.parametrize(
    "kept",
    [
        np.arange(0, LINES, 1),  # nothing was lost
        np.delete(np.arange(LINES), slice(50, 50 + MAX_LOST_IN_A_ROW + 1)),  # a long gap
        np.delete(np.arange(LINES), np.arange(5, LINES, 6)),  # perhaps only what changed is logged
        np.flatnonzero(np.random.default_rng(1).random(LINES) < 0.4),  # not regular
        np.array([7]),
        np.array([], int),
    ],
)
def test_what_is_no_lost_line_stays(kept):
    whole = log()
    commands = replace(whole, time=whole.time[kept], value=whole.value[kept])
    assert fill_lost_lines(commands) is commands


def test_an_angle_does_not_go_the_long_way_round():
    whole = log(1)
    angle = np.where(np.arange(LINES) < 100, 3.1, -3.1)[:, None]
    turning = without(replace(whole, value=angle), [50, 100])
    assert len(fill_lost_lines(turning).time) == LINES - 1


def test_further_numbers_of_the_log_are_kept():
    part = replace(without(log(), [9]), before=1.5, after=0.5)
    found = fill_lost_lines(part)
    assert (found.before, found.after, found.auxiliary) == (1.5, 0.5, part.auxiliary)
