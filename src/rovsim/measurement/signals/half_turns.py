"""Find frames in which a nearly symmetric body was found turned by half a turn."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.core.robust import LONG_STEP

# s: spans over which the turns of a run are measured. In the shortest, 4 mrad of noise per axis,
# much for a camera, makes a tenth of a radian per second; after a loss of more than the longest
# a vehicle may have turned round.
SPANS_S = (0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)
SEEN_SHARE = 0.5  # of the frames that begin a span without a loss, or that span tells too little
BRIDGED_S = 0.2  # a loss within a span is shorter: half a turn in it is a jump for the gate
USUAL_PERCENT = 99.9  # of the turns in a run; the rest may be jumps that were not cut
RATE_MARGIN = 1.5  # a loss may hide a turn that is half as fast again as those that were seen
# rad/s: a vehicle that hardly turned while it was seen may turn while it is lost
MIN_RATE = 0.5
AS_IS, UNKNOWN = 0, -1  # labels; 1, 2, 3: half a turn about body x, y, z; XOR composes two


def find_half_turned(
    time: Array, attitude: Array, step: float, max_rate: float, tolerance: float
) -> Array:
    """Find frames that are half a turn about a body axis from what most frames of a run agree on.

    Each stretch without dropout or jump is compared with the one before. If the turn between them
    is beyond what this run usually turns by in that time, and within it after half a turn about
    one axis, one of the two is turned. After a loss in which more than one of these is possible, or
    of more than a second, frames are judged by themselves: some vehicles only turn at the ends of
    a tank, where no camera sees them. Of all stretches that are linked so, most frames are right.

    Args:
        time: (n,) s.
        attitude: (n, 4), unit quaternions.
        step: usual time between frames, s.
        max_rate: fastest plausible turn from frame to frame, rad/s.
        tolerance: angle that noise may add to a turn, rad.

    Returns:
        Mask (n,), True for the frames that are half a turn off.
    """
    if len(time) < 2:
        return np.zeros(len(time), bool)
    elapsed = np.maximum(np.diff(time), step)  # jittered stamps can be closer than exposures
    jumps = rotations.angle_between(attitude[:-1], attitude[1:]) > max_rate * elapsed + tolerance
    losses = elapsed > max(BRIDGED_S, LONG_STEP * step)
    usual = _usual_rates(time, attitude, np.cumsum(np.append(False, jumps | losses)))
    starts = np.flatnonzero(np.append(True, jumps | (elapsed > LONG_STEP * step)))
    stretches = _Stretches(time, attitude, starts, np.append(starts[1:], len(time)) - 1)
    usual, at_start, at_end = (
        np.clip(RATE_MARGIN * rate, MIN_RATE, max_rate) for rate in (usual, *stretches.edge_rates())
    )
    label, part = stretches.labels(usual, at_start, at_end, step, tolerance)
    size = stretches.ends - starts + 1
    return np.repeat(_in_minority(label, part, size), size)


def _usual_rates(time: Array, attitude: Array, piece: Array) -> Array:
    """Mean rates, rad/s, that turns over each of `SPANS_S` hardly ever exceed.

    Swaying fast is not turning far, so longer spans have lower rates. A span that is hardly seen
    has the rate of the one before; the first may be infinite.

    Args:
        time: (n,) s.
        attitude: (n, 4), unit quaternions.
        piece: number (n,) of the piece without long loss or jump that a frame is in.
    """
    rates, usual = [], np.inf
    for span in SPANS_S:
        last = np.minimum(np.searchsorted(time, time + span), len(time) - 1)
        elapsed = time[last] - time
        seen = (piece[last] == piece) & (elapsed >= span)
        if np.mean(seen) >= SEEN_SHARE:
            turned = rotations.angle_between(attitude[seen], attitude[last[seen]])
            usual = min(usual, np.percentile(turned / elapsed[seen], USUAL_PERCENT))
        rates.append(usual)
    return np.array(rates)


@dataclass(frozen=True, eq=False)
class _Stretches:
    """Stretches without dropout or jump.

    Attributes:
        time: (n,) s.
        attitude: (n, 4), unit quaternions.
        starts: index (s,) of the first frame of each stretch.
        ends: index (s,) of the last frame of each stretch.
    """

    time: Array
    attitude: Array
    starts: Array
    ends: Array

    def edge_rates(self) -> tuple[Array, Array]:
        """Rates (s,), rad/s, at the start and the end of each stretch; infinite if it is short."""
        span = SPANS_S[0]
        after = np.searchsorted(self.time, self.time[self.starts] + span)
        before = np.searchsorted(self.time, self.time[self.ends] - span, side="right") - 1
        return self._rates(self.starts, after), self._rates(before, self.ends)

    def _rates(self, first: Array, last: Array) -> Array:
        """Mean rates (s,) between frames of a stretch; infinite where these are not both in it."""
        inside = (first >= self.starts) & (last <= self.ends)
        rates = np.full(len(inside), np.inf)
        first, last = first[inside], last[inside]
        turned = rotations.angle_between(self.attitude[first], self.attitude[last])
        rates[inside] = turned / (self.time[last] - self.time[first])
        return rates

    def labels(
        self, usual: Array, at_start: Array, at_end: Array, step: float, tolerance: float
    ) -> tuple[Array, Array]:
        """Tell by which half turn each stretch differs from the first one of its part of the run.

        A body that turns far while it is lost has turned as far elsewhere, or turns already when
        it is lost or still when it is found. A stretch that no half turn brings within reach is
        a swap, and stays out of comparisons.

        Args:
            usual: largest mean rate over each of `SPANS_S`, rad/s.
            at_start: mean rate (s,) over a loss that ends with this stretch, rad/s.
            at_end: mean rate (s,) over a loss that begins with the end of this stretch, rad/s.
            step: usual time between frames, s.
            tolerance: angle that noise may add to a turn, rad.

        Returns:
            Labels (s,), and the number (s,) of the part within which they are comparable.
        """
        start, end = self.attitude[self.starts], self.attitude[self.ends]
        turned = rotations.multiply(end[:, None], np.eye(4))  # as it is, and by each half turn
        label, part = np.full(len(start), UNKNOWN), np.zeros(len(start), int)
        label[0], last = AS_IS, 0
        for j in range(1, len(start)):
            elapsed = max(self.time[self.starts[j]] - self.time[self.ends[last]], step)
            reach = np.inf
            if elapsed <= SPANS_S[-1]:
                span = np.searchsorted(SPANS_S[1:], elapsed)
                rate = max(usual[span], at_end[last], at_start[j])
                reach = min(rate, usual[0]) * elapsed + tolerance
            possible = np.flatnonzero(rotations.angle_between(turned[last], start[j]) <= reach)
            if len(possible):
                sure = len(possible) == 1
                label[j] = label[last] ^ possible[0] if sure else AS_IS
                part[j] = part[last] + (not sure)
                last = j
        return label, part


def _in_minority(label: Array, part: Array, size: Array) -> Array:
    """Mask (s,) of the stretches with another label than most frames of their part."""
    frames = np.zeros((part.max() + 1, 4), int)
    known = label != UNKNOWN
    np.add.at(frames, (part[known], label[known]), size[known])
    return known & (frames[part, label] < frames.max(axis=1)[part])
