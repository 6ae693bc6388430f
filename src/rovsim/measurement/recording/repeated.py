"""Find poses that repeat the line before bit by bit: a slow camera, or a body out of sight.

A vehicle at rest repeats its pose, too, where there is no noise or few digits are written. So the
beginning and the end of a repetition decide: a vehicle stops and sets off slowly, while one that
moved on unseen jumps.
"""

from dataclasses import dataclass, replace
from typing import Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import turns
from rovsim.measurement.recording.exports import Export

# A camera is slower than its log if nearly all poses stand in several lines, most in equally many.
MIN_POSES, MIN_REPEATED, MIN_REGULAR = 20, 0.9, 0.8  # poses; shares
COUNT_TOLERANCE = 0.2  # of the lines of a pose; one line at least
NEARBY_STEPS = 3  # steps to either side that show how fast the vehicle moves
# A jump is a step after a repetition that is faster than the fastest steps nearby, by a factor of
# JUMP_RATIO if one line is repeated (steady motion makes it 2), LONG_JUMP_RATIO if more are. It
# covers at most MAX_CATCH_UP_RATIO times the distance of the fastest steps in that time, and more
# than a last digit (MIN_DIGITS of it).
JUMP_RATIO, LONG_JUMP_RATIO = 1.5, 2.0
MAX_CATCH_UP_RATIO = 3.0
MIN_STEP_RATIO = 1 / 3  # of the steps nearby: the last before a halt is a fifth, braking evenly
MIN_DIGITS = 3.0
DIGIT_PERCENTILE = 1.0  # of the steps that are not zero: the last digit, or less than the noise
ZERO_STEP = 1e-9  # m, rad: no step
MIN_FROZEN_FRAMES = 4  # a vehicle that moves right before and right after does not rest for so long


def without_repeated(export: Export) -> Export:
    """Remove poses that only repeat an earlier one, from an export in order of time.

    Where the camera is slower than its log, the first line of each pose is kept. Poses that are
    repeated while the vehicle moves count as not found. An export with velocities stays as it is.
    """
    frames = _Seen.of(export)
    if export.nu is not None or not frames.same.any():
        return export
    lines = _lines_of_a_pose(frames)
    if lines > 1:
        export = _slower(export, frames, lines)
        frames = _Seen.of(export)
    frozen = frames.frame[_find_frozen(frames)]
    if not len(frozen):
        return export
    tracked = export.tracked.copy()
    tracked[frozen] = False
    note = (
        f"{len(frozen)} frames repeat the pose before them to the last digit while the vehicle "
        "moves: they count as not found."
    )
    return replace(export, tracked=tracked, notes=(*export.notes, note))


@dataclass(frozen=True, eq=False)
class _Seen:
    """The n frames in which the body was found.

    Attributes:
        frame: (n,), their indices in the export.
        time: (n,) s.
        position: (n, 3) m.
        attitude: (n, 4), unit quaternions.
        same: bool (n - 1,), whether each pose but the first is that of the frame before.
    """

    frame: Array
    time: Array
    position: Array
    attitude: Array
    same: Array

    @staticmethod
    def of(export: Export) -> "_Seen":
        frame = np.flatnonzero(export.tracked)
        position, attitude = export.position[frame], export.attitude[frame]
        pose = np.hstack([position, attitude])
        repeated = (pose[1:] == pose[:-1]).all(axis=1)
        return _Seen(frame, export.time[frame], position, attitude, repeated)

    def runs(self) -> Iterator[tuple[int, int]]:
        """First frame and number of frames of each pose that stands in successive frames."""
        starts = np.concatenate([[0], np.flatnonzero(~self.same) + 1])
        count = np.diff(np.append(starts, len(self.frame)))
        return zip(starts.tolist(), count.tolist(), strict=True)

    def steps(self) -> tuple[Array, Array]:
        """Distance (n - 1,) m and angle (n - 1,) rad from each frame to the next."""
        differences = np.diff(self.position, axis=0), turns(self.attitude)
        return np.linalg.norm(differences[0], axis=1), np.linalg.norm(differences[1], axis=1)


def _lines_of_a_pose(seen: _Seen) -> int:
    """Number of lines in which each pose stands; 1 where that number is not regular."""
    count = np.array([n for _, n in seen.runs()])
    usual = int(np.median(count))
    if usual < 2 or len(count) < MIN_POSES:
        return 1
    regular = np.abs(count - usual) <= max(1.0, COUNT_TOLERANCE * usual)
    return usual if np.mean(count > 1) >= MIN_REPEATED and np.mean(regular) >= MIN_REGULAR else 1


def _slower(export: Export, seen: _Seen, lines: int) -> Export:
    """Keep the first of the lines of each pose, and of a pose that holds longer one per `lines`.

    Args:
        export: what was read.
        seen: its frames.
        lines: number of lines in which a pose usually stands.
    """
    mask = ~export.tracked
    for start, count in seen.runs():
        mask[seen.frame[start : start + max(count - lines, 0) + 1 : lines]] = True
    rows = {n: getattr(export, n)[mask] for n in ("time", "position", "attitude", "tracked")}
    note = f"Each pose stands in {lines} lines or so: the camera is slower than the log."
    return replace(export, **rows, rate=None, notes=(*export.notes, note))


def _find_frozen(seen: _Seen) -> Array:
    """Indices in `seen` of the frames that repeat a pose which the vehicle has left."""
    frozen = np.zeros(len(seen.frame), bool)
    ways = [_Way(step, np.diff(seen.time)) for step in seen.steps()]
    for start, count in seen.runs():
        if count > 1 and any(way.left(start, count) for way in ways):
            frozen[start + 1 : start + count] = True
    return np.flatnonzero(frozen)


class _Way:
    """Sizes `step` (n - 1,) of a vehicle's steps, m or rad, that `took` (n - 1,) s."""

    def __init__(self, step: Array, took: Array) -> None:
        self.step, self.took, self.speed = step, took, step / took
        moving = step[step > ZERO_STEP]
        self.seen = (
            MIN_DIGITS * float(np.percentile(moving, DIGIT_PERCENTILE)) if len(moving) else np.inf
        )

    def left(self, first: int, count: int) -> bool:
        """Whether the vehicle left the pose that `count` frames from `first` on repeat."""
        end = first + count - 1
        before, after = (
            slice(max(first - NEARBY_STEPS, 0), first),
            slice(end + 1, end + 1 + NEARBY_STEPS),
        )
        if count >= MIN_FROZEN_FRAMES and self._moves(self.step[before][::-1]):
            at_end = end == len(self.step)
            if at_end or self._moves(self.step[end : end + NEARBY_STEPS]):
                return True
        return self._jumped(before, after, first, end)

    def _moves(self, steps: Array) -> bool:
        """Whether steps beside a repetition, the nearest first, are those of a moving vehicle."""
        return bool(
            len(steps)
            and steps.sum() > NEARBY_STEPS * self.seen
            and steps[0] > MIN_STEP_RATIO * steps.max()
        )

    def _jumped(self, before: slice, after: slice, first: int, end: int) -> bool:
        """Whether the step after a repetition makes up for the motion during it."""
        if end >= len(self.step):
            return False
        fastest = max(self.speed[before].max(initial=0.0), self.speed[after].max(initial=0.0))
        jump = JUMP_RATIO if end == first + 1 else LONG_JUMP_RATIO
        duration = float(self.took[first : end + 1].sum())
        return bool(
            self.step[end] > self.seen
            and self.speed[end] > jump * fastest
            and self.step[end] <= MAX_CATCH_UP_RATIO * fastest * duration
        )
