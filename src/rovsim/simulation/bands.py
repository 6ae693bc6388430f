"""Bands: the range in which a measured run should lie, given all that is uncertain in a model.

The model is replayed many times. Each time its effects and their values are drawn from their
posterior, the start has a random error, a random disturbance acts, and the result is reported with
the noise of the readings, all as they were fitted. If the model and its noise are right, the
measurement is one more such draw: a 90 % band then contains 90 % of it.
"""

from dataclasses import replace
from typing import Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import conjugate, multiply, rotate, short_way, to_euler
from rovsim.dynamics.effects.base import StochasticCurrent
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.noise_draws import NoiseDraws
from rovsim.simulation.prediction import BAND_LEVEL, Band, Prediction
from rovsim.simulation.replay import ReplayCase, Spans, predict_all
from rovsim.simulation.settings import SimulationSettings
from rovsim.simulation.step_grid import StepGrid
from rovsim.simulation.windows import predicted

# A draw falls below the i-th of n others with probability i / (n + 1): with 39 the ends of the band
# are the second and the last but one.
DRAWS = 39
LEAD_IN_S = 5.0  # before a part of a run: by then thrusters and filters have settled
MAX_GROUP_S = 300.0  # at once: draws of longer ones would not fit into memory


def why_without_bands(model: Model, motion: Motion) -> str | None:
    """The reason why a model has no band for a run, for a message; None where it has one."""
    if model.uncertainty is None:
        return (
            "it was not fitted; models that rovsim add makes of a diagnosis know how sure they are"
        )
    if NoiseDraws.of(model.uncertainty.noise, np.random.default_rng()) is None:
        return "its file does not say what noise there is"
    if motion.measured is not None:
        return "how the noise of parts of a pose passes the filters is not known"
    if any(isinstance(effect, StochasticCurrent) for effect in model.effects):
        return "where its current wanders to is not known"
    return None


def predict_band(
    model: Model,
    motion: Motion,
    spans: Spans,
    settings: SimulationSettings,
) -> Band | None:
    """Predict the band of a model in some windows of a run.

    Args:
        model: with its uncertainty.
        motion: the run, as the motion capture reported it.
        spans: first sample or bin of each window, and its last one.
        settings: filter and derivative of the measurement, step length, and how commands are held.

    Returns:
        The band at all times of the run, NaN outside the windows and in windows longer than
        `MAX_GROUP_S`; None where the model has no band, see `why_without_bands`.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    random = np.random.default_rng(0)  # the same band each time
    if model.uncertainty is None or why_without_bands(model, motion):
        return None
    noise = NoiseDraws.of(model.uncertainty.noise, random)
    assert noise is not None
    band, period = Band.empty(len(motion.time)), float(np.mean(np.diff(motion.time)))
    for group in _divide(spans, round(MAX_GROUP_S / period)):
        first = max(group[0][0] - round(LEAD_IN_S / period), 0)
        part = slice(first, group[-1][1] + round(settings.signals.reach / period) + 1)
        windows = [(a - first, b - first) for a, b in group]
        group_band = _draw_band(model, motion.part(part), windows, noise, settings)
        finite = np.isfinite(group_band.nu).all(axis=(0, 2))
        band.nu[:, part][:, finite] = group_band.nu[:, finite]
        band.place[:, part][:, finite] = group_band.place[:, finite]
    return band


def _divide(spans: Spans, most: int) -> Iterator[list[tuple[int, int]]]:
    """Group windows so that each group spans `most` samples at the most; leave out longer ones."""
    group: list[tuple[int, int]] = []
    for a, b in spans:
        if group and b - group[0][0] > most:
            yield group
            group = []
        if b - a <= most:
            group.append((a, b))
    if group:
        yield group


def _draw_band(
    model: Model,
    motion: Motion,
    spans: Spans,
    noise: NoiseDraws,
    settings: SimulationSettings,
) -> Band:
    """Replay `DRAWS` draws of a model and its noise in some windows of a run."""
    wrenches = noise.draw_disturbance(
        np.diff(StepGrid.over(motion, settings.replay.step).edges), DRAWS
    )
    motions = noise.resample_measurement_noise(motion, model.mocap_view, settings.signals, DRAWS)
    models = [model.draw(noise.random) for _ in range(DRAWS)]
    cases = [ReplayCase(*draw) for draw in zip(models, motions, wrenches, strict=True)]
    predictions = predict_all(cases, spans, settings)
    as_measured = [_misread(p, motion, m) for p, m in zip(predictions, motions, strict=True)]
    places = np.array([_place(p, motion, spans) for p in as_measured])
    return Band(band_ends(np.array([p.nu for p in as_measured])), band_ends(places))


def _misread(prediction: Prediction, motion: Motion, again: Motion) -> Prediction:
    """Give a prediction the measurement errors of `motion` in place of those of `again`.

    The replay started from `again`, which has other errors than the measured `motion`. The
    difference of the two is added to the prediction, so that it begins at the measured state.
    """
    rotation = multiply(conjugate(again.eta[:, 3:]), motion.eta[:, 3:])
    shift = rotate(conjugate(again.eta[:, 3:]), motion.eta[:, :3] - again.eta[:, :3])
    position = prediction.eta[:, :3] + rotate(prediction.eta[:, 3:], shift)
    eta = np.hstack([position, multiply(prediction.eta[:, 3:], rotation)])
    return replace(prediction, eta=eta, nu=prediction.nu + motion.nu - again.nu)


def _place(prediction: Prediction, motion: Motion, spans: Spans) -> Array:
    """Position m NED and angles rad (n, 6), without jumps of 2 pi within a window.

    The angles are continued from the measured ones where each window begins.
    """
    measured = to_euler(motion.eta[:, 3:])
    angles = short_way(to_euler(prediction.eta[:, 3:]) - measured)
    for window in spans:
        at = predicted(motion, window)
        angles[at] = np.unwrap(angles[at], axis=0)
    return np.hstack([prediction.eta[:, :3], measured + angles])


def band_ends(drawn: Array) -> Array:
    """Lower and upper end (2, ...) of the band that s draws (s, ...) give."""
    tail = 0.5 * (1.0 - BAND_LEVEL)
    with np.errstate(invalid="ignore"):  # of draws that diverged
        return np.quantile(drawn, [tail, 1.0 - tail], axis=0, method="weibull")
