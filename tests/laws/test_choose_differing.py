"""Which parameters of an effect differ from run to run: as few as explain it."""

import numpy as np
import pytest

from rovsim.diagnosis.checks.by_run import ProductsByRun
from rovsim.diagnosis.checks.run_differences import choose_differing

RUNS, THRUSTERS, PENALTY = 4, 8, 36.0
ALL = THRUSTERS  # number of the derivative that is the sum of those before


def products(steps, order, seed=0):
    """Of readings of each run, explained by steps (r, k) of each thruster and of all of them."""
    random = np.random.default_rng(seed)
    gram, b = [], []
    for step in np.asarray(steps, dtype=float):
        rows = random.normal(size=(THRUSTERS, 2000))
        rows = np.vstack([rows, rows.sum(axis=0)])
        e = random.normal(size=2000) - step @ rows
        gram.append((rows @ rows.T)[np.ix_(order, order)])
        b.append((rows @ e)[order])
    return ProductsByRun(np.array(gram), np.array(b))


@pytest.mark.parametrize("order", [range(THRUSTERS + 1), range(THRUSTERS, -1, -1)])
def test_a_battery_that_was_changed_is_one_gain_of_all_thrusters(order):
    order = list(order)
    steps = np.zeros((RUNS, THRUSTERS + 1))
    steps[1::2, ALL] = 0.2
    assert [order[k] for k in choose_differing(products(steps, order), PENALTY)] == [ALL]


@pytest.mark.parametrize("dead", [0, 2, 7])
def test_a_thruster_that_is_dead_in_one_run_is_that_thruster(dead):
    steps = np.zeros((RUNS, THRUSTERS + 1))
    steps[2, dead] = -1.0
    order = list(range(THRUSTERS + 1))
    assert choose_differing(products(steps, order), PENALTY) == [dead]


def test_nothing_differs_where_all_runs_are_alike():
    steps = np.tile(np.linspace(-0.2, 0.2, THRUSTERS + 1), (RUNS, 1))
    assert choose_differing(products(steps, list(range(THRUSTERS + 1))), PENALTY) == []
