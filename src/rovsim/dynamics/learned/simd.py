"""Arithmetic on LANES points side by side, with which all exported residuals are computed.

Loops run over slices of constant or plain length, and take four features or rows at once (UNROLL in
`layout`). Only then does LLVM turn them into vector instructions, which need a third of the time
(measured).
"""

from math import log

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from rovsim.dynamics.compilation.compiled import FROM_PYTHON, INTERNAL
from rovsim.dynamics.learned.layout import LANES, MAX_POINTS

# 64 KiB for the values of kernels, and a little more for what each kernel keeps beside them
SCRATCH_SIZE = MAX_POINTS + 1024

# Sums may be reordered: a prediction may differ in its last bits between processors.
reordered = njit(error_model="numpy", fastmath={"reassoc", "contract", "nsz"}, **INTERNAL)
# Not here: a bound that rounds as the distance it bounds is never too large (`tree_search`).
exact = njit(error_model="numpy", **INTERNAL)
# Without a call, no references to arrays of a tuple are counted: a tenth of a search (measured).
exact_inline = njit(error_model="numpy", forceinline=True, **INTERNAL)


@intrinsic
def stack(typing):
    """Pointer to SCRATCH_SIZE float64 on the calling function's stack, which no thread shares."""

    def codegen(context, builder, signature, arguments):
        pointer = cgutils.alloca_once(builder, ir.DoubleType(), size=SCRATCH_SIZE)
        pointer.align = 64  # a line of the cache
        return pointer

    return types.CPointer(types.float64)(), codegen


@intrinsic
def _bits(typing, x):
    """The float64 x as an int64 of the same bits."""

    def codegen(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), codegen


@intrinsic
def _float(typing, bits):
    """The float64 of these bits."""

    def codegen(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.int64), codegen


@exact
def scaled(data, at, d, x, z):
    """Write scaled features into z (d',); elements after the first d are zero.

    Args:
        data: an exported residual; its shift (d,) and scale (d,) begin at index `at`.
        at: that index.
        d: number of features.
        x: unscaled features.
        z: is written to.
    """
    z[:] = 0.0
    for j in range(d):
        z[j] = (x[j] - data[at + j]) / data[at + d + j]


@exact
def add_squares(points, b, j, x, s):
    """Add squared distances along UNROLL features, from feature j on, to s (LANES,).

    Args:
        points: (blocks, d', LANES).
        b: block whose LANES points are taken.
        j: first of the features.
        x: the query (d',).
        s: is added to.
    """
    x0, x1, x2, x3 = x[j], x[j + 1], x[j + 2], x[j + 3]
    for i in range(LANES):
        e0, e1 = points[b, j, i] - x0, points[b, j + 1, i] - x1
        e2, e3 = points[b, j + 2, i] - x2, points[b, j + 3, i] - x3
        s[i] = (((s[i] + e0 * e0) + e1 * e1) + e2 * e2) + e3 * e3


_LOG2E, _ROUND = 1.0 / log(2.0), 1.5 * 2.0**52  # adding _ROUND leaves the integer in the low bits
_LN2_HIGH = 6.93147180369123816490e-01  # log(2) with its last 33 bits zero: n times it is exact
_LN2_LOW = 1.90821492927058770002e-10  # the rest (W. J. Cody & W. Waite 1980, ch. 6)
_MAX_EXPONENT = 709.1  # exp(-x) is 0 from here on
# 4e-18 at ln(2)/2
_TAYLOR = [1.0 / float(np.prod(np.arange(1.0, k + 1.0))) for k in range(14)]
C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, C13 = _TAYLOR[2:]


@njit(error_model="numpy", fastmath={"contract"}, **FROM_PYTHON)
def exponentials(s):
    """Replace every s >= 0 by exp(-s) within 2e-16 of it; NaN stays NaN.

    `math.exp` would be a call for every value and keep the loop from becoming vector instructions.
    """
    for i in range(s.size):
        y = -(_MAX_EXPONENT if s[i] > _MAX_EXPONENT else s[i])
        t = y * _LOG2E + _ROUND
        n = t - _ROUND
        r = (y - n * _LN2_HIGH) - n * _LN2_LOW
        p = C8 + r * (C9 + r * (C10 + r * (C11 + r * (C12 + r * C13))))
        p = C2 + r * (C3 + r * (C4 + r * (C5 + r * (C6 + r * (C7 + r * p)))))
        p = 1.0 + r * (1.0 + r * p)
        s[i] = p * _float((_bits(t) + 1023) << 52)  # type: ignore[call-arg]  # times 2^n


@reordered
def products(rows, first, k):
    """Scalar products of k (n,) with UNROLL rows of a matrix, from row `first` on.

    `rows` is the matrix as a flat array, with rows of length n.
    """
    n = k.size
    at = first * n
    r0, r1 = rows[at : at + n], rows[at + n : at + 2 * n]
    r2, r3 = rows[at + 2 * n : at + 3 * n], rows[at + 3 * n : at + 4 * n]
    a = b = c = d = 0.0
    for i in range(n):
        a += r0[i] * k[i]
        b += r1[i] * k[i]
        c += r2[i] * k[i]
        d += r3[i] * k[i]
    return a, b, c, d
