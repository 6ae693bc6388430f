"""Find runs whose beginning or end leaves far more than the rest of them.

A recording may begin before a vehicle is let go, and end after it was lifted out. No model says how
hands move it. Where it stands still, `standstills` tells; where it moves, an answer leaves there
what it leaves nowhere else. Ends are only told if they hold most of what is left in all runs.
"""

from typing import Iterator, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rounding import rounded
from rovsim.diagnosis.structure.residual import split_by_run
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.results.diagnosis import DisturbedEnd

BLOCK_SECONDS = 1.0  # over which the power of innovations is averaged: 20 readings of six axes
MIN_BLOCKS = 2  # of an end
MAX_SHARE_OF_RUN = 0.4  # what is longer is no end
MIN_RATIO = 2.0  # to the usual power; turbulence is up to 1.3 times as strong for a while
MIN_SHARE_OF_EXCESS = 0.8  # of what is above the usual power in all runs


class _Power(NamedTuple):
    """Mean power of the white innovations of a run in each of its blocks.

    Attributes:
        run: the run, or a part of it.
        begins: of the blocks (b,), s since the first step.
        power: (b,); 1 for what a right model leaves.
    """

    run: ObservedRun
    begins: Array
    power: Array

    @staticmethod
    def of(run: ObservedRun, white: Array) -> "_Power":
        """Average innovations (6, n) of a run."""
        time, read = run.time[run.settled], run.innovation_mask[run.settled].T
        block, member = np.unique(np.floor(time / BLOCK_SECONDS), return_inverse=True)
        energy, count = (
            np.bincount(member, x.sum(axis=0)) for x in (np.square(white) * read, read * 1.0)
        )
        known = count > 0.0
        return _Power(run, BLOCK_SECONDS * block[known], energy[known] / count[known])


def find_disturbed_ends(fit: Fit, bank: FilterBank) -> tuple[DisturbedEnd, ...]:
    """Ends of runs that hold most of what a fit leaves; the first and the last of each run.

    Args:
        fit: to all runs.
        bank: that it was fitted with.
    """
    white = bank.whiten(fit.linearised.e, fit.noise)
    parts = split_by_run(white, bank.runs)
    each = (_Power.of(*pair) for pair in zip(bank.runs, parts, strict=True))
    powers = [one for one in each if len(one.power)]
    if not powers:
        return ()
    usual = float(np.median(np.concatenate([one.power for one in powers])))
    ends, inside, total = [], 0.0, 0.0
    for one in powers:
        excess = np.where(one.power > MIN_RATIO * usual, one.power - usual, 0.0)
        total += float(excess.sum())
        for at in _find_ends(one, usual):
            inside += float(excess[at].sum())
            ends.append(_describe(one, at, usual))
    return tuple(ends) if inside > MIN_SHARE_OF_EXCESS * total else ()


def _find_ends(one: _Power, usual: float) -> Iterator[slice]:
    """Blocks of the beginning and of the end of a run that are far above the usual power."""
    commands, blocks = one.run.motion.commands, len(one.power)
    for whole, power, place in (
        (commands.before == 0.0, one.power, lambda k: slice(0, k)),
        (commands.after == 0.0, one.power[::-1], lambda k: slice(blocks - k, blocks)),
    ):
        count = _split(power) if whole else 0
        if count and np.mean(power[:count]) > MIN_RATIO * usual:
            yield place(count)


def _split(power: Array) -> int:
    """Number of first blocks whose power differs most from that of the rest; 0 if there are few.

    The likeliest change of a variance.
    """
    counts = np.arange(MIN_BLOCKS, int(MAX_SHARE_OF_RUN * len(power)) + 1)
    if not len(counts):
        return 0
    sums = np.cumsum(power)
    rest = len(power) - counts
    cost = counts * np.log(sums[counts - 1] / counts)
    cost += rest * np.log((sums[-1] - sums[counts - 1]) / rest)
    return int(counts[np.argmin(cost)])


def _describe(one: _Power, at: slice, usual: float) -> DisturbedEnd:
    """Report an end in the times of the recording."""
    run, motion = one.run, one.run.motion
    first = at.start == 0
    border = float(one.begins[at.stop if first else at.start] + run.edges[0])
    begin, end = (motion.time[0], border) if first else (border, motion.end)
    return DisturbedEnd(
        run=motion.run.id,
        from_s=round(float(begin), 2),
        to_s=round(float(end), 2),
        times=rounded(float(np.mean(one.power[at])) / usual),
    )
