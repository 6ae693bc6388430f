"""Runs that stand in one file, one after the other: what lies between long pauses."""

from dataclasses import dataclass
from math import ceil, floor
from typing import Iterator

import numpy as np

from rovsim.intake.facts import Facts
from rovsim.measurement.recording.exports import Export

PAUSE = 30.0  # s without the body: within a run, cameras lose it for less
SHORT = 10.0  # s: what lasts less between two pauses is no run


@dataclass(frozen=True)
class Entry:
    """A run of campaign.yaml: the number of its file, its id, and which span of it, in s.

    `use` None: all of it; `pause` s that went before.
    """

    file: int
    id: str
    use: tuple[float, float] | None = None
    pause: float = 0.0


def list_entries(facts: Facts) -> list[Entry]:
    """All runs, in the order of their files."""
    files = enumerate(zip(facts.ids, facts.pairs, strict=True))
    return [entry for k, (name, one) in files for entry in _split(k, name, one.motion.track.export)]


def find_spans(export: Export) -> list[tuple[float, float]]:
    """First and last time, s, of each run of a file; none where nothing parts it."""
    time = export.time[export.found] if export.found.any() else export.time
    last = np.flatnonzero(np.diff(time) > PAUSE)
    begins, ends = time[np.append(0, last + 1)], time[np.append(last, len(time) - 1)]
    long = ends - begins >= SHORT
    if len(last) == 0 or long.sum() < 2:
        return []
    return list(zip(begins[long].tolist(), ends[long].tolist(), strict=True))


def _split(k: int, name: str, export: Export) -> Iterator[Entry]:
    spans = find_spans(export)
    if not spans:
        yield Entry(k, name)
        return
    before = spans[0][0]
    for number, (begin, end) in enumerate(spans, start=1):
        use = floor(1e3 * begin) / 1e3, ceil(1e3 * end) / 1e3
        yield Entry(k, f"{name}-{number}", use, begin - before)
        before = end
