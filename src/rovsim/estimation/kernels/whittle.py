"""The likeliest sizes of the parts of a noise, from periodograms: thousands are asked.

Whittle's likelihood (Whittle 1953) is greatest there. Fisher's scoring, damped as by Levenberg and
Marquardt, uses that the expected curvature is known: a quasi-Newton method of a library takes three
times as long in all and ends a hundred short of the greatest likelihood where parts are alike.
"""

import numpy as np

from rovsim.estimation.kernels.compiled import from_python, internal

MAX_STEPS = 200  # bounds what does not converge
COST_TOLERANCE = 1e-10  # of a likelihood of one frequency, that a step still gains
# Much at first: from all parts alike, a whole step puts some at their ends, and few come back.
INITIAL_DAMPING, DAMPING_DECREASE, DAMPING_INCREASE, MAX_DAMPING = 100.0, 0.2, 5.0, 1e12


@internal
def solve(A, b):
    """x (k,) with A (k, k) x = b; A is positive definite, so no pivot is sought."""
    n = len(b)
    A, x = A.copy(), b.copy()
    for i in range(n):
        for j in range(i + 1, n):
            factor = A[j, i] / A[i, i]
            A[j] -= factor * A[i]
            x[j] -= factor * x[i]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            x[i] -= A[i, j] * x[j]
        x[i] /= A[i, i]
    return x


@internal
def take_step(slope, curvature, damping, free):
    """The damped step (k,) of those sizes that are free (k,); the others stay."""
    A = curvature.copy()
    for k in range(len(slope)):
        A[k, k] += damping * (curvature[k, k] + COST_TOLERANCE)
        if not free[k]:
            A[k], A[:, k], A[k, k] = 0.0, 0.0, 1.0
    return solve(A, np.where(free, -slope, 0.0))


@internal
def evaluate(x, power, white, others):
    """Cost of log sizes x (k,), its slope (k,) and expected curvature (k, k).

    Of one periodogram (f,) that is white noise (f,) and others (k, f), all scaled to the likeliest.
    """
    kinds, frequencies = others.shape
    size = np.exp(x)
    share, ratio = np.empty((kinds, frequencies)), np.empty(frequencies)
    logs, scale = 0.0, 0.0
    for f in range(frequencies):
        total = white[f]
        for k in range(kinds):
            share[k, f] = size[k] * others[k, f]
            total += share[k, f]
        for k in range(kinds):
            share[k, f] /= total
        ratio[f] = power[f] / total
        logs += np.log(total)
        scale += ratio[f] / frequencies
    slope, curvature = np.zeros(kinds), np.zeros((kinds, kinds))
    for k in range(kinds):
        mean = np.mean(share[k])
        for f in range(frequencies):
            slope[k] += share[k, f] * (1.0 - ratio[f] / scale)
            share[k, f] -= mean  # what the common scale does not do as well
    for k in range(kinds):
        for j in range(kinds):
            curvature[k, j] = np.sum(share[k] * share[j])
    return logs + frequencies * np.log(scale), slope, curvature


@internal
def least_cost(power, white, others, low, high):
    """The least cost over log sizes between low and high (k,), of one periodogram (f,)."""
    x, damping = 0.5 * (low + high), INITIAL_DAMPING
    cost, slope, curvature = evaluate(x, power, white, others)
    for _ in range(MAX_STEPS):
        free = ((slope < 0.0) & (x < high)) | ((slope > 0.0) & (x > low))
        step = take_step(slope, curvature, damping, free)
        new = np.minimum(np.maximum(x + step, low), high)
        new_cost, new_slope, new_curvature = evaluate(new, power, white, others)
        if new_cost <= cost:
            gained = cost - new_cost
            x, cost, slope, curvature = new, new_cost, new_slope, new_curvature
            damping *= DAMPING_DECREASE
            if gained < COST_TOLERANCE * len(power):
                break
        elif damping > MAX_DAMPING:
            break
        else:
            damping *= DAMPING_INCREASE
    return cost


@from_python
def least_misfit(power, white, others, low, high):
    """Whittle's cost, up to a constant, least over sizes, summed over periodograms (c, f).

    Args:
        power: periodograms (c, f).
        white: white noise (f,), of size 1 beside the others.
        others: other noise (k, f).
        low: logarithm of the least sizes (k,).
        high: of the largest.
    """
    cost = 0.0
    for c in range(len(power)):
        cost += least_cost(power[c], white, others, low, high)
    return cost
