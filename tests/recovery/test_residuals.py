"""A residual that was put there is found again, on runs it was not trained on."""

import numpy as np
import pytest
from scipy.signal import lfilter

from rovsim.dynamics.learned.features import assemble
from rovsim.learning.learner import learner_settings, learners, train

# the share of the hidden residual's RMS that may remain per axis on a held-out run. In 12
# dimensions the nearest neighbours are far; a Gaussian process sees which features matter.
REMAINS = {"knn": 0.9, "gp": 0.4, "svgp": 0.4}


def smooth(rng, n, width):
    """Random signals (n, 6) of unit size that change within about `width` samples."""
    b, a = [1 - np.exp(-1 / width)], [1, -np.exp(-1 / width)]
    x = lfilter(b, a, lfilter(b, a, rng.normal(size=(n + 20 * width, 6)), axis=0), axis=0)
    return x[20 * width :] / x[20 * width :].std(0)


def run(seed, n):
    """Velocity, acceleration, thrust, attitude of a made-up run and its hidden residual."""
    rng = np.random.default_rng(seed)
    nu = smooth(rng, n, 20) * [0.4, 0.3, 0.2, 0.15, 0.15, 0.4]
    tau = smooth(rng, n, 20) * [25.0, 20.0, 20.0, 2.0, 2.0, 5.0]
    u, v, w, p, q, r = nu.T
    hidden = [
        -1.2 * u * abs(u) + 0.01 * tau[:, 0],
        -1.0 * v * abs(v) - 0.5 * u * r,
        -0.4 * w + 0.05,
        -2.0 * p,
        -1.5 * q + 0.3 * u,
        -1.1 * r * abs(r) - 0.8 * u * v,
    ]
    parts = nu, np.zeros((n, 6)), tau, np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    return parts, np.stack(hidden, axis=1)


@pytest.mark.parametrize("kind", learners())
def test_a_hidden_residual_is_learnt(kind):
    quick = {"gp": {"max_points": 600, "tuning_points": 300, "iterations": 40}}
    settings = learner_settings({"kind": kind} | quick.get(kind, {}))
    seen, a_res = run(1, 4000)
    noise = 0.2 * a_res.std(0) * np.random.default_rng(2).normal(size=a_res.shape)
    X = assemble(settings.features, *seen)
    learnt = train(X, a_res + noise, settings, seed=0, control="all")
    new, truth = run(3, 1000)
    left = learnt.predict(assemble(settings.features, *new)) - truth
    remains = np.sqrt((left**2).mean(0) / (truth**2).mean(0))
    assert remains.max() < REMAINS.get(kind, 1.0), remains


def test_the_exact_process_is_the_textbook_one():
    """Posterior mean of Rasmussen & Williams (2006), eq. 2.25, with the tuned hyperparameters."""
    settings = learner_settings({"kind": "gp", "max_points": 80, "iterations": 10})
    parts, a_res = run(1, 80)
    X = assemble(settings.features, *parts)
    trained = train(X, a_res, settings, seed=0, control="all")
    a = trained.arrays
    Z, T = a["points"], a["targets"]
    Q = (X[::7] + 0.1 - a["shift"]) / a["scale"]
    for axis in range(6):

        def k(x, y, axis=axis):
            gap = (x[:, None] - y) / a["lengthscale"][axis]
            return a["outputscale"][axis] * np.exp(-0.5 * (gap**2).sum(-1))

        K = k(Z, Z) + a["noise"][axis] * np.eye(len(Z))
        f = a["mean"][axis] + k(Q, Z) @ np.linalg.solve(K, T[axis] - a["mean"][axis])
        expected = f * a["target_scale"][axis] + a["target_shift"][axis]
        assert trained.posterior(X[::7] + 0.1)[0][:, axis] == pytest.approx(expected, abs=1e-9)
