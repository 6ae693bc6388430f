"""Find frames with impossible poses: the MoCap swapped markers, so the body seemed to jump."""

from typing import Annotated, Literal, TypeAlias

import numpy as np
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core import rotations
from rovsim.core.robust import LONG_STEP, STD_PER_MAD
from rovsim.core.schema import Section
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.half_turns import find_half_turned
from rovsim.measurement.signals.neighbours import Neighbours, find_far

# How far back the gate looks for a stretch to continue from; bounds the work on hopeless runs.
MAX_LOOK_BACK = 1000
# Leaving found frames out has to be worth more than this many frames, so that a frame of a burst
# that happens to be within reach is left out with the rest of the burst.
DETOUR_COST = 3.0
# The same for leaving out an end of the run, where a swap can be judged from one side only.
CUT_END_COST = 1.0
# A frame that juts out: from the line between its neighbours further than so many times the median,
# which no frame in a million is by noise, than such a share of the tolerance of a step, and so many
# times further than the frames beside it.
JUTTING_RATIO, JUTTING_SHARE, JUTTING_LEAD = 6.0, 0.5, 1.4
# From such steps on, frames are compared with their neighbours; of faster cameras the filter
# takes away what the gate lets pass.
SLOW_STEP_S = 0.04


class VelocityGate(Section):
    """Keep the longest chain of stretches that the body can travel at a plausible speed.

    Stretches are cut at every implausible step and at every dropout. Two stretches belong
    together when the second is within reach of the first. A jump that stays below `max_speed` x
    step + `tolerance` passes, and so does a lone frame between dropouts that is within reach. One
    or two good frames between a swap and the end of the run are rejected with the swap.

    A slow camera has long steps, so large jumps stay below that limit. Its frames are therefore
    also compared with a cubic through the two frames to either side. A frame is rejected if it is
    further from the cubic than a vehicle at full speed that stops dead would be (a third of a
    step), and much further than the frames nearby.

    After a loss of half a second nearly every attitude is within reach. Frames of a body that was
    found again half a turn off are therefore rejected first (`half_turns`).
    """

    kind: Literal["velocity_gate"] = "velocity_gate"
    # m/s: what small ROVs reach (3 knots, data sheets); faster vehicles need more
    max_speed: float = Field(default=1.5, gt=0)
    # rad/s: twice what a small ROV turns at in a tank
    max_rate: float = Field(default=5.0, gt=0)
    # m: five standard deviations of a step's length at 0.5 to 0.7 mm noise per axis
    tolerance: float = Field(default=0.005, ge=0)
    # rad: five standard deviations of a step's angle at 2 mrad noise per axis
    angle_tolerance: float = Field(default=0.02, ge=0)

    def rejected(self, time: Array, position: Array, attitude: Array, step: float) -> Array:
        """Find the frames to reject, among n frames in which the body was found.

        Args:
            time: (n,) s.
            position: (n, 3), NED, m.
            attitude: (n, 4), unit quaternions.
            step: usual time between frames, s.

        Returns:
            Mask (n,), True for frames to reject.
        """
        frames, count = np.arange(len(time)), -1
        while True:
            turned = find_half_turned(
                time[frames], attitude[frames], step, self.max_rate, self.angle_tolerance
            )
            frames = frames[~turned]
            if len(frames) == count:  # nothing was turned among what is plausible
                break
            frames = frames[self._plausible(time[frames], position[frames], attitude[frames], step)]
            count = len(frames)
        return ~np.isin(np.arange(len(time)), frames)

    def _plausible(self, time: Array, position: Array, attitude: Array, step: float) -> Array:
        """Mask (n,) of the frames to which the body can have moved."""
        if step < SLOW_STEP_S:
            return self._chained(time, position, attitude, step)
        frames, count = np.arange(len(time)), -1
        while len(frames) != count:
            count = len(frames)
            jumps = self._there_and_back(time[frames], position[frames], attitude[frames], step)
            frames = frames[~jumps]
            # only without jumps: one that is within reach of one side alone would break the chain
            if not jumps.any():
                frames = frames[
                    self._chained(time[frames], position[frames], attitude[frames], step)
                ]
        return np.isin(np.arange(len(time)), frames)

    def _chained(self, time: Array, position: Array, attitude: Array, step: float) -> Array:
        """Mask (n,) of the frames in the chain."""
        starts, ends = _stretches(self, time, position, attitude, step)
        mask = np.zeros(len(time), bool)
        for piece in _longest_chain(self, time, position, attitude, step, starts, ends):
            mask[starts[piece] : ends[piece] + 1] = True
        return mask

    def _there_and_back(self, time: Array, position: Array, attitude: Array, step: float) -> Array:
        """Mask (n,) of single frames of a slow camera that are far from their neighbours' cubic."""
        if len(time) < 5:
            return np.zeros(len(time), bool)
        neighbours = Neighbours.of(time, step)
        distance, angle = (
            neighbours.beside(position),
            neighbours.beside(rotations.continuous(attitude)),
        )
        angle = 4.0 * np.arcsin(np.clip(angle / 2.0, 0.0, 1.0))
        return find_far(distance, self.max_speed * neighbours.stop + self.tolerance) | find_far(
            angle, self.max_rate * neighbours.stop + self.angle_tolerance
        )


