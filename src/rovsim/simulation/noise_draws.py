"""Draw at random what no model predicts: a disturbance, and errors of the measurement."""

from dataclasses import dataclass, replace

import numpy as np
from numpy import ndarray as Array

from rovsim.core import gauss_markov, rotations
from rovsim.dynamics.mocap_view import MocapView
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.differentiate import differentiate_eta
from rovsim.measurement.signals.filter import filter_eta
from rovsim.measurement.signals.motion import Motion
from rovsim.results.fitted import FittedNoise

PAD_S = 1.0  # before and after, so that the filter has settled
MAX_STACK_SAMPLES = 1 << 16  # filters take some twenty times their room


@dataclass(frozen=True, eq=False)
class NoiseDraws:
    """Draws disturbances and errors of measurements, along the body axes from surge to yaw.

    Attributes:
        disturbance_std: standard deviation (6,) of the disturbance, m/s2 and rad/s2.
        correlation_time: of the disturbance (6,), s.
        reading_std: standard deviation (6,) of the white noise of readings: m and rad for poses,
            m/s and rad/s for velocities that are means over bins.
        period: time between two readings, s.
        colour_std: standard deviation (6,) of a slow error of poses, m and rad.
        colour_correlation_time: of that error (6,), s.
        random: generator of all draws.
    """

    disturbance_std: Array
    correlation_time: Array
    reading_std: Array
    period: float
    colour_std: Array
    colour_correlation_time: Array
    random: np.random.Generator

    @staticmethod
    def of(noise: FittedNoise, random: np.random.Generator) -> "NoiseDraws | None":
        """The draws for the noise of a model file; None where the file lacks some of it."""
        levels = (noise.disturbance, noise.memory_s, noise.reading)
        if any(len(values) != 6 or None in values for values in levels) or noise.period_s is None:
            return None
        level, memory, reading = (np.array(values, dtype=float) for values in levels)
        coloured = None not in noise.colour and len(noise.colour) == len(noise.colour_memory_s) == 6
        colour = np.array(noise.colour if coloured else np.zeros(6), dtype=float)
        colour_memory = np.array(noise.colour_memory_s if coloured else np.ones(6), dtype=float)
        return NoiseDraws(level, memory, reading, noise.period_s, colour, colour_memory, random)

    def draw_disturbance(self, steps: Array, draws: int) -> Array:
        """Draw disturbances, each axis a stationary first-order Gauss-Markov process.

        Args:
            steps: lengths (k,) of the integration steps, s.
            draws: number of draws.

        Returns:
            Accelerations (draws, k, 6), m/s2 and rad/s2.
        """
        fade = gauss_markov.decay(steps[:, None, None] / self.correlation_time)
        normal = self.random.normal(size=(len(fade), draws, 6))
        disturbance = gauss_markov.propagate(fade, normal, self.random.normal(size=(draws, 6)))
        return np.asarray((disturbance * self.disturbance_std).swapaxes(0, 1))

    def resample_measurement_noise(
        self, motion: Motion, view: MocapView, signals: SignalSettings, draws: int
    ) -> list[Motion]:
        """Add further measurement errors to a motion, after its filter and derivative.

        Args:
            motion: as it was measured.
            view: how the motion capture reports a motion; it may smooth.
            signals: filter and derivative of the measurement.
            draws: number of motions to return, each with errors of its own.
        """
        if motion.binned:
            return [self._read_bins_again(motion) for _ in range(draws)]
        period, signals = time_step(motion.time), signals.suited(motion)
        batch_size = max(1, MAX_STACK_SAMPLES // len(motion.time))
        motions = []
        for first in range(0, draws, batch_size):
            count = min(batch_size, draws - first)
            errors = zip(
                *self._misread(len(motion.time), period, count, view, signals), strict=True
            )
            motions += [_move(motion, *error) for error in errors]
        return motions

    def _read_bins_again(self, motion: Motion) -> Motion:
        """Add white noise to the mean velocities of a binned motion."""
        error = self.reading_std * self.random.normal(size=motion.nu.shape)
        return replace(motion, nu=motion.nu + error, state_nu=motion.state_nu + error)

    def _misread(
        self, count: int, period: float, draws: int, view: MocapView, signals: SignalSettings
    ) -> tuple[Array, Array, Array]:
        """Draw measurements of a vehicle at rest, which consist of errors alone.

        The errors of poses pass the smoothing of the motion capture, the filter and the derivative.

        Returns:
            Poses (draws, count, 7), velocities (draws, count, 6) and accelerations of that shape,
            relative to the body at rest, m, m/s, m/s2 and rad, rad/s, rad/s2.
        """
        pad = round(PAD_S / period)
        kicks = np.stack([self._err(count + 2 * pad, period) for _ in range(draws)])
        poses = np.concatenate([kicks[..., :3], rotations.exp(kicks[..., 3:])], axis=-1)
        smooth = filter_eta(view.smooth(poses, period), period, signals.filter)
        nu, nu_dot = differentiate_eta(smooth, period, signals.differentiate)
        unpadded = slice(pad, pad + count)
        return smooth[:, unpadded], nu[:, unpadded], nu_dot[:, unpadded]

    def _err(self, count: int, period: float) -> Array:
        """Draw errors (count, 6) of single frames, `period` s apart, m and rad."""
        std = self.reading_std * np.sqrt(self.period / period)  # a reading is a mean of frames
        return std * self.random.normal(size=(count, 6)) + self._err_slowly(count, period)

    def _err_slowly(self, count: int, period: float) -> Array:
        """Draw slow Gauss-Markov errors (count, 6) of frames, `period` s apart, m and rad."""
        if not self.colour_std.any():
            return np.zeros((count, 6))
        keep = gauss_markov.decay(period / self.colour_correlation_time)
        errors = self.random.normal(size=(count, 6)) * self.colour_std
        # the first is as large as any later one
        return np.vstack([errors[:1], gauss_markov.propagate(keep, errors[1:], errors[0])])


def _move(motion: Motion, off: Array, nu: Array, nu_dot: Array) -> Motion:
    """Add errors along the body axes to a motion.

    Args:
        motion: n samples.
        off: errors of poses (n, 7): position m, and quaternion.
        nu: errors of velocities (n, 6), m/s and rad/s.
        nu_dot: errors of accelerations (n, 6), m/s2 and rad/s2.
    """
    position = motion.eta[:, :3] + rotations.rotate(motion.eta[:, 3:], off[:, :3])
    eta = np.hstack([position, rotations.multiply(motion.eta[:, 3:], off[:, 3:])])
    nu, nu_dot = motion.nu + nu, motion.nu_dot + nu_dot
    return replace(motion, eta=eta, nu=nu, nu_dot=nu_dot, state_nu=nu)
