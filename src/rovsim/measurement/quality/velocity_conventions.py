"""Check by the poses of a file the units and axes of the velocities and rates beside them."""

from itertools import product
from typing import Iterator, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import conjugate, log, multiply, unrotate
from rovsim.measurement.recording.channels import Channel
from rovsim.measurement.recording.csv_checks import LIMITS
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.recording import Recording

AVERAGING_TIME_S = 0.5  # over which poses and velocities are compared: slower than noise
MIN_WINDOWS = 20
MIN_RMS_VELOCITY = 0.03  # m/s or rad/s, root mean square: slower motion is not compared
ALIKE_COSINE, UNLIKE_COSINE = 0.9, 0.6  # between measured velocities and those from the poses
MAX_SCALE_RATIO = 1.3  # ratio of sizes: the scale of a sensor is never so wrong
UNIT_FACTORS = {  # by channel: factors of sensors' units
    "velocity": ((100.0, "cm/s"), (1000.0, "mm/s")),
    "rates": ((180.0 / np.pi, "deg/s"),),
}
UNIT_TOLERANCE = 0.15  # off the factor of a unit
PLURALS = {"velocity": "velocities", "rates": "rates"}


class _Both(NamedTuple):
    """Mean velocities or rates (n, 3) over n windows, m/s or rad/s.

    Attributes:
        body: from the poses, along the axes of the body.
        world: from the poses, along the axes of the world.
        measured: as they were measured.
    """

    body: Array
    world: Array
    measured: Array


def doubt_velocities(recording: Recording | Export) -> Iterator[str]:
    """Yield a sentence where velocities (u, v, w) or rates (p, q, r) contradict the poses."""
    if not recording.tracked.any():
        return
    for kind, measured in _measured(recording).items():
        comparison = _compare(recording, kind, measured)
        if comparison is not None and (doubt := _judge(kind, comparison)):
            yield doubt


def find_impossible(of: Recording | Export) -> str | None:
    """Say so where velocities or rates are usually larger than any vehicle's; None otherwise."""
    for name, limit in LIMITS.items():
        for value in (_beside_poses(of).get(name), getattr(of.channels.get(name), "value", None)):
            if value is not None and (usual := limit.beyond(value)):
                hint = f"{limit.fastest:g} at most: are they {limit.others[0]}?"
                return f"too fast: {name} of {usual:.3g} {limit.unit}, {hint}"
    return None


def _beside_poses(of: Recording | Export) -> dict[str, Array]:
    """Velocities and rates (n, 3) that were exported with the poses, by channel kind."""
    return {} if of.nu is None else {"velocity": of.nu[:, :3], "rates": of.nu[:, 3:]}


def _measured(of: Recording | Export) -> dict[str, Array]:
    """All measured velocities and rates (n, 3), at the times of the poses, by channel kind."""
    channels = {name: _at(of.channels[name], of.time) for name in LIMITS if name in of.channels}
    return channels | _beside_poses(of)


def _at(own: Channel, time: Array) -> Array:
    return np.stack(
        [np.interp(time, own.time, c, left=np.nan, right=np.nan) for c in own.value.T], axis=1
    )


def _compare(of: Recording | Export, kind: str, measured: Array) -> _Both | None:
    """Average both over sliding windows; None with too few windows or hardly any motion."""
    tracked = of.tracked & np.isfinite(measured).all(axis=1)
    time, position, attitude = of.time[tracked], of.position[tracked], of.attitude[tracked]
    if len(time) < MIN_WINDOWS:
        return None
    k = max(1, round(AVERAGING_TIME_S / float(np.median(np.diff(time)))))
    duration = (time[k:] - time[:-k])[:, None]
    usable = duration[:, 0] < 2.0 * AVERAGING_TIME_S + 2.0 * np.median(np.diff(time))
    if usable.sum() < MIN_WINDOWS:
        return None
    if kind == "velocity":
        world = (position[k:] - position[:-k]) / duration
        body = unrotate(attitude[k // 2 : len(attitude) - k + k // 2], world)
    else:
        body = log(multiply(conjugate(attitude[:-k]), attitude[k:])) / duration
        world = log(multiply(attitude[k:], conjugate(attitude[:-k]))) / duration
    step = np.diff(time)[:, None]
    value = measured[tracked]
    integral = np.vstack(
        [np.zeros((1, 3)), np.cumsum(0.5 * step * (value[1:] + value[:-1]), axis=0)]
    )
    mean = (integral[k:] - integral[:-k]) / duration
    if float(np.sqrt(np.mean(body[usable] ** 2))) < MIN_RMS_VELOCITY:
        return None
    return _Both(body[usable], world[usable], mean[usable])


def _judge(kind: str, both: _Both) -> str:
    quantity, cosine = PLURALS[kind], _cosine(both.measured, both.body)
    if cosine > ALIKE_COSINE:
        return _judge_size(kind, both)
    in_world = _cosine(both.measured, both.world)
    if in_world > ALIKE_COSINE:
        return (
            f"The {quantity} lie along the axes of the world, by the poses beside them (cosine "
            f"{in_world:.2f}, along the body {cosine:.2f}): turn them into the body's axes, or "
            "leave them out."
        )
    signs = max(product((1.0, -1.0), repeat=3), key=lambda s: _cosine(both.measured * s, both.body))
    mirrored = _cosine(both.measured * signs, both.body)
    if mirrored > ALIKE_COSINE:
        axes = " and ".join(n for n, s in zip("xyz", signs, strict=True) if s < 0.0)
        return (
            f"The {quantity} fit the poses beside them with the sign of {axes} turned (cosine "
            f"{mirrored:.2f}, as they are {cosine:.2f}): poses and {quantity} have other axes. "
            "Bring them to the same."
        )
    if cosine < UNLIKE_COSINE:
        return (
            f"The {quantity} do not fit the poses beside them (cosine {cosine:.2f}): check "
            "their axes, their order and their clock, or leave them out."
        )
    return ""


def _judge_size(kind: str, both: _Both) -> str:
    size = float(np.sum(both.measured * both.body) / np.sum(both.body**2))
    if 1.0 / MAX_SCALE_RATIO < size < MAX_SCALE_RATIO:
        return ""
    unit = next((u for f, u in UNIT_FACTORS[kind] if abs(size / f - 1.0) < UNIT_TOLERANCE), "")
    ours = LIMITS[kind].unit
    hint = f"they are {unit}, not {ours}." if unit else f"are they {ours}?"
    return (
        f"The {PLURALS[kind]} are {size:.3g} times what the poses beside them say: {hint} Name "
        "their columns after their unit, or correct them."
    )


def _cosine(a: Array, b: Array) -> float:
    norm = float(np.sqrt(np.sum(a**2) * np.sum(b**2)))
    return float(np.sum(a * b)) / norm if norm > 0.0 else 0.0
