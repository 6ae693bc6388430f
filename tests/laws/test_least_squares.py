"""Least squares on Gram matrices is least squares on the columns themselves."""

import numpy as np
import pytest

from rovsim.estimation.observer.least_squares import (
    eliminate_columns,
    gram,
    project_out,
    regress_forward,
    select_columns,
    solve,
    solve_bounded,
)


@pytest.fixture
def columns():
    return np.random.default_rng(4).normal(size=(8, 500))


def test_the_few_that_matter_are_chosen_among_many(columns):
    noise = np.random.default_rng(5).normal(size=500)
    target = -(3.0 * columns[2] - 2.0 * columns[6]) + 0.1 * noise
    found = select_columns(gram(columns), columns @ target, penalty=12.0)
    assert set(found.chosen) == {2, 6}
    by_name = dict(zip(found.chosen, found.x, strict=True))
    assert by_name[2] == pytest.approx(3.0, abs=0.05)
    assert by_name[6] == pytest.approx(-2.0, abs=0.05)
    left = target + found.x @ columns[list(found.chosen)]
    assert found.ss_decrease == pytest.approx(target @ target - left @ left, rel=1e-6)


def test_two_that_hide_each_other_are_found_from_above(columns):
    apart = np.random.default_rng(6).normal(size=500)
    alike = np.vstack([columns, columns[0] + 0.05 * apart])
    target = -20.0 * (alike[0] - alike[-1]) + columns[7]  # of `apart`, which no column shows
    H, b = gram(alike), alike @ target
    alone = np.max(b**2 / np.diag(H) * (np.arange(len(b)) != 7))
    found = eliminate_columns(H, b, penalty=2.0 * alone)
    assert set(found.chosen) == {0, 7, 8}
    assert found.x == pytest.approx([20.0, -1.0, -20.0])
    assert found.ss_decrease == pytest.approx(target @ target)


def test_nothing_is_kept_of_what_explains_nothing(columns):
    assert eliminate_columns(gram(columns), np.zeros(8), penalty=12.0).chosen == ()


def test_the_joint_solution_is_the_bounded_one(columns):
    target = -(3.0 * columns[0] - 2.0 * columns[1])
    b, H = columns[:2] @ target, gram(columns[:2])
    free = solve_bounded(H, b, 0.0, np.full(2, -9.0), np.full(2, 9.0))
    np.testing.assert_allclose(free.x, [3.0, -2.0], atol=1e-6)
    held = solve_bounded(H, b, 0.0, np.full(2, -1.0), np.full(2, 1.0))
    np.testing.assert_allclose(held.x, [1.0, -1.0], atol=1e-6)
    assert 0.0 < held.ss_decrease < free.ss_decrease


def test_projected_columns_are_gone(columns):
    left = project_out(gram(columns), [0, 3])
    np.testing.assert_allclose(left[[0, 3]], 0.0, atol=1e-5)
    basis = np.linalg.qr(columns[[0, 3]].T)[0]
    own = columns[5] - basis @ (basis.T @ columns[5])
    assert left[5, 5] == pytest.approx(own @ own)


def test_parallel_columns_share():
    H = np.array([[1.0, 1.0], [1.0, 1.0]])
    np.testing.assert_allclose(solve(H, np.array([2.0, 2.0])), [1.0, 1.0], atol=1e-6)


def test_forward_regression_adds_what_lowers_the_residual_most(columns):
    mixed = np.random.default_rng(7).normal(size=(8, 8)) @ columns  # correlated
    target = np.random.default_rng(8).normal(size=8) @ mixed + columns[0]

    def left(chosen):
        X = mixed[chosen].T
        residual = target - X @ np.linalg.lstsq(X, target, rcond=None)[0]
        return residual @ residual

    expected: list[int] = []
    for _ in range(4):
        others = [k for k in range(8) if k not in expected]
        expected.append(min(others, key=lambda k: left([*expected, k])))
    assert list(regress_forward(gram(mixed), mixed @ target, 4).chosen) == expected


def test_forward_regression_is_that_of_a_library(columns):
    FROLS = pytest.importorskip("pysindy").FROLS
    mixed = np.random.default_rng(9).normal(size=(8, 8)) @ columns
    target = np.random.default_rng(10).normal(size=8) @ mixed
    path = FROLS(max_iter=3, alpha=1e-9, unbias=False).fit(mixed.T, target[:, None]).history_
    theirs = [set(np.flatnonzero(row[0])) for row in path[1:4]]
    ours = regress_forward(gram(mixed), mixed @ target, 3).chosen
    assert [set(ours[: k + 1]) for k in range(3)] == theirs


def test_forward_regression_ends_where_nothing_is_left(columns):
    alike = np.vstack([columns[:2], columns[0] + columns[1], np.zeros(500)])
    assert len(regress_forward(gram(alike), alike @ (columns[0] - columns[1]), 4).chosen) == 2
    assert regress_forward(np.empty((0, 0)), np.empty(0), 4).chosen == ()