class Hampel(Section):
    """Reject frames far from the median of their neighbourhood (Hampel 1974; Pearson 2002).

    The median slope of the neighbourhood is removed first, otherwise a fast motion would hide
    outliers. A burst that fills half of the window is not seen; beside dropouts the test is less
    sensitive. It is repeated until nothing is found.
    """

    kind: Literal["hampel"] = "hampel"
    # frames to either side: outvotes bursts of up to five frames (0.05 s at 100 Hz)
    half_window: int = Field(default=7, ge=1)
    # robust standard deviations: a normal deviate passes 6 once in 5e8 frames
    threshold: float = Field(default=6.0, gt=0)
    # m, rad: lower bound of that deviation, the usual noise of a tank MoCap
    noise: float = Field(default=0.001, gt=0)
    angle_noise: float = Field(default=0.004, gt=0)

    def rejected(self, time: Array, position: Array, attitude: Array, step: float) -> Array:
        """Mask (n,) of the found frames that are far from the median of their neighbours."""
        # Rotation matrices have no sign to agree on; |R1 - R2| / sqrt(2) is the angle when small.
        rotation = rotations.matrix(attitude).reshape(len(time), 9) / np.sqrt(2.0)
        frames = np.arange(len(time))
        while len(frames) > 2:
            outliers = self._far(time[frames], position[frames], self.noise)
            outliers |= self._far(time[frames], rotation[frames], self.angle_noise)
            if not outliers.any():
                break
            frames = frames[~outliers]
        return ~np.isin(np.arange(len(time)), frames)

    def _far(self, time: Array, x: Array, noise: float) -> Array:
        """Mask (n,) of the rows of `x` (n, c) that are far from the median of their window."""
        n = len(x)
        width = min(2 * self.half_window + 1, n)
        start = np.clip(np.arange(n) - width // 2, 0, n - width)
        nearby = start[:, None] + np.arange(width)
        window, dt = x[nearby], (time[nearby] - time[:, None])[..., None]
        slope = np.median(np.diff(window, axis=1) / np.diff(dt, axis=1), axis=1)
        window = window - slope[:, None] * dt
        middle = np.median(window, axis=1)
        spread = STD_PER_MAD * np.median(np.linalg.norm(window - middle[:, None], axis=2), axis=1)
        return np.linalg.norm(x - middle, axis=1) > self.threshold * np.maximum(spread, noise)


class KeepAll(Section):
    """Reject nothing."""

    kind: Literal["none"] = "none"

    def rejected(self, time: Array, position: Array, attitude: Array, step: float) -> Array:
        """Mask (n,), all False."""
        return np.zeros(len(time), bool)


Outliers: TypeAlias = Annotated[VelocityGate | Hampel | KeepAll, Field(discriminator="kind")]


class OutlierSettings(Section):
    """Settings of how impossible poses are found."""

    outliers: Outliers = VelocityGate()


def find_outliers(recording: Recording, settings: VelocityGate | Hampel | KeepAll) -> Array:
    """Mask (n,) of the frames in which the body was found at an impossible pose.

    If these frames are removed and the search is repeated, it finds nothing more.
    """
    mask = np.zeros(len(recording.time), bool)
    frames = np.flatnonzero(recording.tracked)
    if len(frames) > 1:
        time = recording.time[frames]
        step = max(1.0 / recording.rate, float(np.median(np.diff(recording.time))))
        mask[frames] = settings.rejected(
            time, recording.position[frames], recording.attitude[frames], step
        )
    return mask


def _stretches(
    gate: VelocityGate, time: Array, position: Array, attitude: Array, step: float
) -> tuple[Array, Array]:
    """First and last index, (s,) each, of every stretch without dropout or implausible step.

    A frame that juts out is a stretch of its own: it may be within reach of one side alone, and
    would take the other side's stretch with it.
    """
    juts = _jutting(time, position, gate.tolerance)
    juts |= _jutting(time, rotations.continuous(attitude), 0.5 * gate.angle_tolerance)
    plausible = _within_reach(
        gate, np.diff(time), position[1:] - position[:-1], attitude[:-1], attitude[1:], step
    )
    alone = juts[:-1] | juts[1:]
    breaks = np.flatnonzero(~plausible | alone | (np.diff(time) > LONG_STEP * step))
    return np.concatenate([[0], breaks + 1]), np.concatenate([breaks, [len(time) - 1]])


def _jutting(time: Array, x: Array, tolerance: float) -> Array:
    """Mask (n,) of the rows of `x` (n, c) that are far from the line between their neighbours."""
    if len(x) < 3:
        return np.zeros(len(x), bool)
    share = (time[1:-1] - time[:-2]) / (time[2:] - time[:-2])
    off = np.linalg.norm(x[1:-1] - x[:-2] - share[:, None] * (x[2:] - x[:-2]), axis=1)
    limit = max(JUTTING_RATIO * float(np.median(off)), JUTTING_SHARE * tolerance)
    off = np.pad(off, 2)
    # it spoils the lines of the two beside it by half of that; where a jump begins, two are alike
    beside = np.maximum(off[:-2], off[2:])
    return np.asarray((off[1:-1] > limit) & (off[1:-1] > JUTTING_LEAD * beside))


def _within_reach(
    gate: VelocityGate, elapsed: Array, moved: Array, q0: Array, q1: Array, step: float
) -> Array:
    """Whether each move is plausible within the time that elapsed.

    Args:
        gate: the limits.
        elapsed: time of each of k moves (k,), s.
        moved: displacements (k, 3), m.
        q0: attitudes before the moves, unit quaternions (k, 4) or one for all.
        q1: attitudes after the moves, likewise.
        step: usual time between frames, s.
    """
    # Jittered stamps can be closer than a step although the exposures were not.
    elapsed = np.maximum(elapsed, step)
    angle = rotations.angle_between(q0, q1)
    plausible = np.linalg.norm(moved, axis=-1) <= gate.max_speed * elapsed + gate.tolerance
    return plausible & (angle <= gate.max_rate * elapsed + gate.angle_tolerance)


def _longest_chain(
    gate: VelocityGate,
    time: Array,
    position: Array,
    attitude: Array,
    step: float,
    starts: Array,
    ends: Array,
) -> list[int]:
    """Find the chain of stretches with the most frames, each within reach of the one before.

    Dynamic programming over the stretches: best[j] = frames of j + max over the reachable
    i < j of best[i] - `DETOUR_COST` if found frames between i and j are left out.
    Starting late and ending early cost `CUT_END_COST` each.

    Args:
        gate: the limits.
        time: (n,) s.
        position: (n, 3), m.
        attitude: (n, 4), unit quaternions.
        step: usual time between frames, s.
        starts: index (s,) of the first frame of each stretch.
        ends: index (s,) of the last frame of each stretch.

    Returns:
        Indices of the stretches in the chain, in order.
    """
    size = (ends - starts + 1).astype(float)
    best, previous = size.copy(), np.full(len(size), -1)
    best[1:] -= CUT_END_COST
    for j in range(1, len(size)):
        i = np.arange(max(0, j - MAX_LOOK_BACK), j)
        end, start = ends[i], starts[j]
        reachable = _within_reach(
            gate,
            time[start] - time[end],
            position[start] - position[end],
            attitude[end],
            attitude[start],
            step,
        )
        score = np.where(reachable, best[i] - DETOUR_COST * (i < j - 1), -np.inf)
        k = int(np.argmax(score))
        if size[j] + score[k] > best[j]:
            best[j], previous[j] = size[j] + score[k], i[k]
    cut_short = CUT_END_COST * (np.arange(len(size)) < len(size) - 1)
    chain = [int(np.argmax(best - cut_short))]
    while previous[chain[-1]] >= 0:
        chain.append(int(previous[chain[-1]]))
    return chain[::-1]
