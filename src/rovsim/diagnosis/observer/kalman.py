"""Steady-state Kalman filters of one axis, and what turns the innovations of one into another's.

Compiled: a fit of the noise makes thousands of them.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy import ndarray as Array
from scipy.linalg import expm

from rovsim.diagnosis.observer.small_matrices import (
    FROM_PYTHON,
    INTERNAL,
    add_to_diagonal,
    increase,
    invert,
    multiply,
    transpose,
)

POSE, BIN_MEAN, SUM = 0, 1, 2  # what is read of an axis
MOST_DOUBLINGS = 60
CONVERGED = 1e-13
# A little noise everywhere keeps the Riccati equation solvable; it is far below the readings'.
SOLVABLE, LEAST_DRIVING = 1e-6, 1e-12
READ_AS_IS = 1e-4  # of the noise that adds up


class AxisMotion(NamedTuple):
    """How an error of one axis goes on: v' = -`damping` v - `stiffness` p, in 1/s and 1/s2."""

    damping: float
    stiffness: float = 0.0

    def over(self, h: float, kind: int = POSE) -> Array:
        """Transition (3, 3) over h s of pose, velocity and a push that stays.

        Where the mean velocity of bins is read, poses are taken as measured and do not err.
        """
        return _integrate(h, self.damping, 0.0 if kind == BIN_MEAN else self.stiffness)


@lru_cache(maxsize=1024)
def _integrate(h: float, damping: float, stiffness: float) -> Array:
    rates = [[0.0, 1.0, 0.0], [-stiffness, -damping, 1.0], [0.0, 0.0, 0.0]]
    found = np.ascontiguousarray(expm(h * np.array(rates)))
    found.flags.writeable = False
    return found


class AxisNoise(NamedTuple):
    """Noise of one axis: `level` m/s2 or rad/s2, `memory` s of the disturbance, `reading` noise.

    `colour`, in units of the reading, is a slow error of the readings that lasts `colour_memory` s.
    """

    level: float
    memory: float
    reading: float
    colour: float = 0.0
    colour_memory: float = 0.5


@dataclass(frozen=True, eq=False)
class AxisFilter:
    """Filter of one axis: `F` (n, n), `C` and `gain` (n,), variance of its innovations.

    `poles` (n + 1,): its characteristic polynomial, highest power first; `forgets`: that of the
    disturbance and of a slow error of the readings, which other filters do not share.
    """

    F: Array
    C: Array
    gain: Array
    variance: float
    poles: Array
    forgets: Array

    @property
    def decay(self) -> float:
        """What remains of the disturbance after one period."""
        place = min(2, len(self.C) - 1)  # behind velocity, and the pose where it is read
        return float(self.F[place, place])

    def whitening(self, old: "AxisFilter") -> tuple[Array, Array]:
        """Rational filter (b, a) that turns innovations of the filter `old` into this one's."""
        return np.convolve(self.forgets, old.poles), np.convolve(old.forgets, self.poles)

    @cached_property
    def response(self) -> tuple[Array, Array]:
        """Filter (b, a) from a push on the axis (m/s2, rad/s2) to innovations of unit variance.

        C (z I - A)^-1 B = det(z I - A + B C) / det(z I - A) - 1 with A = F (I - K C).
        """
        n = len(self.C)
        A = self.F @ (np.eye(n) - np.outer(self.gain, self.C))
        B = np.zeros(n)
        if n == 2:
            B[0] = self.F[0, 1]
        else:
            B[:2] = self.F[:2, 2]
        return (characteristic(A - np.outer(B, self.C)) - self.poles) / np.sqrt(
            self.variance
        ), self.poles


def design_filter(kind: int, h: float, motion: AxisMotion, noise: AxisNoise) -> AxisFilter:
    """The filter of one axis for one noise (noise.py), readings every h s."""
    return AxisFilter(*solve_steady_state(kind, h, motion.over(h, kind), *noise))


@njit(**FROM_PYTHON)
def solve_steady_state(kind, h, moved, level, memory, reading, colour, colour_memory):
    """F, C, gain, variance of the innovations, poles and forgetting of the filter of one axis.

    Its pose and velocity go on as `moved` (3, 3) says. Velocities of bins have no slow error of
    their own.
    """
    phi, slow = np.exp(-h / memory), np.exp(-h / colour_memory)
    binned = kind == BIN_MEAN
    n = 2 if binned else 4 if colour > 0.0 else 3
    F, C, forgets = np.zeros((n, n)), np.zeros(n), np.zeros(3 if n == 4 else 2)
    Q, r, disturbed = np.zeros((n, n)), reading**2, 1 if binned else 2
    C[0], forgets[0], forgets[1] = 1.0, 1.0, -phi
    F[disturbed, disturbed] = phi
    if binned:
        F[0, 0], F[0, 1] = moved[1, 1], h
        C[1] = -0.5 * h  # the mean over a bin is the velocity at its middle
    else:
        F[0, :3], F[1, :3] = moved[0], moved[1]
    add_to_diagonal(Q, SOLVABLE * r)
    Q[disturbed, disturbed] = level**2 * (1.0 - phi**2) + LEAST_DRIVING
    if n == 4:
        F[3, 3], C[3] = slow, 1.0
        Q[3, 3] = colour**2 * (1.0 - slow**2)
        forgets[1], forgets[2] = -phi - slow, phi * slow
    if kind == SUM:
        Q[0, 0], r = r, READ_AS_IS * r
    P = solve_riccati(F, C, Q, r)
    gain, variance = np.zeros(n), r
    for i in range(n):
        for j in range(n):
            gain[i] += P[i, j] * C[j]
        variance += C[i] * gain[i]
    left = np.zeros((n, n))
    add_to_diagonal(left, 1.0)
    for i in range(n):
        gain[i] /= variance
        for j in range(n):
            left[i, j] -= gain[i] * C[j]
    return F, C, gain, variance, characteristic(multiply(F, left)), forgets


