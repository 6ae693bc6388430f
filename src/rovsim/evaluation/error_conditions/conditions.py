"""Average conditions, such as speed or place, and a model's error over short blocks of a run.

The error is the acceleration error a_res = a_real - a_sim of a model that is evaluated at the
measured state, averaged over blocks of 0.5 s. That is the velocity that a model gains too little in
half a second, divided by half a second. Other errors would tell less. A velocity error at the end
of a 2 s window is the sum of all that went wrong in it, while the conditions changed. A single
a_res is mostly the noise of two differentiations; the mean over a block removes it, except for the
noise of two velocities. Half a second is short compared with the motion of such a vehicle.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import ACCELERATION_UNITS, AXES, FORCE_UNITS, VELOCITY_UNITS
from rovsim.core.rotations import to_euler
from rovsim.measurement.signals.measured import find_measured
from rovsim.measurement.signals.motion import Motion
from rovsim.results.error_conditions import BLOCK_S, THROUGHOUT
from rovsim.simulation.samples import Samples

MAX_ERROR = 1e6  # m/s2, rad/s2: a force that is no number, or a parameter that is absurd
MIN_MEASURED_SHARE = 0.5  # share of a block that must have been measured
SPEED_NAMES = ("surge speed", "sway speed", "heave speed", "roll rate", "pitch rate", "yaw rate")
HEADING = "heading"
ACCELERATION = "acceleration"  # a kind that is drawn, but not searched
ANGLE_NAMES = ("roll angle", "pitch angle", HEADING)
UNITS = {  # of the six axes, by kind
    "speed": VELOCITY_UNITS,
    "thrust": FORCE_UNITS,
    "change": tuple(f"{unit}/s" for unit in FORCE_UNITS),
    ACCELERATION: ACCELERATION_UNITS,
}


@dataclass(frozen=True)
class Condition:
    """Something that varies along a run, and with which an error may vary.

    Attributes:
        name: as a person reads it.
        unit: of its values.
        kind: throughout (a constant), speed, absolute (speed), thrust, change (of thrust),
            attitude, place, time or acceleration.
        axis: to which it belongs; "" for none.
    """

    name: str
    unit: str
    kind: str
    axis: str = ""


@dataclass(frozen=True, eq=False)
class Blocks:
    """Means over n blocks of `BLOCK_S`.

    Attributes:
        error: of the model's acceleration (n, 6), a_real - a_sim, m/s2 and rad/s2.
        measured: acceleration (n, 6), m/s2 and rad/s2.
        values: of each condition (n,), in its unit.
        time: since the begin of the run (n,), s.
        run: number of the run (n,) to which a block belongs.
        axes: mask (6,) of the axes that were measured; on others, errors mean nothing.
    """

    error: Array
    measured: Array
    values: dict[Condition, Array]
    time: Array
    run: Array
    axes: Array


def average_blocks(motion: Motion, samples: Samples) -> Blocks:
    """Average one run over blocks; those with too few samples or an impossible error are left out.

    Args:
        motion: the run.
        samples: accelerations and errors of a model at its measured states.
    """
    time = motion.time[samples.index] - motion.time[0]
    step = float(np.median(np.diff(motion.time)))
    block, count = np.unique(np.floor(time / BLOCK_S).astype(int), return_counts=True)
    full = count * step >= MIN_MEASURED_SHARE * BLOCK_S
    member = np.searchsorted(block, np.floor(time / BLOCK_S).astype(int))

    def mean_of_all(x: Array) -> Array:
        total = np.zeros((len(block), *x.shape[1:]))
        np.add.at(total, member, x)
        return (total.T / count).T

    axes = find_measured(motion.measured)
    possible = np.abs(mean_of_all(samples.a_res)[:, axes]) < MAX_ERROR  # which NaN is not
    kept = full & possible.all(axis=1)

    def mean(x: Array) -> Array:
        return np.asarray(mean_of_all(x)[kept])

    values = {
        c: _mean_angle(mean, x) if c.name == HEADING else mean(x)
        for c, x in _values(motion, samples, time).items()
    }
    acceleration = motion.nu_dot[samples.index]
    run = np.zeros(int(kept.sum()), int)
    return Blocks(mean(samples.a_res), mean(acceleration), values, mean(time), run, axes)


def join_blocks(parts: Sequence[Blocks]) -> Blocks:
    """Join the blocks of several runs; a condition that is unknown in one of them is left out."""
    shared = [c for c in parts[0].values if all(c in p.values for p in parts)]
    values = {c: np.concatenate([p.values[c] for p in parts]) for c in shared}
    run = np.concatenate([np.full(len(p.time), k) for k, p in enumerate(parts)])

    def join(name: str) -> Array:
        return np.concatenate([getattr(p, name) for p in parts])

    axes = np.all([p.axes for p in parts], axis=0)
    return Blocks(join("error"), join("measured"), values, join("time"), run, axes)


def list_shown_conditions(blocks: Blocks) -> dict[Condition, Array]:
    """List the conditions that a figure may show, with their values (n,).

    These are the conditions of the blocks and the measured accelerations. The latter are not
    searched: the error contains their noise, so the two would seem related. A figure may compare
    the errors of two models over them, as the same noise is in both.
    """
    conditions = dict(blocks.values)
    for k in np.flatnonzero(blocks.axes).tolist():
        unit = UNITS[ACCELERATION][k]
        condition = Condition(f"{AXES[k]} acceleration", unit, ACCELERATION, AXES[k])
        conditions[condition] = blocks.measured[:, k]
    return conditions


def _values(motion: Motion, samples: Samples, time: Array) -> dict[Condition, Array]:
    """Values (n,) of every condition at n samples; conditions that nobody measured are left out."""
    moves = find_measured(motion.measured)
    values = {Condition(THROUGHOUT, "", THROUGHOUT): np.zeros(len(time))}
    rate = np.gradient(samples.wrench, time, axis=0) if len(time) > 1 else 0 * samples.wrench
    for k in np.flatnonzero(moves).tolist():
        unit = UNITS["speed"][k]
        values[Condition(SPEED_NAMES[k], unit, "speed", AXES[k])] = samples.nu[:, k]
    for k in np.flatnonzero(moves).tolist():
        name, unit = f"absolute {SPEED_NAMES[k]}", UNITS["speed"][k]
        values[Condition(name, unit, "absolute", AXES[k])] = np.abs(samples.nu[:, k])
    for k, axis in enumerate(AXES):
        unit = UNITS["thrust"][k]
        values[Condition(f"{axis} thrust", unit, "thrust", axis)] = samples.wrench[:, k]
    for k, axis in enumerate(AXES):
        unit = UNITS["change"][k]
        values[Condition(f"change of {axis} thrust", unit, "change", axis)] = rate[:, k]
    angles = to_euler(samples.attitude)
    turns = moves[3:] if motion.measured is None else [*moves[3:5], *motion.measured.heading]
    for k in np.flatnonzero(turns).tolist():
        values[Condition(ANGLE_NAMES[k], "rad", "attitude", AXES[3 + k])] = angles[:, k]
    return (
        values | _place(motion, samples.index) | {Condition("time in the run", "s", "time"): time}
    )


def _place(motion: Motion, index: Array) -> dict[Condition, Array]:
    """Values (n,) of conditions of place: position in MoCap axes, distances to walls and surface.

    Unmeasured coordinates, and distances to unknown walls or an unknown surface, are left out.
    """
    coordinates = np.ones(3, bool) if motion.measured is None else motion.measured.coordinates
    position = motion.eta[index, :3]
    in_mocap = position * motion.site.axes
    walls, surface = motion.site.tank[:2], motion.site.tank[2, 0]
    names = "xy" if np.isfinite(surface) else "xyz"
    places = {
        Condition(f"MoCap {n}", "m", "place"): in_mocap[:, k]
        for k, n in enumerate(names)
        if coordinates[k]
    }
    if np.isfinite(walls).all() and coordinates[:2].all():
        away = np.concatenate([position[:, :2] - walls[:, 0], walls[:, 1] - position[:, :2]], 1)
        places[Condition("distance to the nearest wall", "m", "place")] = away.min(axis=1)
    if np.isfinite(surface) and coordinates[2]:
        places[Condition("depth below the surface", "m", "place")] = position[:, 2] - surface
    return places


def _mean_angle(mean, angle: Array) -> Array:
    """Mean direction of angles, rad, which does not jump where an angle does; `mean` averages."""
    return np.arctan2(mean(np.sin(angle)), mean(np.cos(angle)))
