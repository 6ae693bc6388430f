"""Evaluate an exported residual (`layout`) at one sample or at many, by compiled kernels.

`rovsim.learning.export` makes such arrays. The kernels trust them, so `checks` refuses arrays of a
file that are not consistent. Many threads may call the kernels: scratch lies on the caller's stack.
"""

import numpy as np
from numba import carray

from rovsim.dynamics.compilation.compiled import FROM_PYTHON, keep
from rovsim.dynamics.learned.kernel_expansion import faded, posterior
from rovsim.dynamics.learned.layout import KIND, NEIGHBOURS, OUTPUTS
from rovsim.dynamics.learned.neighbours import neighbours
from rovsim.dynamics.learned.simd import SCRATCH_SIZE, stack

kept = keep(error_model="numpy", **FROM_PYTHON)


@kept
def evaluate(data, x, out):
    """Evaluate the residual at the features x of one sample.

    Args:
        data: an exported residual.
        x: unscaled features; elements after the residual's own features are not read.
        out: is written to: body acceleration (6,), m/s2 and rad/s2. NaN where x is not finite.
    """
    scratch = carray(stack(), (SCRATCH_SIZE,))  # type: ignore[call-arg]
    if data[KIND] == NEIGHBOURS:
        neighbours(data, x, scratch, out)
    else:
        faded(data, x, scratch, out)


@kept
def evaluate_many(data, X):
    """Evaluate the body acceleration (n, 6), m/s2 and rad/s2, at unscaled features X (n, d)."""
    out = np.empty((X.shape[0], int(data[OUTPUTS])))
    for row in range(X.shape[0]):
        evaluate(data, X[row], out[row])
    return out


@kept
def posterior_many(data, X):
    """Evaluate mean and variance (n, 6) of an expansion at features X (n, d), without fading."""
    scratch = carray(stack(), (SCRATCH_SIZE,))  # type: ignore[call-arg]
    mean = np.empty((X.shape[0], int(data[OUTPUTS])))
    variance = np.empty_like(mean)
    for row in range(X.shape[0]):
        posterior(data, X[row], scratch, mean[row], variance[row])
    return mean, variance
