"""Filters of one axis and their likelihoods: a fit of the noise makes thousands of them.

Matrices of two to four rows are written out: to call BLAS and LAPACK takes longer than the work
itself, and they, like whole-array expressions, take some 10 s more to compile than these loops.
"""

import numpy as np

from rovsim.estimation.kernels.compiled import from_python, inlined, internal, unlocked

POSE, BIN_MEAN, SUM = 0, 1, 2  # what is read of an axis
MAX_DOUBLINGS = 60  # of the time that is over: far more than any filter takes to settle
DOUBLING_TOLERANCE = 1e-13  # of what there is, that a doubling still adds
# A little noise everywhere keeps the Riccati equation solvable; it is far below the readings'.
MIN_NOISE_SHARE, MIN_DRIVING_VARIANCE = 1e-6, 1e-12
READING_NOISE_SHARE = 1e-4  # of the noise that adds up


@internal
def multiply(A, B):
    """A (n, k) times B (k, m)."""
    out = np.zeros((A.shape[0], B.shape[1]))
    for i in range(A.shape[0]):
        for j in range(B.shape[1]):
            for k in range(A.shape[1]):
                out[i, j] += A[i, k] * B[k, j]
    return out


@internal
def transpose(A):
    """The transpose of A (n, n), as a copy."""
    out = np.zeros(A.shape)
    for i in range(len(A)):
        for j in range(len(A)):
            out[i, j] = A[j, i]
    return out


@internal
def increase(A, B):
    """Add B to A (n, m) in place; the largest size of what was added, and of what is there now."""
    increment, size = 0.0, 0.0
    for i in range(A.shape[0]):
        for j in range(A.shape[1]):
            A[i, j] += B[i, j]
            increment, size = max(increment, abs(B[i, j])), max(size, abs(A[i, j]))
    return increment, size


@internal
def add_to_diagonal(A, value):
    """Add a number to the diagonal of A (n, n) in place."""
    for i in range(len(A)):
        A[i, i] += value


@internal
def put_rows(A, B, count):
    """The first rows of B (n, k) into those of A: of a slice Numba compiles its error, for 2 s."""
    for i in range(count):
        for j in range(B.shape[1]):
            A[i, j] = B[i, j]


@internal
def invert(A):
    """Inverse of A (n, n), which is lost, by Gauss-Jordan elimination with partial pivoting."""
    n = len(A)
    out = np.zeros((n, n))
    add_to_diagonal(out, 1.0)
    for i in range(n):
        best = i
        for k in range(i + 1, n):
            if abs(A[k, i]) > abs(A[best, i]):
                best = k
        for j in range(n):
            A[i, j], A[best, j] = A[best, j], A[i, j]
            out[i, j], out[best, j] = out[best, j], out[i, j]
        scale = 1.0 / A[i, i]
        for j in range(n):
            A[i, j] *= scale
            out[i, j] *= scale
        for k in range(n):
            factor = A[k, i] if k != i else 0.0
            for j in range(n):
                A[k, j] -= factor * A[i, j]
                out[k, j] -= factor * out[i, j]
    return out


