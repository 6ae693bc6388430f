"""Products and inverses of matrices of two to four rows, compiled.

Written out: to call BLAS and LAPACK takes longer than the work itself, and they, like whole-array
expressions, take some 10 s more to compile than these loops.
"""

from typing import Any

import numpy as np
from numba import njit

# A division by zero gives what is not finite: it ends no search among noises that cannot be.
FROM_PYTHON: dict[str, Any] = {"cache": True, "no_cfunc_wrapper": True, "error_model": "numpy"}
# Called by compiled functions alone; what makes one callable from outside takes as long to compile.
INTERNAL: dict[str, Any] = {**FROM_PYTHON, "no_cpython_wrapper": True}


@njit(**INTERNAL)
def multiply(A, B):
    """A (n, k) times B (k, m)."""
    out = np.zeros((A.shape[0], B.shape[1]))
    for i in range(A.shape[0]):
        for j in range(B.shape[1]):
            for k in range(A.shape[1]):
                out[i, j] += A[i, k] * B[k, j]
    return out


@njit(**INTERNAL)
def transpose(A):
    """The transpose of A (n, n), as a copy."""
    out = np.zeros(A.shape)
    for i in range(len(A)):
        for j in range(len(A)):
            out[i, j] = A[j, i]
    return out


@njit(**INTERNAL)
def increase(A, B):
    """Add B to A (n, m) in place; the largest size of what was added, and of what is there now."""
    added, there = 0.0, 0.0
    for i in range(A.shape[0]):
        for j in range(A.shape[1]):
            A[i, j] += B[i, j]
            added, there = max(added, abs(B[i, j])), max(there, abs(A[i, j]))
    return added, there


@njit(**INTERNAL)
def add_to_diagonal(A, value):
    """Add a number to the diagonal of A (n, n) in place."""
    for i in range(len(A)):
        A[i, i] += value


@njit(**INTERNAL)
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
