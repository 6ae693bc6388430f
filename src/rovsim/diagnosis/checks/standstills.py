"""Find stretches in which the vehicle stands still although the model would move.

A vehicle may be held by hand before it is let go, lie on the floor or hang on the crane. No effect
of a model describes that, and a fit would be distorted by it. A wrong model errs as much while the
vehicle moves; in that case no standstill is reported.
"""

from dataclasses import dataclass, replace
from typing import Iterable, Iterator, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.rounding import rounded
from rovsim.measurement.quality.excitation import MIN_SPREAD
from rovsim.measurement.signals.clock import find_stretches
from rovsim.measurement.signals.measured import find_measured
from rovsim.measurement.signals.motion import Motion
from rovsim.results.diagnosis import Standstill
from rovsim.simulation.samples import Samples

MAX_REST_SPEED = 0.5 * MIN_SPREAD  # m/s, rad/s: slower than any axis that counts as moved
MIN_REST_SECONDS = 1.0  # s; a vehicle that reverses its motion stands still for less
MIN_SPEED_GAIN = 3.0 * MIN_SPREAD  # m/s, rad/s that the model would gain: far more than noise
# s over which errors are averaged while vehicles move; a standstill is compared with its length.
BLOCK_SECONDS = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
MIN_BLOCKS = 10  # blocks of a length; if there are fewer, shorter blocks are used
USUAL_PERCENTILE = 95.0  # percentile of the model's error while the vehicle moves
MIN_ERROR_RATIO = 3.0  # times that percentile: a standstill has a larger error
# Vehicles follow the model if, where its acceleration is more than MIN_ACCELERATION_SHARE of that
# at the standstill, the median error is less than MAX_ERROR_SHARE of it.
MIN_ACCELERATION_SHARE, MAX_ERROR_SHARE = 0.5, 0.75
MIN_ACCELERATED_SECONDS = 0.2  # s in all for which the model accelerates so much, at least
MIN_TYPICAL_ERROR = 1e-9  # m/s2, rad/s2: keeps ratios finite where a model has no error

Spans = list[tuple[float, float]]


@dataclass(frozen=True, eq=False)
class _Rest:
    """A stretch in which the vehicle does not move.

    Attributes:
        begin: s.
        end: s.
        missed: mean error of the model's acceleration (6,), a_real - a_sim, m/s2 and rad/s2.
    """

    begin: float
    end: float
    missed: Array


class _Moving(NamedTuple):
    """Accelerations and errors of a model at n samples at which vehicles move, m/s2 and rad/s2.

    Attributes:
        a_sim: acceleration (n, 6) of the model.
        a_res: its error (n, 6), a_real - a_sim.
        step: duration (n,) of each sample, s.
        blocks: means of the error (b, 6) over b blocks, of every length in `BLOCK_SECONDS`.
        length: of each block (b,), s.
    """

    a_sim: Array
    a_res: Array
    step: Array
    blocks: Array
    length: Array

    def usual(self, lasts: float) -> Array:
        """Usual upper limit (6,) of the error's mean over blocks, the longest up to `lasts` s.

        Infinite where there are no blocks.
        """
        fits = [x for x in BLOCK_SECONDS if x <= lasts and np.sum(self.length == x) >= MIN_BLOCKS]
        blocks = self.blocks[self.length == max(fits, default=BLOCK_SECONDS[0])]
        return (
            np.percentile(np.abs(blocks), USUAL_PERCENTILE, axis=0)
            if len(blocks)
            else np.full(6, np.inf)
        )

    def followed(self, axis: int, size: float) -> bool:
        """Whether vehicles follow the model where it accelerates by about `size` on an axis."""
        sim, res = np.abs(self.a_sim[:, axis]), np.abs(self.a_res[:, axis])
        large = sim > MIN_ACCELERATION_SHARE * size
        return self.step[large].sum() > MIN_ACCELERATED_SECONDS and bool(
            np.median(res[large] / sim[large]) < MAX_ERROR_SHARE
        )


def find_standstills(runs: Iterable[tuple[Motion, Samples]]) -> tuple[Standstill, ...]:
    """Find the longest stretch of each run in which it stands still although the model would move.

    Args:
        runs: motions, and the model's accelerations and errors at their states. Only one run is
            held in memory at a time.
    """
    rests: dict[str, tuple[list[_Rest], Spans]] = {}
    moving_parts: list[_Moving] = []
    for motion, samples in runs:
        axes = find_measured(motion.measured)
        at_rest = (np.abs(samples.nu) < MAX_REST_SPEED)[:, axes].all(axis=1)
        run_rests = list(_list_rests(motion, samples, at_rest))
        rests[motion.run.id] = run_rests, _list_spans(motion)
        moving_parts.append(_find_moving(motion, samples, ~at_rest))
    if not moving_parts:
        return ()
    moving = _Moving(*(np.concatenate(arrays) for arrays in zip(*moving_parts, strict=True)))
    candidates = (
        _judge(run, run_rests, spans, moving) for run, (run_rests, spans) in rests.items()
    )
    return tuple(s for s in candidates if s is not None)