@njit(**INTERNAL)
def solve_riccati(F, C, Q, r):
    """Steady covariance (n, n) of x' = F x + w, y = C x + v, predicted; w has Q, v has variance r.

    By structure-preserving doubling (Chu, Fan, Lin & Wang 2004): much faster on matrices this small
    than the general solver, with which a test compares it.
    """
    n = len(C)
    A, G, H = transpose(F), np.zeros((n, n)), np.zeros((n, n))
    increase(H, Q)
    for i in range(n):
        for j in range(n):
            G[i, j] = C[i] * C[j] / r
    for _ in range(MOST_DOUBLINGS):
        W = multiply(G, H)
        add_to_diagonal(W, 1.0)
        W = invert(W)
        AW, across = multiply(A, W), transpose(A)
        added, there = increase(H, multiply(multiply(across, H), multiply(W, A)))
        increase(G, multiply(AW, multiply(G, across)))
        A = multiply(AW, A)
        if added <= CONVERGED * there:
            break
    return H


@njit(**FROM_PYTHON)
def characteristic(A):
    """Coefficients of det(z I - A), highest power first (Faddeev-LeVerrier)."""
    n = len(A)
    found, M = np.zeros(n + 1), np.zeros((n, n))
    found[0] = 1.0
    for k in range(1, n + 1):
        M = multiply(A, M)
        add_to_diagonal(M, found[k - 1])
        AM = multiply(A, M)
        for i in range(n):
            found[k] -= AM[i, i] / k
    return found


@njit(inline="always", **INTERNAL)
def _filtered(b, a, value, state):
    """Next output of a filter, a[0] = 1; `state` changes (direct form II, transposed)."""
    order = len(state)
    out = b[0] * value + state[0]
    for j in range(order - 1):
        state[j] = b[j + 1] * value - a[j + 1] * out + state[j + 1]
    state[order - 1] = b[order] * value - a[order] * out
    return out


@njit(nogil=True, **FROM_PYTHON)
def filter_kept(b, a, e, spans, kept, shown, scale, out):
    """Filter each span of e (k, 6, n) by itself, axis by axis; the kept ones (k, 6, m) into out.

    As scipy.signal.lfilter, but several k on several cores and without copies: twice as fast.

    Args:
        b: numerators (6, order + 1).
        a: denominators (6, order + 1), a[:, 0] = 1.
        e: what is filtered.
        spans: first and last + 1 (s, 2) of each.
        kept: which of the n are written (n,).
        shown: which are there for each axis (n, 6); the others are written as zeros.
        scale: factors (6,) of what is written.
        out: what is written.
    """
    for job in range(e.shape[0] * 6):
        k, i = job // 6, job % 6
        m = 0
        for s in range(len(spans)):
            state = np.zeros(b.shape[1] - 1)
            for t in range(spans[s, 0], spans[s, 1]):
                value = 0.0
                if shown[t, i]:
                    value = _filtered(b[i], a[i], e[k, i, t], state)
                if kept[t]:
                    out[k, i, m] = value * scale[i]
                    m += 1


@njit(**FROM_PYTHON)
def sum_of_squares(b, a, e, spans, kept, shown):
    """Sum of squares of the kept filtered values of e (n,), of those shown, and their count."""
    total, count = 0.0, 0
    for s in range(len(spans)):
        state = np.zeros(len(b) - 1)
        for t in range(spans[s, 0], spans[s, 1]):
            if not shown[t]:
                continue
            value = _filtered(b, a, e[t], state)
            if kept[t]:
                total += value * value
                count += 1
    return total, count


@njit(**INTERNAL)
def convolve(a, b):
    """Product of two polynomials; `numpy.convolve` takes longer to call than to work."""
    out = np.zeros(len(a) + len(b) - 1)
    for i in range(len(a)):
        for j in range(len(b)):
            out[i + j] += a[i] * b[j]
    return out


@njit(nogil=True, **FROM_PYTHON)
def negative_log_likelihood(noise, kind, h, moved, poles, forgets, e, spans, kept, shown):
    """Of innovations e (n,) of one run under a noise (5,), up to a constant.

    Args:
        noise: as `AxisNoise`.
        kind: what is read.
        h: period of the readings, s.
        moved: transition (3, 3) over h, see `AxisMotion.over`.
        poles: of the filter that e was found with.
        forgets: likewise.
        e: innovations.
        spans: first and last + 1 (s, 2) of each.
        kept: which of them count (n,).
        shown: which are there at all (n,).
    """
    _, _, _, variance, own_poles, own_forgets = solve_steady_state(
        kind, h, moved, noise[0], noise[1], noise[2], noise[3], noise[4]
    )
    b, a = convolve(own_forgets, poles), convolve(forgets, own_poles)
    squares, count = sum_of_squares(b, a, e, spans, kept, shown)
    return 0.5 * (squares / variance + count * np.log(variance))
