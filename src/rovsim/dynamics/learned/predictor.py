"""Evaluation of an exported residual (`layout`), one sample or many, by compiled kernels.

`rovsim.learning.export` writes such arrays and checks those that come from a file: the kernels
trust them. They are safe to call from many threads: scratch lies on the caller's stack.
"""

from hashlib import sha256
from pathlib import Path

import numpy as np
from numba import carray, njit

from rovsim.dynamics.learned.kernel_expansion import faded, posterior
from rovsim.dynamics.learned.layout import KIND, NEIGHBOURS, OUTPUTS
from rovsim.dynamics.learned.neighbours import neighbours
from rovsim.dynamics.learned.simd import SCRATCH, stack

NAMES = "features", "kernel_expansion", "layout", "neighbours", "predictor", "simd"
FILES = [Path(__file__).with_name(f"{name}.py") for name in NAMES]  # all that is compiled here


# Numba's cache knows a function's own file and what it closes over, not the files of what it calls.
# So the functions kept on disk close over the digest of them all.
VERSION = int(sha256(b"".join(file.read_bytes() for file in FILES)).hexdigest()[:12], 16)
kept = njit(cache=True, error_model="numpy")


def _one(version):
    @kept
    def evaluate(data, x, out):
        """Residual body acceleration out (6,), m/s2 and rad/s2, at one sample's features x.

        x may be longer than the residual's features: the rest is not read. Not finite in, NaN out.
        """
        _ = version
        scratch = carray(stack(), (SCRATCH,))  # type: ignore[call-arg]
        if data[KIND] == NEIGHBOURS:
            neighbours(data, x, scratch, out)
        else:
            faded(data, x, scratch, out)

    return evaluate


def _many(version):
    @kept
    def evaluate_many(data, X):
        """Residual body acceleration (n, 6) at features X (n, d), one row after the other."""
        _ = version
        out = np.empty((X.shape[0], int(data[OUTPUTS])))
        for row in range(X.shape[0]):
            evaluate(data, X[row], out[row])
        return out

    return evaluate_many


def _posterior(version):
    @kept
    def posterior_many(data, X):
        """Mean and variance (n, 6) of an expansion at features X (n, d); nothing fades."""
        _ = version
        scratch = carray(stack(), (SCRATCH,))  # type: ignore[call-arg]
        mean = np.empty((X.shape[0], int(data[OUTPUTS])))
        variance = np.empty_like(mean)
        for row in range(X.shape[0]):
            posterior(data, X[row], scratch, mean[row], variance[row])
        return mean, variance

    return posterior_many


evaluate, evaluate_many, posterior_many = _one(VERSION), _many(VERSION), _posterior(VERSION)
