"""Split a file at long pauses into several runs, one after the other."""

from dataclasses import dataclass
from math import ceil, floor
from typing import Iterator

import numpy as np

from rovsim.intake.facts import Facts
from rovsim.measurement.recording.exports import Export

MIN_PAUSE_S = 30.0  # without the body: within a run, cameras lose it for less
MIN_RUN_S = 10.0  # what lasts less between two pauses is no run


@dataclass(frozen=True)
class RunEntry:
    """A run as campaign.yaml will list it.

    Attributes:
        file: position of its motion among the motions.
        id: of the run.
        use: first and last time in s of the part that is used, on the file's clock; None: all.
        pause: s without the body before it, 0 for the first run of a file.
    """

    file: int
    id: str
    use: tuple[float, float] | None = None
    pause: float = 0.0


def list_run_entries(facts: Facts) -> list[RunEntry]:
    """List all runs, in the order of their files."""
    files = enumerate(zip(facts.ids, facts.pairs, strict=True))
    return [
        entry for k, (name, pair) in files for entry in _split(k, name, pair.motion.track.export)
    ]


def find_run_spans(export: Export) -> list[tuple[float, float]]:
    """Find the first and last time in s of each run in a file; none where it is one run."""
    time = export.time[export.tracked] if export.tracked.any() else export.time
    pauses = np.flatnonzero(np.diff(time) > MIN_PAUSE_S)
    begins, ends = time[np.append(0, pauses + 1)], time[np.append(pauses, len(time) - 1)]
    long = ends - begins >= MIN_RUN_S
    if len(pauses) == 0 or long.sum() < 2:
        return []
    return list(zip(begins[long].tolist(), ends[long].tolist(), strict=True))


def _split(k: int, name: str, export: Export) -> Iterator[RunEntry]:
    spans = find_run_spans(export)
    if not spans:
        yield RunEntry(k, name)
        return
    previous_end = spans[0][0]
    for number, (begin, end) in enumerate(spans, start=1):
        use = floor(1e3 * begin) / 1e3, ceil(1e3 * end) / 1e3
        yield RunEntry(k, f"{name}-{number}", use, begin - previous_end)
        previous_end = end
