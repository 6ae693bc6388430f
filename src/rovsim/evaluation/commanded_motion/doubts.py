"""Find what contradicts how a campaign describes a run: axes, conventions, tank or clocks."""

from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import usual_range
from rovsim.core.rotations import angle_between, half_turn, matrix, multiply
from rovsim.core.signs import minus
from rovsim.dynamics.vehicle import Vehicle
from rovsim.evaluation.commanded_motion.clocks import MIN_PEAK_LEAD, tell_following
from rovsim.evaluation.commanded_motion.conventions import OtherReading, find_convention
from rovsim.evaluation.commanded_motion.cross_correlation import (
    MIN_CORRELATION,
    MIN_LEAD_RATIO,
    MIN_MOTION_S,
    cross_correlate,
    orientations,
)
from rovsim.evaluation.commanded_motion.predicted import can_push_sideways, cause, righting
from rovsim.measurement.quality.unlogged_commands import find_unlogged
from rovsim.measurement.recording import Recording
from rovsim.measurement.rough_motion import (
    ResampledPoses,
    estimate_velocities,
    even_poses,
    of_poses,
)

MAX_COMMANDS_S = 120.0  # s of commands that are considered
UPSIDE_DOWN_COSINE = -0.5  # cosine of the tilt: 120 degrees; beyond, a vehicle hangs upside down
# m beyond a wall, share of the frames: more than a wrong calibration
WALL_TOLERANCE_M, MAX_OUTSIDE_SHARE = 0.5, 0.5
REMEDY_OF_UNLOGGED = (
    "A diagnosis does not use that part of train runs, but errors count it: leave it out with "
    "'use', or complete the log."
)
# m: a path of up to 20 m in metres, where the file should have mm; rad: a vehicle that is driven
TINY_PATH_M, TURNED_RAD = 0.02, 0.5
# Correlation of vehicles that cannot push sideways. Axis by axis, perfect models of a torpedo and
# of a ship that steers reach 0.8 along wrong axes, and of a catamaran 0.98 along the right ones.
CLEAR_CORRELATION = 0.9
# Correlation, along any axes or by any convention, beyond which a log is surely that of the run.
# With the logs of other runs, runs of 12 s reach 0.56 (tank=tiny, seven seeds), of 60 s 0.25.
SURELY_OWN_CORRELATION = 0.65
TRANSLATION_AXES = ("surge", "sway", "heave")


def find_doubts(
    recording: Recording, vehicle: Vehicle, same_log: Sequence[str] = ()
) -> tuple[str, ...]:
    """List what contradicts the description of a run, in sentences; empty if nothing does.

    Args:
        recording: of the run, as its campaign describes it.
        vehicle: the vehicle.
        same_log: ids of other runs that name the same log of commands.
    """
    upside_down = list(_upside_down(recording, vehicle))
    mismatches = [] if upside_down else list(_unlike_commands(recording, vehicle, same_log))
    others = (_out_of_tank, _tiny_path, _unlogged)
    return (*upside_down, *mismatches, *(text for look in others for text in look(recording)))


def _upside_down(recording: Recording, vehicle: Vehicle) -> Iterator[str]:
    """Remark a vehicle that is upside down most of the time, although its weight would right it."""
    if not recording.tracked.any() or not righting(vehicle)[3] > 0.0:
        return
    upright = matrix(recording.attitude[recording.tracked])[:, 2, 2]
    if np.median(upright) < UPSIDE_DOWN_COSINE:
        yield (
            "The vehicle hangs upside down most of the time, which its own weight would right: "
            "check 'mocap.body_axes' and 'mocap.world_axes'."
        )


def _unlike_commands(
    recording: Recording, vehicle: Vehicle, same_log: Sequence[str]
) -> Iterator[str]:
    """Remark a motion unlike its commands: of another run, convention, axes or clock."""
    predicted = _predict_caused(recording, vehicle)
    if predicted is None:
        return
    has_poses = recording.tracked.any() and recording.nu is None
    poses = even_poses(recording) if has_poses else None
    motion = estimate_velocities(recording) if poses is None else of_poses(poses)
    if not np.isfinite(motion.nu).any():
        return
    correlation = cross_correlate(motion, *predicted)
    if not correlation.excited.any() or not correlation.overlaps:
        return
    best_score, axes = max(
        ((correlation.best(a := np.array(o))[0], a) for o in orientations()), key=_first
    )
    if best_score < CLEAR_CORRELATION and not can_push_sideways(vehicle):
        return
    score, lag = correlation.best(np.eye(3))
    lag = lag if score >= MIN_CORRELATION else 0.0
    other = (
        _read_otherwise(poses, recording.site.axes, predicted, lag, best_score) if poses else None
    )
    if other is not None:
        message, own_log = str(other), other.score >= SURELY_OWN_CORRELATION
    elif best_score >= MIN_CORRELATION and best_score > MIN_LEAD_RATIO * score:
        message = _of_other_axes(axes, best_score, score)
        own_log = best_score >= SURELY_OWN_CORRELATION
    else:
        message, own_log = tell_following(correlation, np.eye(3)), score >= MIN_CORRELATION
    if message:
        yield _sentence(_of_same_log(same_log, score) if same_log and not own_log else message)


def _sentence(half: str) -> str:
    """Begin with a capital letter."""
    return half[0].upper() + half[1:]


def _of_other_axes(axes: Array, correlation: float, as_described: float) -> str:
    """Describe the axes (3, 3) along which a motion is like its commands, more than as described.

    Both correlations are means over the excited axes.
    """
    return (
        f"the vehicle moves along other axes than those commanded: {_describe_swaps(axes)} "
        f"(correlation {correlation:.2f}; as described {as_described:.2f}). Check "
        "'mocap.body_axes', 'mocap.world_axes' and the order and signs of 'commands.columns'."
    )


