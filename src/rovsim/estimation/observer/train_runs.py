"""The train runs as the observer sees them: all of them, or the parts that tell most.

A diagnosis holds what every candidate would change of every reading; beyond ten minutes that takes
more memory than a job should have, and tells little more. Of longer campaigns those parts of about
a minute are looked at that together leave least open (D-optimal; Fedorov 1972, chosen one after the
other) about forces linear in velocity, its square, acceleration, attitude, place, commands and time
in the run. Which runs they come from does not matter.
"""

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Iterator, Mapping, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.bounded_cache import Recent
from rovsim.core.rotations import unrotate
from rovsim.dynamics.catalogue import Catalogue
from rovsim.estimation.observer.observed_run import ObservedRun, prepare_run
from rovsim.estimation.observer.steps import GROUP_SECONDS, choose_group_seconds
from rovsim.estimation.settings import MAX_TRAIN_SECONDS
from rovsim.measurement.quality.unlogged_commands import MEMORY_SECONDS, keep_logged
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.motion import Motion, Poses
from rovsim.results.diagnosis import LookedAt
from rovsim.simulation.settings import ReplaySettings

DRIVE_CACHE_BYTES = 1 << 29  # of all runs together: fifty of each in four minutes of runs
PART_SECONDS = 60.0  # a fifth of it is kept apart for validation, which takes windows of 2 s
LEAD_SECONDS = 10.0 * MEMORY_SECONDS  # of commands before a part
SAMPLE_STEP_SECONDS = 0.2  # of the samples that parts are compared by: half a period of 2.5 Hz
MIN_INFORMATION_SHARE = 1e-6  # of what all parts tell: a direction that hardly any of them shows


@dataclass(frozen=True, eq=False)
class TrainRuns:
    """Train runs, or parts of them, of `seconds` in all; those of the campaign last `of` s.

    `unlogged`: by run id, how many s are not used as nobody knows what was commanded.
    """

    runs: tuple[ObservedRun, ...]
    seconds: float
    of: float
    unlogged: Mapping[str, float] = field(default_factory=dict)

    @property
    def looked_at(self) -> LookedAt:
        """How much of the campaign that is: standard deviations fall with the root of the time."""
        widening = np.sqrt(self.of / self.seconds) if self.seconds else 1.0
        return LookedAt(
            seconds=round(self.seconds, 1), of=round(self.of, 1), wider=round(float(widening), 2)
        )


class _Part(NamedTuple):
    """Samples of a run, how many s they last, and the squares (k, k) of what acted in them."""

    run: str
    at: slice
    lasts: float
    squares: Array


def prepare_train(
    runs: Runs,
    settings: ReplaySettings,
    catalogue: Catalogue,
    free: Array,
    most: float = MAX_TRAIN_SECONDS,
) -> TrainRuns:
    """Train runs of up to `most` s as the observer sees them; see `prepare_run`.

    Of motion so fast that readings must be shorter there may be as many readings, and not more.
    """
    parts: list[_Part] = []
    group_seconds = GROUP_SECONDS
    unlogged: dict[str, float] = {}
    for name in runs.of("train"):  # one by one: memory may not hold all motions
        motion = runs.motions[name]
        logged = keep_logged(motion)
        parts += _divide(logged)
        group_seconds = min(group_seconds, choose_group_seconds(logged))
        if logged is not motion:
            samples = int(np.sum(motion.usable & ~logged.usable))
            unlogged[name] = samples * time_step(motion.time)
    total = sum(part.lasts for part in parts)
    most *= group_seconds / GROUP_SECONDS
    places = [(name, slice(None)) for name in runs.of("train")]
    if total > most:
        parts = _choose(parts, most)
        places = [(part.run, part.at) for part in parts]
    drives: Recent = Recent(DRIVE_CACHE_BYTES)
    observed = [
        _prepare(runs, *place, settings, catalogue, free, drives, group_seconds) for place in places
    ]
    return TrainRuns(tuple(observed), sum(part.lasts for part in parts), total, unlogged)


def prepare_test(
    runs: Runs,
    settings: ReplaySettings,
    catalogue: Catalogue,
    free: Array,
    group_seconds: float,
) -> Iterator[ObservedRun]:
    """Test runs as the observer sees them, one after the other; see `prepare_run`."""
    for name in runs.of("test"):
        stage, motion = runs.stages[name], runs.motions[name]
        yield prepare_run(stage, motion, settings, catalogue, free, group_seconds=group_seconds)


def _prepare(
    runs: Runs,
    name: str,
    at: slice,
    settings: ReplaySettings,
    catalogue: Catalogue,
    free: Array,
    kept: Recent,
    group_seconds: float,
) -> ObservedRun:
    stage, motion = runs.stages[name], keep_logged(runs.motions[name])
    if at != slice(None):
        begin = int(np.searchsorted(motion.time, motion.time[at.start] - LEAD_SECONDS))
        span = slice(begin, at.stop)
        stage = stage.part(span) if isinstance(stage, Poses) else stage
        after_lead = np.arange(at.stop - begin) >= at.start - begin
        motion = motion.part(span)
        motion = replace(motion, usable=motion.usable & after_lead)
    return prepare_run(stage, motion, settings, catalogue, free, kept, group_seconds)


def _choose(parts: Sequence[_Part], most: float) -> list[_Part]:
    """Parts in their order, up to `most` s: each next one adds most to what is known."""
    squares = np.array([part.squares for part in parts])
    size = np.sqrt(np.maximum(np.einsum("pkk->k", squares), np.finfo(float).tiny))
    squares /= size[:, None] * size
    information, selected, seconds = MIN_INFORMATION_SHARE * np.eye(len(size)), set[int](), most
    while fits := [k for k, p in enumerate(parts) if k not in selected and p.lasts <= seconds]:
        k_best = fits[int(np.argmax(np.linalg.slogdet(information + squares[fits])[1]))]
        selected.add(k_best)
        information, seconds = information + squares[k_best], seconds - parts[k_best].lasts
    return [parts[k] for k in sorted(selected)]


def _divide(motion: Motion) -> Iterator[_Part]:
    """A run in equal parts, each as close to `PART_SECONDS` as can be."""
    duration = motion.end - motion.time[0]
    ends = np.linspace(motion.time[0], motion.end, max(1, round(duration / PART_SECONDS)) + 1)
    places = np.searchsorted(motion.time, ends)
    places[-1] = len(motion.time)
    step = max(1, round(SAMPLE_STEP_SECONDS / float(np.median(np.diff(motion.time)))))
    for a, b in pairwise(places.tolist()):
        at = slice(a, b, step)
        columns = _list_acting(motion, at)[motion.usable[at]]
        lasts = len(motion.time[a:b]) / len(motion.time) * duration
        yield _Part(motion.run.id, slice(a, b), float(lasts), columns.T @ columns)


def _list_acting(motion: Motion, at: slice) -> Array:
    """What forces may depend on, at some samples (n, k)."""
    nu, time, eta, log = motion.state_nu[at], motion.time[at], motion.eta[at], motion.commands
    commanded = log.held_at(time) if len(log.time) else np.zeros((len(time), 0))
    down = unrotate(eta[:, 3:], np.array([0.0, 0.0, 1.0]))
    elapsed = (time - motion.time[0])[:, None]
    columns = [nu, np.abs(nu) * nu, motion.nu_dot[at], down, eta[:, :3], elapsed, commanded]
    return np.nan_to_num(np.hstack(columns))
