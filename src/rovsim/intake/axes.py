"""Find which way the world axes and the body axes of a file point.

What may tell: the body axes along which the motion follows the commands, gravity in an
accelerometer, a logged depth, and that the vehicle swims upright on average.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import matrix
from rovsim.evaluation.commanded_motion.cross_correlation import MIN_CORRELATION, MIN_LEAD_RATIO
from rovsim.intake.survey.contents import Track
from rovsim.measurement.recording.readers import FileAxes

# Rotation (3, 3) from FRD into the file's body axes: its columns are forward, starboard and down.
BODY_ROTATIONS = {
    "flu": np.diag([1.0, -1.0, -1.0]),
    "frd": np.eye(3),
    "fur": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
}
# Unit vector that points down, in the file's world axes.
DOWN_VECTORS = {"z_up": (0.0, 0.0, -1.0), "ned": (0.0, 0.0, 1.0), "y_up": (0.0, -1.0, 0.0)}
MIN_LEVEL_COSINE = 0.7  # mean over the tilt: 45 degrees
MIN_DEPTH_CORRELATION = 0.8  # of depth and height
MIN_REST_FORCE = 5.0  # m/s2 of specific force, about half of gravity
LETTERS = "xyz"


@dataclass(frozen=True)
class Axes:
    """World and body axes of the files.

    Attributes:
        world: key of `DOWN_VECTORS`, empty where the files do not tell.
        body: key of `BODY_ROTATIONS`, empty where the files do not tell.
        reason: how they are known, or why they are not.
        likely: pairs of world and body axes in which the vehicle is upright on average, where the
            body axes have to be asked for.
    """

    world: str
    body: str
    reason: str
    likely: tuple[tuple[str, str], ...] = ()


def find_axes(
    own: FileAxes, tracks: Sequence[Track], turned: Sequence[tuple[float, Array]]
) -> Axes:
    """Find the axes of motions that all are of one format.

    Args:
        own: the axes that this format may have.
        tracks: the motion of each run.
        turned: for each of the 24 rotations (3, 3) from FRD into the file's body axes, the mean
            correlation of measured and commanded velocities, the best first; empty if unknown.
    """
    worlds, bodies = own.world, own.body
    if own.fixed:
        return Axes(worlds[0], bodies[0], own.reason)
    body, reason = _body(_upright(turned, tracks, worlds), bodies)
    if not body:
        body, by_force = _by_force(tracks, bodies)
        reason = by_force or reason
    pairs = _level(tracks, worlds, bodies)
    if body:
        possible = {world for world, body_axes in pairs if body_axes == body}
        if len(possible) == 1:
            world = possible.pop()
            return Axes(world, body, f"{reason}; the vehicle then swims upright on average")
        return Axes(_by_depth(tracks, worlds), body, reason)
    world = _by_depth(tracks, worlds)
    match = [pair for pair in pairs if pair[0] == world]
    if world and len(match) == 1:
        return Axes(
            world, match[0][1], f"{LETTERS[-1]} goes with the depth, and the vehicle is upright"
        )
    if own.usual in pairs:
        return Axes(*own.usual, own.reason)
    return Axes(world, "", reason, tuple(pairs))


def _upright(
    turned: Sequence[tuple[float, Array]], tracks: Sequence[Track], worlds: Sequence[str]
) -> list[tuple[float, Array]]:
    """Keep the rotations in which the vehicle is upright or upside down on average; else all."""
    mean = _mean_attitude(tracks)
    if mean is None:
        return list(turned)
    vertical = [np.abs(DOWN_VECTORS[world]) @ mean for world in worlds]
    upright = [
        (s, axes)
        for s, axes in turned
        if any(abs(v @ axes[:, 2]) > MIN_LEVEL_COSINE for v in vertical)
    ]
    return upright or list(turned)


def _mean_attitude(tracks: Sequence[Track]) -> Array | None:
    """Average the rotation matrices (3, 3), each run with equal weight; None without attitudes."""
    means = [R.mean(axis=0) for t in tracks if (R := _attitudes(t)) is not None]
    return np.mean(means, axis=0) if means else None


def _body(turned: Sequence[tuple[float, Array]], bodies: Sequence[str]) -> tuple[str, str]:
    """Find the body axes along which the motion follows the commands, and how sure they are.

    Returns:
        The name of the axes, empty where the commands do not tell, and a sentence on why.
    """
    if not turned or turned[0][0] < MIN_CORRELATION:
        best = f" (correlation {turned[0][0]:.2f})" if turned else ""
        return "", f"no motion that its commands explain{best}" if turned else ""
    score, axes = turned[0]
    rival = turned[1][0] if len(turned) > 1 else 0.0
    name = next((n for n in bodies if np.array_equal(axes, BODY_ROTATIONS[n])), "")
    if score < MIN_LEAD_RATIO * rival:
        return (
            "",
            f"the commands do not tell: correlation {score:.2f} and {rival:.2f} along two axes",
        )
    if name:
        return (
            name,
            f"the commanded motion shows along them (correlation {score:.2f}, next {rival:.2f})",
        )
    directions = [
        f"{word} shows along {_named(axes[:, k])}"
        for k, word in enumerate(("surge", "sway", "heave"))
    ]
    return "", (
        f"commanded {', '.join(directions)} of the file's body (correlation {score:.2f}): the "
        "rigid body is turned: make it anew along the vehicle's axes, or write the columns of a "
        "csv along them"
    )


def _named(column: Array) -> str:
    k = int(np.argmax(np.abs(column)))
    return f"{'-' if column[k] < 0 else '+'}{LETTERS[k]}"


def _by_force(tracks: Sequence[Track], bodies: Sequence[str]) -> tuple[str, str]:
    """Find body axes by gravity: the specific force of a vehicle at rest points up.

    Returns:
        The name of the axes, empty where this does not tell, and a sentence on why.
    """
    forces = [
        t.export.channels["specific_force"].value
        for t in tracks
        if "specific_force" in t.export.channels
    ]
    if not forces:
        return "", ""
    up = float(np.nanmean(np.vstack(forces)[:, 2]))
    name = "flu" if up > MIN_REST_FORCE else "frd" if up < -MIN_REST_FORCE else ""
    return (name if name in bodies else ""), f"specific force along z is {up:+.1f} m/s² on average"


def _level(
    tracks: Sequence[Track], worlds: Sequence[str], bodies: Sequence[str]
) -> list[tuple[str, str]]:
    """List the pairs of world and body axes in which the vehicle is upright on average."""
    mean = _mean_attitude(tracks)
    if mean is None:
        return []
    return [
        (world, body)
        for world in worlds
        for body in bodies
        if mean @ BODY_ROTATIONS[body][:, 2] @ np.array(DOWN_VECTORS[world]) > MIN_LEVEL_COSINE
    ]


def _attitudes(track: Track) -> Array | None:
    """Return measured attitudes as rotation matrices (n, 3, 3) from body to world, file's axes."""
    if track.posed:
        return matrix(track.export.attitude[track.export.tracked])
    channel = track.export.channels.get("attitude")
    return (
        None if channel is None else matrix(channel.value[np.isfinite(channel.value).all(axis=1)])
    )


def _by_depth(tracks: Sequence[Track], worlds: Sequence[str]) -> str:
    """Find world axes by how z correlates with a logged depth; empty where that does not tell."""
    signs = []
    for track in tracks:
        depth = track.export.channels.get("depth")
        if depth is None or not track.posed:
            continue
        tracked = track.export.tracked
        z = np.interp(depth.time, track.export.time[tracked], track.export.position[tracked, 2])
        if min(np.std(z), np.std(depth.value)) > 0:
            signs.append(float(np.corrcoef(z, depth.value[:, 0])[0, 1]))
    if (
        not signs
        or min(abs(s) for s in signs) < MIN_DEPTH_CORRELATION
        or len({s > 0 for s in signs}) > 1
    ):
        return ""
    name = "ned" if signs[0] > 0 else "z_up"
    return name if name in worlds else ""
