"""The acceleration that a model lacks at the measured states: a_res = a_real - a_sim.

This is teacher forcing: the model is evaluated at each measured state, and never integrated over
more than two bins.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.learned.features import assemble
from rovsim.dynamics.learned.settings import FeatureSettings
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.binned import backward_difference, bin_means
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.measured import blank
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.measured_states import (
    accelerate_as_measured,
    drive_as_measured,
    interpolate_state,
    nearest_steps,
    undo_mocap_view,
)
from rovsim.simulation.replay import Anchor, simulate
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from rovsim.simulation.step_grid import StepGrid


@dataclass(frozen=True, eq=False)
class Samples:
    """Inputs and targets of a learned residual, at n samples of one run.

    Attributes:
        index: (n,) of the samples or bins in `motion.time`.
        nu: body velocity (n, 6), m/s and rad/s.
        attitude: quaternion (n, 4) body to world.
        wrench: wrench (n, 6) of the drive, that is of the thrusters above all, N and N m, in body
            axes FRD at CO.
        a_sim: instantaneous body acceleration (n, 6) of the model there, m/s2 and rad/s2.
        a_res: body acceleration (n, 6) that the model lacks, a_real - a_sim, m/s2 and rad/s2. Here
            a_sim has passed the filter or the bins of the measurement.
    """

    index: Array
    nu: Array
    attitude: Array
    wrench: Array
    a_sim: Array
    a_res: Array

    def features(self, settings: FeatureSettings) -> Array:
        """Features X (n, d) of a learned residual."""
        return assemble(settings, self.nu, self.a_sim, self.wrench, self.attitude)


def sample_run(model: Model, motion: Motion, settings: SimulationSettings) -> Samples:
    """Compare a model with the measured acceleration at all usable instants of a run.

    Everything is in true body axes at CO. Where the model says that the motion capture sees another
    point or other axes, the measurement is converted first, so that tau_res = M a_res holds in a
    replay. On axes that were not measured, `a_res` is zero.
    """
    motion = undo_mocap_view(model, motion)
    make = _of_bins if motion.binned else _of_samples
    samples = make(model, motion, settings)
    return replace(samples, a_res=blank(motion.measured, samples.a_res, 0.0))


def _of_samples(model: Model, motion: Motion, settings: SimulationSettings) -> Samples:
    """Compare at samples: the model's acceleration passes the filter of the measurement."""
    drive = drive_as_measured(model, motion, settings.replay)
    a_sim = accelerate_as_measured(model, motion, drive)
    smoothing, period = settings.signals.suited(motion).filter, time_step(motion.time)
    stretches = [np.arange(a, b) for a, b in motion.segments()]
    filtered = np.concatenate(
        [smoothing.smoothed(a_sim[k], period) for k in stretches] or [np.empty((0, 6))]
    )
    index = np.concatenate([*stretches, np.arange(0)])
    return Samples(
        index,
        motion.nu[index],
        motion.eta[index, 3:],
        drive.wrench[index],
        a_sim[index],
        motion.nu_dot[index] - filtered,
    )


def _of_bins(model: Model, motion: Motion, settings: SimulationSettings) -> Samples:
    """Compare at bins: both accelerations are backward differences of the means of two bins."""
    usable = motion.usable[1:] & motion.usable[:-1] & np.isfinite(motion.nu_dot[1:]).all(axis=1)
    index, drive = 1 + np.flatnonzero(usable), drive_as_measured(model, motion, settings.replay)
    a_sim = accelerate_as_measured(model, motion, drive)[index]
    a_real_like = _differences_of_bins(model, motion, settings.replay, index)
    return Samples(
        index,
        motion.state_nu[index],
        motion.eta[index, 3:],
        drive.wrench[index],
        a_sim,
        motion.nu_dot[index] - a_real_like,
    )


def _differences_of_bins(
    model: Model, motion: Motion, settings: ReplaySettings, index: Array
) -> Array:
    """Simulate pairs of bins; returns backward differences of the mean velocities of the two.

    Args:
        model: the model.
        motion: a binned run as the model sees it, see `undo_mocap_view`.
        settings: step length and how commands are held.
        index: (n,) of the second bin of each pair; a simulation starts with the first one.

    Returns:
        Accelerations (n, 6), m/s2 and rad/s2.
    """
    grid, edges = StepGrid.over(motion, settings.step), np.append(motion.time, motion.end)
    nearest = nearest_steps(motion, grid)
    firsts, lasts = nearest[index - 1], np.maximum(nearest[index + 1], nearest[index - 1] + 1)
    starts = [
        Anchor(int(b), int(e - b), interpolate_state(motion, grid.edges[b]))
        for b, e in zip(firsts, lasts, strict=True)
    ]
    differences = np.empty((len(index), 6))
    paths = simulate(model, motion, starts, settings)
    for row, (k, b, path) in enumerate(zip(index, firsts, paths, strict=True)):
        fine = grid.edges[b : b + len(path)]
        means = bin_means(fine, path[:, 7:], np.clip(edges[k - 1 : k + 2], fine[0], fine[-1]))
        differences[row] = backward_difference(means, motion.time[k - 1 : k + 1])[1]
    return differences
