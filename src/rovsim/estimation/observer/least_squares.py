"""Least squares on Gram matrices alone: any subset of columns, at the cost of a small solve."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import lsq_linear

MAX_COLUMNS = 12  # columns of one effect: more is not an effect but a fit of everything
# Of its own square: a column that keeps less beside the others tells nothing that they do not.
MIN_INDEPENDENT_SHARE = 1e-6
RIDGE = 1e-9  # of each column's own square: parallel columns share instead of exploding


def as_rows(x: Array) -> Array:
    """Columns x (q, ...) one after the other (q, n); of none as well."""
    return x.reshape(len(x), int(np.prod(x.shape[1:])))


def gram(rows: Array) -> Array:
    """Gram matrix (q, q) of rows (q, n): their inner products with each other."""
    return rows @ rows.T


def solve(H: Array, b: Array) -> Array:
    """H^-1 b for a symmetric, perhaps singular H."""
    if not len(H):
        return np.zeros_like(b)
    scale = np.sqrt(np.diag(H))
    scale = np.where(scale > 0.0, scale, 1.0)
    scaled = H / np.outer(scale, scale) + RIDGE * np.eye(len(H))
    x = np.linalg.solve(scaled, (b.T / scale).T)
    return (x.T / scale).T


def newton_step(G: Array) -> Array:
    """Where the sum of squares is least: the step (k,) of the parameters.

    `G` (1 + k, 1 + k): Gram matrix of the errors and their derivatives.
    """
    return -solve(G[1:, 1:], G[1:, 0])


def project_out(G: Array, columns: Sequence[int]) -> Array:
    """The Gram matrix after projecting some columns out of all others."""
    C = list(columns)
    return G - G[:, C] @ solve(G[np.ix_(C, C)], G[C])


@dataclass(frozen=True)
class Reduction:
    """By how much some columns lower the sum of squares, and their coefficients."""

    ss_decrease: float
    chosen: tuple[int, ...]
    x: Array


def solve_bounded(H: Array, b: Array, offset: float, low: Array, high: Array) -> Reduction:
    """All columns together, their coefficients (k,) between bounds.

    `b` (k,) are their products with the target, `offset` is what the target itself costs more.
    """
    values, vectors = np.linalg.eigh(H)
    root = np.sqrt(np.maximum(values, RIDGE * max(values[-1], 1e-300)))
    A = root[:, None] * vectors.T  # A'A = H
    x = lsq_linear(A, -(vectors.T @ b) / root, (low, high), method="bvls").x
    return Reduction(float(-2.0 * b @ x - x @ H @ x) - offset, tuple(range(len(b))), x)


def find_decreases(H: Array, b: Array, chosen: Sequence[int] = ()) -> Array:
    """Decrease (k,) of the sum of squares by each column beside the chosen ones.

    Zero for columns without effect, and for those that the chosen ones hold already.

    Args:
        H: Gram matrix (k, k) of the columns.
        b: their products (k,) with the target.
        chosen: columns that are there already.
    """
    power, remaining, product = np.diag(H), np.diag(H), b
    if len(chosen):
        columns = list(chosen)
        solution = solve(H[np.ix_(columns, columns)], np.column_stack([H[columns], b[columns]]))
        remaining = power - np.einsum("ij,ij->j", H[columns], solution[:, :-1])
        product = b - H[columns].T @ solution[:, -1]
    independent = remaining > MIN_INDEPENDENT_SHARE * power
    return np.where(independent, product**2 / np.where(independent, remaining, 1.0), 0.0)


def regress_forward(H: Array, b: Array, steps: int) -> Reduction:
    """Forward regression by orthogonal least squares (Chen, Billings & Luo 1989).

    Each step adds the column that lowers the sum of squares most beside those before.

    Args:
        H: Gram matrix (k, k) of the columns.
        b: their products (k,) with the target.
        steps: how many columns are selected, at most.

    Returns:
        The selected columns, in the order of their selection.
    """
    chosen: list[int] = []
    for _ in range(steps):
        decreases = find_decreases(H, b, chosen)
        decreases[chosen] = 0.0
        best = int(np.argmax(decreases)) if len(b) else -1
        if best < 0 or decreases[best] <= 0.0:
            break
        chosen.append(best)
    x, _ = _fit_columns(H, b, chosen)
    return Reduction(float(b[chosen] @ x), tuple(chosen), -x)


def select_columns(H: Array, b: Array, penalty: float) -> Reduction:
    """The columns that are worth their penalty each, added one by one, then pruned."""
    chosen: list[int] = []
    while len(chosen) < min(len(b), MAX_COLUMNS):
        remaining = [j for j in range(len(b)) if j not in chosen]
        reductions = find_decreases(H, b, chosen)
        j_best = max(remaining, key=lambda j: reductions[j])
        if reductions[j_best] < penalty and chosen:
            break
        chosen.append(j_best)
        if reductions[j_best] < penalty:
            break
    x, reductions = _fit_columns(H, b, chosen)
    while len(chosen) > 1 and reductions.min() < penalty:
        chosen.pop(int(np.argmin(reductions)))
        x, reductions = _fit_columns(H, b, chosen)
    return Reduction(float(b[chosen] @ x), tuple(chosen), -x)


def eliminate_columns(H: Array, b: Array, penalty: float) -> Reduction:
    """The columns that are worth their penalty beside each other: from all of them, down.

    Two of opposite sign (linear and quadratic drag of one axis) are found, though neither explains
    anything alone.
    """
    chosen = [j for j in range(len(b)) if H[j, j] > 0.0]
    while chosen:
        x, reductions = _fit_columns(H, b, chosen)
        if reductions.min() >= penalty:
            return Reduction(float(b[chosen] @ x), tuple(chosen), -x)
        chosen.pop(int(np.argmin(reductions)))
    return Reduction(0.0, (), np.empty(0))


def _fit_columns(H: Array, b: Array, chosen: list[int]) -> tuple[Array, Array]:
    """What (k,) chosen columns take of b beside each other, and what each is worth (k,)."""
    block = H[np.ix_(chosen, chosen)]
    x = solve(block, b[chosen])
    return x, x**2 / np.diag(solve(block, np.eye(len(chosen))))
