"""A flight in plain words, for a pilot who would hold the sticks."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.signs import minus
from rovsim.design.inputs import (
    BASELINES,
    MIN_AMPLITUDE,
    NUMBERS_PER_AXIS,
    SWELL_SECONDS,
    Oscillation,
)
from rovsim.design.search import CandidateFlight
from rovsim.design.settings import FlightLimits
from rovsim.results.experiment import Start

MIN_SWELL = 0.25  # of `Oscillation.swell`: less is not worth saying
MIN_SQUARENESS = 0.5  # of `Oscillation.square`: beyond, the stick is rather held at its ends


def instruct(flight: CandidateFlight, axes: Array, start: Start, limits: FlightLimits) -> list[str]:
    """Sentences, in the order in which they are needed.

    Args:
        flight: to be flown.
        axes: those (j,) that its numbers are of.
        start: where it begins.
        limits: what full sticks are.
    """
    yaw = minus(f"{np.degrees(start.yaw_rad):.0f}")
    sentences = [
        f"Put the vehicle to {_place(start)} in the recordings' axes, yaw {yaw} degrees: level, at "
        "rest, within 0.1 m and 5 degrees.",
        "Start the recording, then send experiment.csv as it is, from a computer. No pilot and no "
        "autopilot may act beside it: what keeps the vehicle level is in the commands.",
        "By hand, instead of step 2: start the recording, let an autopilot hold attitude and "
        "depth, log what the thrusters are told, keep away from the walls, and move the sticks so:",
        *(_numbers(flight, axes) if len(flight.numbers) else _usual(flight)),
        f"A full stick is what holds {limits.speed:g} m/s, {limits.turn_rate:g} rad/s or "
        f"{np.degrees(limits.tilt):.0f} degrees of tilt, or full thrust where that is less.",
    ]
    return sentences


def _place(start: Start) -> str:
    axes = zip("xyz", (start.x_m, start.y_m, start.z_m), strict=True)
    return ", ".join(f"{axis} {minus(f'{value:.2f}')} m" for axis, value in axes)


def _numbers(flight: CandidateFlight, axes: Array) -> list[str]:
    rows = flight.numbers[1:].reshape(len(axes), NUMBERS_PER_AXIS)
    swings = [(AXES[axis], Oscillation.of(row)) for axis, row in zip(axes, rows, strict=True)]
    sentences = [_swing(axis, swing) for axis, swing in swings if swing.amplitude > MIN_AMPLITUDE]
    unused = [axis for axis, swing in swings if swing.amplitude <= MIN_AMPLITUDE]
    return [*sentences, f"Leave alone: {', '.join(unused)}."] if unused else sentences


def _swing(axis: str, swing: Oscillation) -> str:
    motion = (
        "hold it over to one side, then to the other"
        if swing.square > MIN_SQUARENESS
        else "swing it"
    )
    weaker = (
        f", growing weaker down to {100 * swing.amplitude * (1.0 - swing.swell):.0f} % and strong "
        f"again every {SWELL_SECONDS:g} s"
        if swing.swell > MIN_SWELL
        else ""
    )
    return (
        f"{axis.capitalize()}: {motion}, {100 * swing.amplitude:.0f} % of a full stick, there and "
        f"back in {1.0 / swing.frequency:.1f} s{weaker}."
    )


def _usual(flight: CandidateFlight) -> Sequence[str]:
    level, vertical = flight.amplitude or (0.0, 0.0)
    return [
        f"{BASELINES[flight.name].words}; {100 * level:.0f} % of a full stick in surge, sway and "
        f"yaw, {100 * vertical:.0f} % in heave, roll and pitch."
    ]
