"""The noise floor: what a perfect model would score.

Its errors come from three sources, all drawn at random here: the disturbance that pushes the
vehicle while the model does not know of it, the noise of the state it starts from, and the noise of
the velocity it is compared with, both after the filter. Level and memory are those of `noise.py`,
fitted to the train runs.
"""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.diagnosis.observer.noise import Noise
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.observer.windows import SECONDS, differences
from rovsim.dynamics.actuation import Between
from rovsim.dynamics.model import Model
from rovsim.evaluation.scores import normalised, rms
from rovsim.measurement.signals.chain import SignalSettings, velocities
from rovsim.measurement.signals.filter import filter_eta
from rovsim.simulation.windows import find_windows

DRAWS = 8
PAD = 1.0  # s before and after, so that the filter has settled


def simulate_noise_floor(
    model: Model,
    runs: Sequence[ObservedRun],
    noise: Noise,
    signals: SignalSettings,
    between: Between,
    seed: int = 0,
) -> float | None:
    """The `windows_2s` error (see scores.normalised) of a perfect model on these runs."""
    random = np.random.default_rng(seed)
    errors = [_errors(model, w, noise, signals, between, random) for w in runs]
    return normalised([w.motion for w in runs], rms(np.concatenate(errors)))


def _errors(model, run, noise, signals, between, random) -> Array:
    """Errors (n, 6) of a perfect model on one run, all draws."""
    pushes = _pushes(model, run, noise, random)
    anchors = np.array([a for a, _ in find_windows(run.motion, SECONDS)], int)
    reported = [_noisy(run, noise, signals, random) for _ in range(DRAWS)]
    truth = np.tile(run.motion.state[anchors], (DRAWS, 1, 1))
    starts = np.array([state[anchors] for state in reported])
    happened = differences([model] * DRAWS, run, between, truth, pushes)
    predicted = differences([model] * DRAWS, run, between, starts)
    at = _rows(run)
    read = np.array([state[at, 7:] - run.motion.state[at, 7:] for state in reported])
    return (predicted - happened - read).reshape(-1, 6)


def _rows(run: ObservedRun) -> Array:
    """Samples or bins of all windows, in the order of `differences`."""
    shift = 0 if run.motion.binned else 1
    parts = [np.arange(a + shift, b + shift) for a, b in find_windows(run.motion, SECONDS)]
    return np.concatenate([np.arange(0), *parts])


def _pushes(model: Model, run: ObservedRun, noise: Noise, random) -> Array:
    """Wrench (draws, k, 6) of the disturbance over the integration steps."""
    fade = np.exp(-run.h / noise.memory)
    kicks = random.normal(size=(len(run.edges) - 1, DRAWS, 6)) * np.sqrt(1.0 - fade**2)
    a, x = np.empty_like(kicks), random.normal(size=(DRAWS, 6))
    for k, kick in enumerate(kicks):
        x = fade * x + kick
        a[k] = x
    return (a * noise.level).swapaxes(0, 1) @ model.body.M.T


def _noisy(run: ObservedRun, noise: Noise, signals: SignalSettings, random) -> Array:
    """States (n, 13) as another measurement of the same motion would have reported them."""
    state = run.motion.state.copy()
    if run.motion.binned:
        state[:, 7:] += noise.reading * random.normal(size=(len(state), 6))
        return state
    pad = round(PAD / run.period)
    kicks = noise.reading * random.normal(size=(len(state) + 2 * pad, 6))
    poses = np.hstack([kicks[:, :3], rotations.exp(kicks[:, 3:])])  # about a vehicle at rest
    inside = slice(pad, len(poses) - pad)
    poses, nu = (
        filter_eta(poses, run.period, signals.filter),
        velocities(poses, run.period, signals)[0],
    )
    state[:, :3] += rotations.rotate(state[:, 3:7], poses[inside, :3])
    state[:, 3:7] = rotations.multiply(state[:, 3:7], poses[inside, 3:])
    state[:, 7:] += nu[inside]
    return state
