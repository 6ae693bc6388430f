"""Evaluation of an exported residual (`layout`), one sample or many, by compiled kernels.

`rovsim.learning.export` writes such arrays, and `checks` refuses those of a file that do not fit:
the kernels trust them. They are safe to call from many threads: scratch lies on the caller's stack.
"""

import numpy as np
from numba import carray

from rovsim.dynamics.engine.compiled import FROM_PYTHON, keep
from rovsim.dynamics.learned.kernel_expansion import faded, posterior
from rovsim.dynamics.learned.layout import KIND, NEIGHBOURS, OUTPUTS
from rovsim.dynamics.learned.neighbours import neighbours
from rovsim.dynamics.learned.simd import SCRATCH, stack

kept = keep(error_model="numpy", **FROM_PYTHON)


@kept
def evaluate(data, x, out):
    """Residual body acceleration out (6,), m/s2 and rad/s2, at one sample's features x.

    x may be longer than the residual's features: the rest is not read. Not finite in, NaN out.
    """
    scratch = carray(stack(), (SCRATCH,))  # type: ignore[call-arg]
    if data[KIND] == NEIGHBOURS:
        neighbours(data, x, scratch, out)
    else:
        faded(data, x, scratch, out)


@kept
def evaluate_many(data, X):
    """Residual body acceleration (n, 6) at features X (n, d), one row after the other."""
    out = np.empty((X.shape[0], int(data[OUTPUTS])))
    for row in range(X.shape[0]):
        evaluate(data, X[row], out[row])
    return out


@kept
def posterior_many(data, X):
    """Mean and variance (n, 6) of an expansion at features X (n, d); nothing fades."""
    scratch = carray(stack(), (SCRATCH,))  # type: ignore[call-arg]
    mean = np.empty((X.shape[0], int(data[OUTPUTS])))
    variance = np.empty_like(mean)
    for row in range(X.shape[0]):
        posterior(data, X[row], scratch, mean[row], variance[row])
    return mean, variance