def _list_rests(motion: Motion, samples: Samples, still: Array) -> Iterator[_Rest]:
    """Yield the stretches of a mask of still samples (n,) that last long enough."""
    axes, time = find_measured(motion.measured), motion.time[samples.index]
    for a, b in find_stretches(still):
        begin, end = float(time[a]), float(time[b - 1])
        if end - begin >= MIN_REST_SECONDS:
            yield _Rest(begin, end, samples.a_res[a:b].mean(axis=0) * axes)


def _find_moving(motion: Motion, samples: Samples, which: Array) -> _Moving:
    """Collect the samples of a mask (n,), and average the errors over blocks of each length."""
    time = motion.time[samples.index]
    step = np.diff(time, append=time[-1:])
    step = np.minimum(step, np.median(step)) if len(step) else step  # not across gaps
    parts = [
        (samples.a_res[index].mean(axis=0), length)
        for a, b in find_stretches(which)
        for length in BLOCK_SECONDS
        if length == BLOCK_SECONDS[0] or time[b - 1] - time[a] >= length
        for index in np.array_split(np.arange(a, b), max(1, int((time[b - 1] - time[a]) / length)))
    ]
    blocks = np.array([block for block, _ in parts]).reshape(-1, len(AXES))
    length = np.array([length for _, length in parts])
    return _Moving(samples.a_sim[which], samples.a_res[which], step[which], blocks, length)


def _judge(run: str, rests: Sequence[_Rest], spans: Spans, moving: _Moving) -> Standstill | None:
    """Judge the rests of one run.

    Rests that are closer to each other than the longer of them lasts are one.

    Args:
        run: id of the run.
        rests: its stretches without motion.
        spans: begin and end of what can be used of it, s.
        moving: what the model does while vehicles move, in all runs.

    Returns:
        The longest standstill; None where none of the rests is one.
    """
    candidates: list[tuple[_Rest, int, float]] = []
    for rest in rests:
        if (axis := _find_axis(rest, moving)) is None:
            continue
        gain, previous = float(abs(rest.missed[axis]) * (rest.end - rest.begin)), candidates[-1:]
        for earlier, _, earlier_gain in previous:
            if rest.begin - earlier.end < max(earlier.end - earlier.begin, rest.end - rest.begin):
                rest, gain = replace(rest, begin=earlier.begin), gain + earlier_gain
                candidates.pop()
        candidates.append((rest, axis, gain))
    if not candidates:
        return None
    rest, axis, gain = max(candidates, key=lambda c: c[0].end - c[0].begin)
    return Standstill(
        run=run,
        from_s=round(rest.begin, 2),
        to_s=round(rest.end, 2),
        axis=AXES[axis],
        gained=rounded(gain, 3),
        use=tuple(_remove_span(spans, rest.begin, rest.end)),
    )


def _find_axis(rest: _Rest, moving: _Moving) -> int | None:
    """Index of the axis on which the model errs far more than elsewhere; None where there is none.

    The model must gain speed there, and vehicles must follow it elsewhere.
    """
    error, duration = np.abs(rest.missed), rest.end - rest.begin
    typical = np.maximum(moving.usual(duration), MIN_TYPICAL_ERROR)
    ratio = np.where(error * duration > MIN_SPEED_GAIN, error / typical, 0.0)
    axis = int(np.argmax(ratio))
    significant = ratio[axis] > MIN_ERROR_RATIO and moving.followed(axis, float(error[axis]))
    return axis if significant else None


def _list_spans(motion: Motion) -> Spans:
    """Begin and end of each stretch of a run that can be used, s; short gaps are ignored."""
    spans: Spans = []
    for a, b in motion.segments():
        begin, end = float(motion.time[a]), float(motion.time[b - 1])
        if spans and begin - spans[-1][1] < MIN_REST_SECONDS:
            begin = spans.pop()[0]
        spans.append((begin, end))
    return spans


def _remove_span(spans: Spans, begin: float, end: float) -> Spans:
    """Take the stretch from `begin` to `end` out of spans, s; short remains are left out."""
    parts = [x for a, b in spans for x in ((a, min(b, begin)), (max(a, end), b))]
    return [(round(a, 2), round(b, 2)) for a, b in parts if b - a >= MIN_REST_SECONDS]