@from_python
def solve_steady_state(
    kind,
    h,
    moved,
    disturbance_std,
    correlation_time,
    measurement_std,
    bias_std,
    bias_correlation_time,
):
    """F, C, gain, variance of the innovations, denominators of the filter of one axis.

    Its pose and velocity go on as `moved` (3, 3) says. Velocities of bins have no slow error of
    their own.
    """
    phi, slow = np.exp(-h / correlation_time), np.exp(-h / bias_correlation_time)
    binned = kind == BIN_MEAN
    n = 2 if binned else 4 if bias_std > 0.0 else 3
    F, C, noise_denominator = np.zeros((n, n)), np.zeros(n), np.zeros(3 if n == 4 else 2)
    Q, r, disturbed = np.zeros((n, n)), measurement_std**2, 1 if binned else 2
    C[0], noise_denominator[0], noise_denominator[1] = 1.0, 1.0, -phi
    F[disturbed, disturbed] = phi
    if binned:
        F[0, 0], F[0, 1] = moved[1, 1], h
        C[1] = -0.5 * h  # the mean over a bin is the velocity at its middle
    else:
        put_rows(F, moved, 2)
    add_to_diagonal(Q, MIN_NOISE_SHARE * r)
    Q[disturbed, disturbed] = disturbance_std**2 * (1.0 - phi**2) + MIN_DRIVING_VARIANCE
    if n == 4:
        F[3, 3], C[3] = slow, 1.0
        Q[3, 3] = bias_std**2 * (1.0 - slow**2)
        noise_denominator[1], noise_denominator[2] = -phi - slow, phi * slow
    if kind == SUM:
        Q[0, 0], r = r, READING_NOISE_SHARE * r
    P = solve_riccati(F, C, Q, r)
    gain, variance = np.zeros(n), r
    for i in range(n):
        for j in range(n):
            gain[i] += P[i, j] * C[j]
        variance += C[i] * gain[i]
    correction = np.zeros((n, n))
    add_to_diagonal(correction, 1.0)
    for i in range(n):
        gain[i] /= variance
        for j in range(n):
            correction[i, j] -= gain[i] * C[j]
    return F, C, gain, variance, characteristic(multiply(F, correction)), noise_denominator


@internal
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
    for _ in range(MAX_DOUBLINGS):
        W = multiply(G, H)
        add_to_diagonal(W, 1.0)
        W = invert(W)
        AW, across = multiply(A, W), transpose(A)
        increment, size = increase(H, multiply(multiply(across, H), multiply(W, A)))
        increase(G, multiply(AW, multiply(G, across)))
        A = multiply(AW, A)
        if increment <= DOUBLING_TOLERANCE * size:
            break
    return H


@from_python
def characteristic(A):
    """Coefficients of det(z I - A), highest power first (Faddeev-LeVerrier)."""
    n = len(A)
    coefficients, M = np.zeros(n + 1), np.zeros((n, n))
    coefficients[0] = 1.0
    for k in range(1, n + 1):
        M = multiply(A, M)
        add_to_diagonal(M, coefficients[k - 1])
        AM = multiply(A, M)
        for i in range(n):
            coefficients[k] -= AM[i, i] / k
    return coefficients


@inlined
def _filtered(b, a, value, state):
    """Next output of a filter, a[0] = 1; `state` changes (direct form II, transposed)."""
    order = len(state)
    out = b[0] * value + state[0]
    for j in range(order - 1):
        state[j] = b[j + 1] * value - a[j + 1] * out + state[j + 1]
    state[order - 1] = b[order] * value - a[order] * out
    return out


@unlocked
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


@from_python
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


@internal
def convolve(a, b):
    """Product of two polynomials; `numpy.convolve` takes longer to call than to work."""
    out = np.zeros(len(a) + len(b) - 1)
    for i in range(len(a)):
        for j in range(len(b)):
            out[i + j] += a[i] * b[j]
    return out


@unlocked
def misfit(noise, kind, h, moved, denominator, noise_denominator, e, spans, kept, shown):
    """Sum of squares over their variance, its logarithm, and the number of those that count.

    Of innovations e (n,) of one run under a noise (5,).

    Args:
        noise: as `AxisNoise`.
        kind: what is read.
        h: period of the readings, s.
        moved: transition (3, 3) over h, see `AxisErrorDynamics.over`.
        denominator: of the filter that e was found with.
        noise_denominator: likewise.
        e: innovations.
        spans: first and last + 1 (s, 2) of each.
        kept: which of them count (n,).
        shown: which are there at all (n,).
    """
    _, _, _, variance, new_denominator, new_noise_denominator = solve_steady_state(
        kind, h, moved, noise[0], noise[1], noise[2], noise[3], noise[4]
    )
    b, a = (
        convolve(new_noise_denominator, denominator),
        convolve(noise_denominator, new_denominator),
    )
    squares, count = sum_of_squares(b, a, e, spans, kept, shown)
    return squares / variance, np.log(variance), count
