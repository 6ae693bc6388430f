"""Laws of the exported predictors, and of the features they see."""

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit
from scipy.linalg import eigh

from rovsim.core import rotations
from rovsim.core.threads import on_cores
from rovsim.dynamics.learned.checks import check_exported
from rovsim.dynamics.learned.features import assemble, assemble_one
from rovsim.dynamics.learned.layout import BLOCKS, HEADER
from rovsim.dynamics.learned.predictor import evaluate, evaluate_many
from rovsim.dynamics.learned.settings import (
    COLUMNS,
    MAX_FEATURES,
    FeatureSettings,
    blocks_code,
    feature_names,
)
from rovsim.dynamics.learned.simd import exponentials
from rovsim.learning.export import Kernel, export_expansion, export_neighbours
from rovsim.learning.posterior_variance import (
    EXACT_TOLERANCE,
    ROUGH_TOLERANCE,
    decompose_exact,
    rbf,
)
from rovsim.learning.scaling import fit_scaling

BLOCK_SETS = st.sets(st.sampled_from(list(COLUMNS)), min_size=1).map(tuple)
SEEDS = st.integers(0, 2**32 - 1)
SIX = FeatureSettings(blocks=("velocity",), scaling="none")


@given(SEEDS, st.integers(1, 4000), st.integers(1, 21), st.floats(0.0, 3.0))
@settings(max_examples=25, deadline=None)
def test_a_tree_of_any_size_finds_the_same_as_looking_at_every_point(seed, n, d, spread):
    """Points in clumps, so that boxes overlap; queries in and far out of them."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(n, d)) + spread * rng.integers(-2, 3, (n, 1))
    chosen = FeatureSettings(blocks=tuple(COLUMNS), scaling="none")
    wide = np.zeros((n, MAX_FEATURES))
    wide[:, :d] = points
    Y, k = rng.normal(size=(n, 6)), min(5, n)
    data = export_neighbours(chosen, fit_scaling("none", wide), wide, Y, k, "uniform")
    queries = np.concatenate(
        [wide[:3], rng.normal(size=(5, MAX_FEATURES)) * [[1], [1], [3], [9], [99]]]
    )
    expected = [Y[nearest_rows(wide, query, k)].mean(0) for query in queries]
    assert evaluate_many(data, queries) == pytest.approx(np.array(expected), abs=1e-12)


def test_exponentials_are_those_of_numpy():
    x = np.concatenate([np.linspace(0.0, 720.0, 100001), [0.0, 1e-300, 5e3, 1e300]])
    found = x.copy()
    exponentials(found)
    normal = x < 708.0  # below that results are denormal, here zero
    assert np.abs(found[normal] / np.exp(-x[normal]) - 1.0).max() < 1e-15
    assert (found[x > 710.0] == 0.0).all()
    assert found[x == 0.0].tobytes() == np.ones(2).tobytes()


@given(SEEDS, st.floats(1e-4, 10.0))
@settings(max_examples=20, deadline=None)
def test_the_variance_is_exact_within_its_bound_for_any_query(seed, noise):
    rng = np.random.default_rng(seed)
    Z, length = rng.normal(size=(150, 6)), rng.uniform(0.5, 6.0, 6)
    K, known = rbf(Z, Z, length), decompose_exact(*eigh(rbf(Z, Z, length)), noise)
    k = rbf(np.concatenate([Z[:20], 2.0 * rng.normal(size=(80, 6))]), Z, length)
    exact = 1.0 - (k * np.linalg.solve(K + noise * np.eye(150), k.T).T).sum(1)
    assert np.abs(known.prior_share(k, len(known.spectrum)) - exact).max() < EXACT_TOLERANCE + 1e-9
    assert np.abs(known.prior_share(k, known.fading_rank) - exact).max() < ROUGH_TOLERANCE + 1e-9


def grid(seed, n, m):
    """Points on a coarse grid, so that distances tie exactly, their targets, and queries."""
    rng = np.random.default_rng(seed)
    points, queries = (rng.integers(0, 3, (size, 6)).astype(float) for size in (n, m))
    return points, rng.normal(size=(n, 6)), queries


def nearest_rows(points, query, k):
    """Rows of the k nearest points; at equal distance the earlier row first."""
    return np.argsort(((points - query) ** 2).sum(1), kind="stable")[:k]


@given(SEEDS, st.integers(1, 200), st.integers(1, 64))
@settings(max_examples=60, deadline=None)
def test_neighbours_are_the_nearest_and_the_earlier_row_wins_a_tie(seed, n, k):
    points, Y, queries = grid(seed, n, 20)
    k = min(k, n)
    data = export_neighbours(SIX, fit_scaling("none", points), points, Y, k, "uniform")
    expected = [Y[nearest_rows(points, query, k)].mean(0) for query in queries]
    assert evaluate_many(data, queries) == pytest.approx(np.array(expected), abs=1e-12)


@given(SEEDS, st.sampled_from(["standard", "range", "none"]), st.integers(1, 20))
@settings(max_examples=40, deadline=None)
def test_at_a_training_point_inverse_distance_returns_its_target(seed, scaling, k):
    rng = np.random.default_rng(seed)
    X, Y = rng.normal(size=(40, 6)) * np.geomspace(1e-3, 1e3, 6), rng.normal(size=(40, 6))
    fitted = fit_scaling(scaling, X)
    data = export_neighbours(SIX, fitted, fitted.apply(X), Y, k, "distance")
    assert evaluate_many(data, X).tobytes() == Y.tobytes()


@given(SEEDS, st.integers(1, 100), st.integers(1, 30))
@settings(max_examples=40, deadline=None)
def test_neighbours_stay_within_the_targets_seen(seed, n, k):
    points, Y, queries = grid(seed, n, 10)
    queries = queries + np.random.default_rng(seed).normal(size=queries.shape) * 10.0
    data = export_neighbours(SIX, fit_scaling("none", points), points, Y, min(k, n), "distance")
    P = evaluate_many(data, queries)
    assert (Y.min(0) - 1e-12 <= P).all()
    assert (Y.max(0) + 1e-12 >= P).all()


@given(SEEDS, st.integers(1, 100), st.booleans())
@settings(max_examples=40, deadline=None)
def test_an_expansion_is_the_sum_of_its_kernels(seed, n, shared):
    """The exported kernel against the formula written out in NumPy."""
    rng = np.random.default_rng(seed)
    X = rng.normal(size=(n, 6)) * np.geomspace(0.1, 10.0, 6)
    fitted, mean = fit_scaling("standard", X), rng.normal(size=6)
    Z, w, length = fitted.apply(X), rng.normal(size=(n, 6)), rng.uniform(0.3, 3.0, (6, 6))
    length[1:] = length[0] if shared else length[1:]
    one = [Kernel(Z, length[0], w)]
    six = [Kernel(Z, length[o], w[:, o : o + 1]) for o in range(6)]
    data = export_expansion(SIX, fitted, mean, one if shared else six)
    Q = rng.normal(size=(7, 6))
    gap = (fitted.apply(Q)[:, None] - Z)[..., None] / length.T
    expected = mean + np.einsum("qno,no->qo", np.exp(-0.5 * (gap**2).sum(2)), w)
    assert evaluate_many(data, Q) == pytest.approx(expected, abs=1e-11)


@given(SEEDS, st.floats(1e3, 1e12))
@settings(max_examples=30, deadline=None)
def test_far_away_an_expansion_knows_nothing_but_its_mean(seed, far):
    rng = np.random.default_rng(seed)
    X, mean = rng.normal(size=(50, 6)), rng.normal(size=6)
    scaling = fit_scaling("none", X)
    data = export_expansion(SIX, scaling, mean, [Kernel(X, np.ones(6), rng.normal(size=(50, 6)))])
    x = rng.normal(size=(1, 6))
    assert evaluate_many(data, far * x / np.linalg.norm(x)).tobytes() == mean.tobytes()


@given(SEEDS, BLOCK_SETS)
@settings(max_examples=40, deadline=None)
def test_one_sample_is_assembled_as_many(seed, blocks):
    rng = np.random.default_rng(seed)
    nu, nu_dot, wrench = rng.normal(size=(3, 5, 6))
    q = rotations.normalized(rng.normal(size=(5, 4)))
    chosen = FeatureSettings(blocks=blocks)
    X = assemble(chosen, nu, nu_dot, wrench, q)
    data, d = np.zeros(HEADER), len(feature_names(chosen))
    data[BLOCKS] = blocks_code(chosen)
    for i in range(5):
        x = np.full(MAX_FEATURES, np.nan)
        assemble_one(data, nu[i], nu_dot[i], wrench[i], rotations.matrix(q[i]), x)
        assert x[:d] == pytest.approx(X[i], abs=1e-14)
        assert np.isnan(x[d:]).all()


def test_gravity_points_down_whatever_the_heading():
    q = rotations.from_euler(
        np.zeros(3), np.array([0.0, 0.0, np.pi / 2]), np.array([0.0, 2.0, 1.0])
    )
    X = assemble(FeatureSettings(blocks=("gravity",)), *np.zeros((3, 3, 6)), q)
    # nose up by a right angle: down is towards the stern
    assert np.allclose(X, [[0, 0, 1], [0, 0, 1], [-1, 0, 0]])


@given(st.floats(-1e6, 1e6), st.sampled_from(["standard", "range"]))
def test_a_column_that_only_rounds_keeps_its_unit(value, kind):
    X = np.full((30, 2), value)
    X[::2, 1] += 1e-12
    scaling = fit_scaling(kind, X)
    assert (scaling.scale == 1.0).all()
    assert np.abs(scaling.apply(X)).max() < 1e-9


@given(SEEDS)
def test_standard_scaling_gives_unit_columns(seed):
    X = np.random.default_rng(seed).normal(3.0, 7.0, (50, 4))
    Z = fit_scaling("standard", X).apply(X)
    assert np.allclose(Z.mean(0), 0.0, atol=1e-12)
    assert np.allclose(Z.std(0), 1.0)
    R = fit_scaling("range", X).apply(X)
    assert np.allclose([R.min(0), R.max(0)], [[0] * 4, [1] * 4])


@njit(nogil=True)
def one_by_one(data, X, out):
    for i in range(X.shape[0]):
        evaluate(data, X[i], out[i])


@pytest.mark.parametrize("kind", ["neighbours", "expansion"])
def test_threads_do_not_disturb_each_other(kind, monkeypatch):
    rng = np.random.default_rng(0)
    X, Y, Q = (rng.normal(size=(size, 6)) for size in (300, 300, 20000))
    scaling = fit_scaling("standard", X)
    Z = scaling.apply(X)
    if kind == "neighbours":
        data = export_neighbours(SIX, scaling, Z, Y, 7, "distance")
    else:
        data = export_expansion(SIX, scaling, np.zeros(6), [Kernel(Z, np.ones(6), Y)])
    check_exported(data, SIX, "test")
    monkeypatch.setattr(numba.config, "NUMBA_NUM_THREADS", 4)
    found = np.empty((len(Q), 6))
    on_cores(lambda part: one_by_one(data, Q[part], found[part]), np.ones(len(Q)))
    assert found.tobytes() == evaluate_many(data, Q).tobytes()
