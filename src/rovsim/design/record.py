"""A predicted path as the observer would see it: readings without noise, on the campaign's clock.

What a diagnosis would learn from a flight is then computed by what will compute it.
"""

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core.rotations import continuous
from rovsim.core.run import Commands, RunInfo
from rovsim.design.recording_setup import RecordingSetup
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.observed_run import ObservedRun, prepare_run
from rovsim.measurement.signals.motion import Motion, Poses

RUN_INFO = RunInfo("designed", "6dof", "train")


def record(path: Array, commands: Commands, model: Model, setup: RecordingSetup) -> ObservedRun:
    """The run that a true path (k+1, 13) of a model would be."""
    stride, edges = setup.parts, setup.edges
    states = model.mocap_view.report(path, setup.step)
    eta = np.hstack([states[:, :3], continuous(states[:, 3:7])])[::stride]
    nu, time = states[::stride, 7:], edges[::stride]
    make = _bins if setup.like.motion.binned else _samples
    motion = make(time, eta, nu, states[:, 7:], commands, setup)
    stage = Poses(
        RUN_INFO, setup.site, motion.time, motion.eta, motion.usable, commands, motion.measured
    )
    free = model.body.free
    group_seconds = setup.like.group_seconds
    return prepare_run(
        stage, motion, setup.replay, setup.catalogue, free, group_seconds=group_seconds
    )


def _samples(
    time: Array, eta: Array, nu: Array, fine: Array, commands: Commands, setup: RecordingSetup
) -> Motion:
    return Motion(
        RUN_INFO,
        setup.site,
        time,
        eta,
        nu,
        np.gradient(nu, time, axis=0),
        nu,
        np.ones(len(time), bool),
        commands,
        False,
        float(time[-1]),
        setup.measured,
    )


def _bins(
    time: Array, eta: Array, nu: Array, fine: Array, commands: Commands, setup: RecordingSetup
) -> Motion:
    """Velocities are means over the bins."""
    integral = scipy.integrate.cumulative_simpson(fine, x=setup.edges, axis=0, initial=0.0)
    mean = np.diff(integral[:: setup.parts], axis=0) / np.diff(time)[:, None]
    change = np.vstack([np.full(6, np.nan), np.diff(mean, axis=0) / np.diff(time)[1:, None]])
    return Motion(
        RUN_INFO,
        setup.site,
        time[:-1],
        eta[:-1],
        mean,
        change,
        nu[:-1],
        np.ones(len(mean), bool),
        commands,
        True,
        float(time[-1]),
        setup.measured,
    )
