"""Extend windows of a replay on both sides, so that the filter has no edge at their ends.

The measurement was filtered one usable stretch at a time. If the simulated motion in a window were
filtered by itself, it would have two edges where the measurement has none, and even a perfect model
would show errors there. So the measured motion is put before the window, and the model is simulated
beyond its end, as far as the filter reaches or the stretch goes.
"""

from collections import defaultdict
from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.signals.chain import SignalSettings, filter_and_differentiate
from rovsim.measurement.signals.clock import find_stretches, time_step
from rovsim.measurement.signals.motion import Motion

MAX_STACK_SAMPLES = 1 << 16  # filters take some twenty times its room


@dataclass(frozen=True)
class PaddedWindow:
    """A window of a replay, and by how much it is extended.

    Attributes:
        before: number of samples by which it is extended at its beginning.
        after: number of samples by which it is extended at its end.
        first: sample at which the window itself begins.
        last: sample at which the window itself ends.
    """

    before: int
    after: int
    first: int
    last: int


def pad_windows(motion: Motion, spans: Sequence[tuple[int, int]], reach: int) -> list[PaddedWindow]:
    """Extend windows of a sampled run within their usable stretches.

    Args:
        motion: the run, on a uniform clock.
        spans: first and last sample of each window.
        reach: number of samples by which a window is extended on either side at most.
    """
    stretches = find_stretches(np.isfinite(motion.nu).all(axis=1))
    windows = []
    for a, b in spans:
        start, end = next(((s, e) for s, e in stretches if s <= a < e), (a, b + 1))
        before, after = min(reach, a - start), max(min(reach, end - 1 - b), 0)
        windows.append(PaddedWindow(before, after, a, b))
    return windows


def differentiate_windows(
    paths: Sequence[Array],
    windows: Sequence[PaddedWindow],
    motions: Sequence[Motion],
    signals: SignalSettings,
) -> list[Array]:
    """Filter and differentiate the simulated poses of windows.

    Args:
        paths: for each window the poses (n, 7) that the motion capture would report, from the
            first sample of the window to the last one of its extension: position m NED, and
            quaternion body to world.
        windows: for each path its window.
        motions: for each path the measured motion; all have the same clock.
        signals: filter and derivative of the measurement.

    Returns:
        For each path velocity and acceleration (2, n, 6) in body axes, m/s, rad/s and m/s2, rad/s2.
        Infinite from where the path diverged; throughout, if that was within its window.
    """
    derivatives = [np.full((2, len(path), 6), np.inf) for path in paths]
    period = time_step(motions[0].time) if motions else 0.0
    by_length = defaultdict(list)  # a filter takes stacks of one length
    for k, (path, window) in enumerate(zip(paths, windows, strict=True)):
        by_length[window.before, _count_finite(path, window)].append(k)
    for (before, count), members in by_length.items():
        if not count:
            continue
        batch_size = max(1, MAX_STACK_SAMPLES // (before + count))
        for batch in (members[k : k + batch_size] for k in range(0, len(members), batch_size)):
            measured = [motions[k].eta[windows[k].first - before : windows[k].first] for k in batch]
            padded = np.stack(
                [np.vstack([p, paths[k][:count]]) for p, k in zip(measured, batch, strict=True)]
            )
            filtered = np.stack(filter_and_differentiate(padded, period, signals))
            for i, k in enumerate(batch):
                derivatives[k][:, :count] = filtered[:, i, before:]
    return derivatives


def _count_finite(path: Array, window: PaddedWindow) -> int:
    """Number of samples until a path diverges; 0 if it diverges inside its window."""
    finite = np.isfinite(path).all(axis=1)
    count = len(path) if finite.all() else int(np.argmin(finite))
    return count if count > window.last - window.first else 0
