"""Stretches in which the vehicle stands still although the model would move.

Held by hand before it is let go, lying on the floor, hanging on the crane: no model describes it,
and whoever fits one to it fits the hand. A wrong model errs as much while the vehicle moves, and
then nothing is said.
"""

from dataclasses import dataclass, replace
from typing import Iterable, Iterator, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.measurement.quality import EXCITED
from rovsim.measurement.signals.clock import find_stretches
from rovsim.measurement.signals.measured import find_measured
from rovsim.measurement.signals.motion import Motion
from rovsim.results.diagnosis import Standstill
from rovsim.simulation.samples import Samples

STILL = 0.5 * EXCITED  # m/s, rad/s: slower than any axis that counts as moved
SHORTEST = 1.0  # s; a vehicle that turns back stands still for less
GAINED = 3.0 * EXCITED  # m/s, rad/s that the model would gain: far more than noise
BLOCKS = (
    0.5,
    1.0,
    2.0,
    4.0,
    8.0,
    16.0,
)  # s over which accelerations are averaged, as long as a standstill
MIN_BLOCKS = 10  # blocks of a length
USUAL = 95.0  # percentile of what the model misses while the vehicle moves
BEYOND = 3.0  # times that it misses where the vehicle stands
# Share of what it does there that it does elsewhere; it then misses at most that share of it.
SHOWN, FOLLOWED = 0.5, 0.75
LONG = 0.2  # s in all for which it does
TINY = 1e-9  # m/s, rad/s: keeps ratios finite where a model misses nothing

Spans = list[tuple[float, float]]


@dataclass(frozen=True, eq=False)
class _Rest:
    """A stretch in which nothing moves, s; means (6,) of what the model misses there."""

    begin: float
    end: float
    missed: Array


class _Moving(NamedTuple):
    """What a model does and misses (n, 6) while vehicles move, and how long (n,) s each holds.

    `blocks` (b, 6): means of what it misses over `length` (b,) s.
    """

    a_sim: Array
    a_res: Array
    step: Array
    blocks: Array
    length: Array

    def usual(self, lasts: float) -> Array:
        """What it misses at most, usually, (6,) over blocks of up to that many s."""
        fits = [x for x in BLOCKS if x <= lasts and np.sum(self.length == x) >= MIN_BLOCKS]
        own = self.blocks[self.length == max(fits, default=BLOCKS[0])]
        return np.percentile(np.abs(own), USUAL, axis=0) if len(own) else np.full(6, np.inf)

    def followed(self, axis: int, size: float) -> bool:
        """Whether vehicles followed a model that accelerates about as much on an axis."""
        sim, res = np.abs(self.a_sim[:, axis]), np.abs(self.a_res[:, axis])
        large = sim > SHOWN * size
        return self.step[large].sum() > LONG and bool(np.median(res[large] / sim[large]) < FOLLOWED)


def find_standstills(runs: Iterable[tuple[Motion, Samples]]) -> tuple[Standstill, ...]:
    """The longest stretch of each run in which it stands although the model would move.

    Args:
        runs: motions, and what the model does and misses at their states; one is held at a time.
    """
    rests: dict[str, tuple[list[_Rest], Spans]] = {}
    each: list[_Moving] = []
    for motion, samples in runs:
        measured = find_measured(motion.measured)
        still = (np.abs(samples.nu) < STILL)[:, measured].all(axis=1)
        own = list(_list_rests(motion, samples, still))
        rests[motion.run.id] = own, _list_spans(motion)
        each.append(_find_moving(motion, samples, ~still))
    if not each:
        return ()
    moving = _Moving(*(np.concatenate(arrays) for arrays in zip(*each, strict=True)))
    found = (_judge(run, own, spans, moving) for run, (own, spans) in rests.items())
    return tuple(one for one in found if one is not None)


def _list_rests(motion: Motion, samples: Samples, still: Array) -> Iterator[_Rest]:
    measured, time = find_measured(motion.measured), motion.time[samples.index]
    for a, b in find_stretches(still):
        begin, end = float(time[a]), float(time[b - 1])
        if end - begin >= SHORTEST:
            yield _Rest(begin, end, samples.a_res[a:b].mean(axis=0) * measured)


def _find_moving(motion: Motion, samples: Samples, which: Array) -> _Moving:
    time = motion.time[samples.index]
    step = np.diff(time, append=time[-1:])
    step = np.minimum(step, np.median(step)) if len(step) else step  # not across gaps
    parts = [
        (samples.a_res[part].mean(axis=0), length)
        for a, b in find_stretches(which)
        for length in BLOCKS
        if length == BLOCKS[0] or time[b - 1] - time[a] >= length
        for part in np.array_split(np.arange(a, b), max(1, int((time[b - 1] - time[a]) / length)))
    ]
    blocks = np.array([block for block, _ in parts]).reshape(-1, len(AXES))
    length = np.array([length for _, length in parts])
    return _Moving(samples.a_sim[which], samples.a_res[which], step[which], blocks, length)


def _judge(run: str, rests: Sequence[_Rest], spans: Spans, moving: _Moving) -> Standstill | None:
    """The longest standstill of a run; those near each other are one."""
    candidates: list[tuple[_Rest, int, float]] = []
    for rest in rests:
        if (axis := _find_axis(rest, moving)) is None:
            continue
        gained, last = float(abs(rest.missed[axis]) * (rest.end - rest.begin)), candidates[-1:]
        for before, _, more in last:
            if rest.begin - before.end < max(before.end - before.begin, rest.end - rest.begin):
                rest, gained = replace(rest, begin=before.begin), gained + more
                candidates.pop()
        candidates.append((rest, axis, gained))
    if not candidates:
        return None
    rest, axis, gained = max(candidates, key=lambda one: one[0].end - one[0].begin)
    return Standstill(
        run=run,
        from_s=round(rest.begin, 2),
        to_s=round(rest.end, 2),
        axis=AXES[axis],
        gained=float(f"{gained:.3g}"),
        use=tuple(_without(spans, rest.begin, rest.end)),
    )


def _find_axis(rest: _Rest, moving: _Moving) -> int | None:
    """The axis on which the model fails far more than elsewhere; None where it does on none."""
    missed, lasts = np.abs(rest.missed), rest.end - rest.begin
    usual = np.maximum(moving.usual(lasts), TINY)
    beyond = np.where(missed * lasts > GAINED, missed / usual, 0.0)
    axis = int(np.argmax(beyond))
    told = beyond[axis] > BEYOND and moving.followed(axis, float(missed[axis]))
    return axis if told else None


def _list_spans(motion: Motion) -> Spans:
    """What of a run can be used, s; gaps that are bridged do not count."""
    spans: Spans = []
    for a, b in motion.segments():
        first, last = float(motion.time[a]), float(motion.time[b - 1])
        if spans and first - spans[-1][1] < SHORTEST:
            first = spans.pop()[0]
        spans.append((first, last))
    return spans


def _without(spans: Spans, begin: float, end: float) -> Spans:
    """Spans without a stretch of them."""
    parts = [x for a, b in spans for x in ((a, min(b, begin)), (max(a, end), b))]
    return [(round(a, 2), round(b, 2)) for a, b in parts if b - a >= SHORTEST]
