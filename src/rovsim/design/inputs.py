"""Inputs of a flight, as of a pilot's sticks: a few numbers an axis, and the usual manoeuvres.

An input is a share (ticks, 6) in [-1, 1]: full ones hold the greatest speed, turn rate and tilt
that the limits allow, or are the full thrust where that is less.
"""

from typing import Callable, Mapping, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES

TICK_SECONDS = 0.1  # s between two positions of a stick: a hand does not move it faster than 5 Hz
MIN_HZ, MAX_HZ = 0.02, 1.0  # of a swing: once in most of a minute; half of what a hand can do
MAX_STEEPNESS = 6.0  # a sine sharpened so far stands at its ends for two thirds of the time
SWELL_SECONDS = 30.0  # s from strong to weak and back
MIN_AMPLITUDE = 0.08  # of a stick: moved less, it rests


class Oscillation(NamedTuple):
    """One axis: `amplitude`, `frequency` Hz, `square` in [0, 1], `phase` in turns, `swell`.

    `swell` in [0, 1] is the share of the amplitude that comes and goes.
    """

    amplitude: float
    frequency: float
    square: float
    phase: float
    swell: float

    @staticmethod
    def of(x: Array) -> "Oscillation":
        """Of five numbers in [0, 1]."""
        amplitude = 0.0 if x[0] < MIN_AMPLITUDE else float(x[0])
        frequency = MIN_HZ * (MAX_HZ / MIN_HZ) ** float(x[1])
        return Oscillation(amplitude, frequency, float(x[2]), float(x[3]), float(x[4]))

    def move(self, t: Array) -> Array:
        """The input (n,) at times (n,) s."""
        wave = np.sin(2.0 * np.pi * (self.frequency * t + self.phase))
        steepness = MAX_STEEPNESS * self.square
        if steepness > 0.0:
            wave = np.tanh(steepness * wave) / np.tanh(steepness)
        decrease = 0.5 * self.swell * (1.0 - np.cos(2.0 * np.pi * t / SWELL_SECONDS))
        return self.amplitude * (1.0 - decrease) * wave


NUMBERS_PER_AXIS = len(Oscillation._fields)


def ticks(seconds: float) -> Array:
    """Times (n,) s at which inputs are set."""
    return TICK_SECONDS * np.arange(round(seconds / TICK_SECONDS) + 1)


def make_inputs(x: Array, axes: Array, seconds: float) -> Array:
    """Inputs (n, 6) of five numbers (5 j,) in [0, 1] for each of the axes (j,)."""
    t = ticks(seconds)
    inputs = np.zeros((len(t), len(AXES)))
    for axis, numbers in zip(axes, x.reshape(len(axes), NUMBERS_PER_AXIS), strict=True):
        inputs[:, axis] = Oscillation.of(numbers).move(t)
    return inputs


class Baseline(NamedTuple):
    """A manoeuvre: times (n,) s, axes (j,) -> inputs (n, 6), and what a pilot is told."""

    move: Callable[[Array, Array, np.random.Generator], Array]
    words: str


def _zigzag(t: Array, axes: Array, random: np.random.Generator) -> Array:
    """Ahead, turning to and fro: the helm over every 5 s (ships turn it at 10 or 20 degrees)."""
    inputs = np.zeros((len(t), len(AXES)))
    inputs[:, 0] = 1.0
    inputs[:, 5] = np.where(np.floor(t / 5.0 + 0.5) % 2 < 1, 1.0, -1.0)
    return inputs * np.isin(np.arange(len(AXES)), axes)


def _steps(t: Array, axes: Array, random: np.random.Generator) -> Array:
    """One axis after the other: ahead, rest, back, rest."""
    inputs = np.zeros((len(t), len(AXES)))
    share = len(axes) * t / (t[-1] + TICK_SECONDS)
    k, quarter = share.astype(int), (4.0 * (share % 1.0)).astype(int)
    inputs[np.arange(len(t)), axes[k]] = np.array([1.0, 0.0, -1.0, 0.0])[quarter]
    return inputs


TONES_PER_AXIS = 5  # sines of a multisine


def _multisine(t: Array, axes: Array, random: np.random.Generator) -> Array:
    """Several tones on all axes at once, no two on the same, with the phases of Schroeder (1970).

    From one swing in 20 s up to one in 2 s, which is where vehicles of this size answer.
    """
    inputs = np.zeros((len(t), len(AXES)))
    tones = np.geomspace(0.05, 0.5, TONES_PER_AXIS * len(axes))
    for j, axis in enumerate(axes):
        frequencies = tones[j :: len(axes)]
        phase = (
            -np.pi * np.arange(TONES_PER_AXIS) * (np.arange(TONES_PER_AXIS) + 1) / TONES_PER_AXIS
        )
        wave = np.sin(2.0 * np.pi * frequencies * t[:, None] + phase).sum(axis=1)
        inputs[:, axis] = wave / np.max(np.abs(wave))
    return inputs


def _prbs(t: Array, axes: Array, random: np.random.Generator) -> Array:
    """All axes full over, to a side drawn every second (a pseudo-random binary sequence)."""
    inputs = np.zeros((len(t), len(AXES)))
    for axis in axes:
        sides = random.choice([-1.0, 1.0], size=int(t[-1]) + 1)
        inputs[:, axis] = sides[t.astype(int)]
    return inputs


BASELINES: Mapping[str, Baseline] = {
    "zigzag": Baseline(_zigzag, "Ahead, and the helm over to the other side every 5 s"),
    "steps": Baseline(_steps, "One axis after the other: ahead, rest, back, rest, each as long"),
    "multisine": Baseline(
        _multisine, "All axes at once, swings of 20 s to 2 s on top of one another"
    ),
    "prbs": Baseline(
        _prbs,
        "All axes at once, each full over to a side that changes at random, every second",
    ),
}
