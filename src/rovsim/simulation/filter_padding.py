"""Windows of a replay in their neighbourhood, so that a filter finds no edge at theirs.

The measurement went through its filter a stretch at a time. A window's motion that is filtered by
itself has two edges where the measurement has none: a perfect model would err there. So the motion
that was measured comes before it, and after it the model runs on, up to the ends of the stretch.
"""

from collections import defaultdict
from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.signals.chain import SignalSettings, velocities
from rovsim.measurement.signals.clock import find_stretches, time_step
from rovsim.measurement.signals.motion import Motion

AT_ONCE = 1 << 16  # samples in a stack: filters take some twenty times its room


@dataclass(frozen=True)
class Embedded:
    """A window from sample `first` to `last`, with so many samples `before` and `after` it."""

    before: int
    after: int
    first: int
    last: int


def embed(motion: Motion, spans: Sequence[tuple[int, int]], reach: int) -> list[Embedded]:
    """Windows of a sampled run with up to `reach` samples of their stretch on either side."""
    stretches = find_stretches(np.isfinite(motion.nu).all(axis=1))
    found = []
    for a, b in spans:
        begin, end = next(((s, e) for s, e in stretches if s <= a < e), (a, b + 1))
        before, after = min(reach, a - begin), max(min(reach, end - 1 - b), 0)
        found.append(Embedded(before, after, a, b))
    return found


def derive(
    paths: Sequence[Array],
    windows: Sequence[Embedded],
    motions: Sequence[Motion],
    signals: SignalSettings,
) -> list[Array]:
    """Velocity and acceleration (2, n, 6) of each path, infinite where a window's motion diverged.

    Args:
        paths: poses (n, 7) as reported, from the first sample of a window to the last after it.
        windows: where they lie.
        motions: as measured, of one clock.
        signals: filter and derivative of the measurement.
    """
    found = [np.full((2, len(path), 6), np.inf) for path in paths]
    period = time_step(motions[0].time) if motions else 0.0
    alike = defaultdict(list)  # a filter takes stacks of one length
    for k, (path, window) in enumerate(zip(paths, windows, strict=True)):
        alike[window.before, _count_finite(path, window)].append(k)
    for (before, count), members in alike.items():
        if not count:
            continue
        most = max(1, AT_ONCE // (before + count))
        for some in (members[k : k + most] for k in range(0, len(members), most)):
            past = [motions[k].eta[windows[k].first - before : windows[k].first] for k in some]
            whole = np.stack(
                [np.vstack([p, paths[k][:count]]) for p, k in zip(past, some, strict=True)]
            )
            both = np.stack(velocities(whole, period, signals))
            for i, k in enumerate(some):
                found[k][:, :count] = both[:, i, before:]
    return found


def _count_finite(path: Array, window: Embedded) -> int:
    """Samples until a path leaves the finite numbers; 0 if that is inside its window."""
    finite = np.isfinite(path).all(axis=1)
    count = len(path) if finite.all() else int(np.argmin(finite))
    return count if count > window.last - window.first else 0