def _of_same_log(runs: Sequence[str], correlation: float) -> str:
    """Say that other runs name the log of a motion that is unlike it (mean correlation)."""
    named = f"runs {' and '.join(runs)} name" if len(runs) > 1 else f"run {runs[0]} names"
    return (
        f"{named} the same log of commands, and this motion is unlike it (correlation "
        f"{correlation:.2f}): correct 'commands' of the run whose log it is not. If it is one log "
        "of several runs, check 'commands_shift_s', then the axes."
    )


def _read_otherwise(
    poses: ResampledPoses, signs: Array, caused: tuple[Array, Array], lag: float, best: float
) -> OtherReading | None:
    """Find another convention of poses that is better than merely other axes; None without one.

    Args:
        poses: in NED and FRD, as they were read.
        signs: of the axes of the file relative to NED (3,).
        caused: times (m,) in s, and the body velocities (m, 6) FRD that commands should cause.
        lag: by which the motion comes after its commands, s.
        best: highest correlation along any axes.
    """
    turn = half_turn(signs)
    # poses along the axes of the file again, as in its columns
    as_in_file = ResampledPoses(
        poses.time, poses.position * signs, multiply(turn, multiply(poses.attitude, turn))
    )
    convention = find_convention(as_in_file, caused, [np.diag(signs)], lag)
    better = convention is not None and convention.score > best + MIN_PEAK_LEAD
    return convention if better else None


def _first(pair: tuple[float, Array]) -> float:
    """Key that sorts pairs by their first number."""
    return pair[0]


def _covered(recording: Recording) -> Array:
    """Times (n,) in s at which something was measured, but for what `use` leaves out."""
    return recording.time[recording.tracked] if recording.tracked.any() else recording.time


def _predict_caused(recording: Recording, vehicle: Vehicle) -> tuple[Array, Array] | None:
    """Times (n,) in s and body velocities (n, 6) FRD that the commands would cause.

    None where there are too few commands, or the run is too short.
    """
    commands = recording.commands
    covered = _covered(recording)
    if len(commands.time) < 2 or np.ptp(covered) < MIN_MOTION_S:
        return None
    begin = max(float(commands.time[0]), float(covered[0]))
    return cause(vehicle, commands, begin, MAX_COMMANDS_S)


def _describe_swaps(axes: Array) -> str:
    """Say in which direction a vehicle moves for each commanded one, where these are different."""
    swaps = []
    for name, column in zip(TRANSLATION_AXES, axes.T, strict=True):
        k = int(np.argmax(np.abs(column)))
        move = f"{'−' if column[k] < 0 else ''}{TRANSLATION_AXES[k]}"
        if move != name:
            swaps.append(f"{name} shows as {move}")
    return ", ".join(swaps)


def _out_of_tank(recording: Recording) -> Iterator[str]:
    """Remark a path that lies mostly outside of the tank."""
    position, walls = recording.position[recording.tracked], recording.site.tank
    if not len(position):
        return
    low, high = position < walls[:, 0] - WALL_TOLERANCE_M, position > walls[:, 1] + WALL_TOLERANCE_M
    share = np.mean(low | high, axis=0)
    k = int(np.argmax(share))
    if share[k] > MAX_OUTSIDE_SHARE:
        sign = recording.site.axes[k]
        ends = usual_range(position[:, k])
        reach = [minus(f"{end:.2f}") for end in sorted(float(sign * end) for end in ends)]
        tank = [minus(f"{wall:g}") for wall in sorted((sign * walls[k]).tolist())]
        yield (
            f"Most of the path lies outside of the tank: {'xyz'[k]} from {reach[0]} to {reach[1]} "
            f"m, 'tank' says {tank[0]} to {tank[1]}. Check it, and 'mocap.world_axes'."
        )


def _tiny_path(recording: Recording) -> Iterator[str]:
    """Remark a vehicle that turns a lot, and hardly moves: its positions may be in metres."""
    if not recording.tracked.any():
        return
    position, attitude = (
        recording.position[recording.tracked],
        recording.attitude[recording.tracked],
    )
    low, high = usual_range(position)
    angle = angle_between(attitude, attitude[0])
    length, turned = float(np.max(high - low)), float(np.ptp(usual_range(angle)))
    if length < TINY_PATH_M and turned > TURNED_RAD:
        yield (
            f"The vehicle turns by {turned:.1f} rad within {1e3 * length:.2g} mm: its positions "
            "seem to be a thousand times too small, as metres are where millimetres should be."
        )


def _unlogged(recording: Recording) -> Iterator[str]:
    """Remark a log of commands that begins late, ends early or has holes."""
    measured = _covered(recording)
    begin, end = float(measured[0]), float(measured[-1])
    spans = find_unlogged(recording.commands, begin, end)
    inside = (measured > spans[:, :1]) & (measured < spans[:, 1:])
    spans = spans[inside.any(axis=1)]
    lengths = np.diff(spans, axis=1)[:, 0]
    late, early = (spans == [begin, end]).T
    if late.any():
        yield (
            f"The log of commands begins {lengths[0]:.1f} s after the recording; its first line is "
            f"held before. {REMEDY_OF_UNLOGGED}"
        )
    holes = lengths[~late & ~early]
    if len(holes):
        yield (
            f"The log of commands has holes: {len(holes)}, of up to {holes.max():.2f} s; the line "
            f"before each is held. {REMEDY_OF_UNLOGGED}"
        )
    if early.any():
        yield (
            f"The log of commands ends {lengths[-1]:.1f} s before the recording; its last line is "
            f"held until then. {REMEDY_OF_UNLOGGED}"
        )
