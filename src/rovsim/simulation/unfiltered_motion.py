"""Undo the smoothing of a motion capture: recover the motion that the cameras saw."""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.low_pass import LowPass, in_body, in_world
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.binned import backward_difference
from rovsim.measurement.signals.clock import find_stretches, time_step
from rovsim.measurement.signals.motion import Motion


def sharpen(model: Model, motion: Motion) -> Motion:
    """Undo the smoothing that a model says the motion capture does.

    The low-pass of the motion capture and the filter of the measurement commute. So smoothing can
    be undone in the filtered poses and in their derivatives.
    """
    if not model.mocap_view.low_pass.time_constants:
        return motion
    channels = stage_outputs(model, motion)[0]
    return _of_bins(motion, channels) if motion.binned else _of_samples(motion, channels)


def stage_outputs(model: Model, motion: Motion) -> Array:
    """Recover the input of the low-pass of a motion capture, and the outputs of its stages.

    Returns:
        Array (stages + 1, n, c) in world axes: the input, then the output of each stage, of which
        the last is what is reported. The channels are those of `low_pass.in_world`: c = 21 for a
        sampled motion, 14 for a binned one. NaN where the motion is unknown.
    """
    low_pass = model.mocap_view.low_pass
    rates = (motion.state_nu,) if motion.binned else (motion.nu, motion.nu_dot)
    channels = in_world(motion.eta, *rates)
    outputs = np.full((len(low_pass.time_constants) + 1, *channels.shape), np.nan)
    for a, b in find_stretches(np.isfinite(channels).all(axis=1)):
        if motion.binned:
            outputs[:, a:b] = _stages_of_bins(low_pass, channels[a:b], motion.time[a:b])
        else:
            outputs[:, a:b] = low_pass.stages(channels[a:b], time_step(motion.time))
    return outputs


def _stages_of_bins(low_pass: LowPass, channels: Array, time: Array) -> Array:
    """Recover the stages (stages + 1, n, 14) at the starts of bins, which are far apart.

    Each sample is computed from derivatives up to the third instead of earlier samples.
    """
    eta, first = channels[:, :7], channels[:, 7:]
    second = _differentiate(first, time)
    orders = np.stack([eta, first, second, _differentiate(second, time)])
    stages = low_pass.stages_of_derivatives(orders)
    return np.concatenate([stages[:, 0], stages[:, 1]], axis=-1)


def _differentiate(values: Array, time: Array) -> Array:
    """Central differences (n, c) of channels (n, c) at `time` (n,) s; zero for one sample."""
    return np.gradient(values, time, axis=0) if len(time) > 1 else np.zeros_like(values)


def _of_samples(motion: Motion, seen: Array) -> Motion:
    """Replace a sampled motion by the channels `seen` (n, 21), where these are known."""
    finite = np.isfinite(seen).all(axis=1)[:, None]
    measured = (motion.eta, motion.nu, motion.nu_dot)
    eta, nu, nu_dot = (np.where(finite, x, y) for x, y in zip(in_body(seen), measured, strict=True))
    return replace(motion, eta=eta, nu=nu, nu_dot=nu_dot, state_nu=nu)


def _of_bins(motion: Motion, seen: Array) -> Motion:
    """Replace a binned motion by the channels `seen` (n, 14), where these are known.

    The mean velocity of a bin changes by the average of the changes at its two ends.
    """
    finite = np.isfinite(seen).all(axis=1)[:, None]
    measured = (motion.eta, motion.state_nu)
    eta, state_nu = (np.where(finite, x, y) for x, y in zip(in_body(seen), measured, strict=True))
    change = np.where(finite, state_nu - motion.state_nu, 0.0)
    nu = motion.nu + 0.5 * (change + np.concatenate([change[1:], change[-1:]]))
    nu_dot = backward_difference(nu, motion.time)
    return replace(motion, eta=eta, nu=nu, nu_dot=nu_dot, state_nu=state_nu)
