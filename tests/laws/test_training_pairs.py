"""Pairs of runs that can be used: as they are while memory holds them, spread over all beyond."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests import worlds

from rovsim.core.errors import BadInput
from rovsim.core.run import RunInfo
from rovsim.dynamics.learned.settings import FeatureSettings
from rovsim.learning.pairs import Gathered, training_runs
from rovsim.simulation.samples import Samples

FEATURES = FeatureSettings(blocks=("velocity",))


def samples(rows: int, first: int) -> Samples:
    """A run whose rows are numbered, in what it looks at and in what it should predict."""
    number = np.repeat(first + np.arange(rows, dtype=float)[:, None], 6, axis=1)
    return Samples(np.arange(rows), number, number[:, :4], number, number, -number)


@given(st.lists(st.integers(1, 60), min_size=1, max_size=9), st.integers(8, 80))
def test_no_more_rows_than_memory_holds_and_none_apart_from_its_target(lengths, most):
    gathered, first = Gathered(FEATURES, seed=1, most=most), 0
    for k, rows in enumerate(lengths):
        gathered.take(str(k), samples(rows, first))
        first += rows
    X, Y = gathered.pairs
    assert gathered.rows == sum(lengths)
    assert gathered.runs == [str(k) for k in range(len(lengths))]
    assert np.array_equal(X, -Y)
    assert np.all(np.diff(X[:, 0]) > 0)
    if sum(lengths) <= most:
        assert len(X) == sum(lengths)
    else:
        assert len(lengths) <= len(X) <= max(most, len(lengths))


def test_the_rows_kept_are_spread_over_all_runs():
    gathered = Gathered(FEATURES, seed=1, most=300)
    for k in range(20):
        gathered.take(str(k), samples(100, 100 * k))
    shares = np.bincount((gathered.pairs[0][:, 0] // 100).astype(int), minlength=20)
    assert shares.min() == shares.max() == 13


def flown(name, usable=True):
    """A train run of 20 s at 6dof, whose commands rise from line to line, at 50 Hz."""
    rising = np.repeat(np.linspace(0.2, 0.6, 1000)[:, None], 8, axis=1)
    run = worlds.motion(rising, seconds=20.0)
    return replace(run, run=RunInfo(name, "6dof", "train"), usable=np.full(len(run.time), usable))


def test_runs_of_which_nothing_can_be_used_are_left_out():
    kept = training_runs([flown("a", usable=False), flown("b")], "all")
    assert [run.run.id for run in kept] == ["b"]


def test_without_a_run_that_can_be_used_each_is_named_with_the_reason():
    with pytest.raises(BadInput, match=r"a \(6dof, train, nothing of it can be used\)"):
        list(training_runs([flown("a", usable=False)], "6dof"))


def test_nothing_is_learned_where_nobody_knows_what_was_commanded():
    run = flown("a")
    time, value = run.commands.time, run.commands.value
    logged = (time < 8.0) | (time > 11.0)
    commands = replace(run.commands, time=time[logged], value=value[logged])
    (learned,) = training_runs([replace(run, commands=commands)], "6dof")
    unknown = (run.time > 8.1) & (run.time < 11.5)
    surely_known = (run.time < 7.9) | (run.time > 11.6)
    assert not learned.usable[unknown].any()
    assert learned.usable[surely_known].all()
