"""A run as the observer sees it: readings of the motion capture before any filter."""

from dataclasses import dataclass
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.actuation import Between, ThrustPath
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Wrench
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.chain import Stage
from rovsim.measurement.signals.motion import Motion, Poses
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.step_grid import StepGrid

# The observer forgets where it started within a second: its bandwidth is about 1 Hz (noise.py).
SETTLING = 1.0  # s
SHORTEST = 2.0  # s; a shorter stretch would be mostly settling
GAP = 1.5  # of the usual time between two lines of the command log: a line was lost
USUAL, JUMP = 0.95, 2.0  # quantile of the changes from line to line; two of them are a jump
BLOCK = 10.0  # s, many times the memory of turbulence, so that blocks are independent


@dataclass(frozen=True, eq=False)
class ObservedRun:
    """One run, ready to be observed.

    `readings` (k, 13): pose NED, and mean velocity since the reading before where velocities were
    measured; `ends` (k,) integration steps at which they hold; `edges` (s+1,) those steps, s;
    `spans` pairs (first, last) of readings: the observer starts at `first`, whose state is
    `starts` (., 13), and reads up to `last`. `between` two lines of the log, commands are
    held or joined; `wrenches` are those of the one engine that serves all models of a diagnosis.
    """

    motion: Motion
    readings: Array
    ends: Array
    edges: Array
    spans: tuple[tuple[int, int], ...]
    starts: Array
    between: Between
    wrenches: tuple[type[Wrench], ...]

    @property
    def h(self) -> float:
        """Integration step, s."""
        return float(self.edges[1] - self.edges[0])

    @cached_property
    def period(self) -> float:
        """Mean time between two readings, s."""
        return float((self.ends[-1] - self.ends[0]) * self.h / (len(self.ends) - 1))

    @cached_property
    def rows(self) -> Array:
        """First row and last + 1 (s, 2) of the innovations that belong to each span."""
        length = np.array([b - a for a, b in self.spans], np.int64)
        stops = np.cumsum(length)
        return np.column_stack([stops - length, stops])

    @cached_property
    def time(self) -> Array:
        """Instant of each innovation, s since the start of the run."""
        parts = [self.ends[a + 1 : b + 1] * self.h for a, b in self.spans]
        return np.concatenate([np.empty(0), *parts])

    @cached_property
    def index(self) -> Array:
        """Sample or bin of the motion that each innovation belongs to."""
        parts = [np.arange(a + 1, b + 1) for a, b in self.spans]
        return np.concatenate([np.arange(0), *parts]) - (1 if self.motion.binned else 0)

    @cached_property
    def settled(self) -> Array:
        """Which innovations count: those after the observer has forgotten its start."""
        kept = np.zeros(len(self.time), bool)
        for (first, last), (a, _) in zip(self.rows, self.spans, strict=True):
            kept[first:last] = self.time[first:last] > self.ends[a] * self.h + SETTLING
        return kept

    def find_lost_commands(self, path: ThrustPath) -> Array:
        """Begins and ends (g, 2) of lost lines of the command log over which commands jumped.

        `path` says when a logged command takes effect.
        """
        commands = self.motion.commands
        steps = np.diff(commands.time)
        if not len(steps):
            return np.empty((0, 2))
        change = np.max(np.abs(np.diff(commands.value, axis=0)), axis=1)
        lost = (steps > GAP * np.median(steps)) & (change > JUMP * np.quantile(change, USUAL))
        at = self.edges[0] + path.arrival(commands.time - self.edges[0])
        return np.column_stack([at[:-1][lost], at[1:][lost]])


def prepare_runs(
    runs: Runs, split: str, settings: ReplaySettings, catalogue: Catalogue
) -> list[ObservedRun]:
    """The runs of one split as the observer sees them. See `prepare_run`."""
    chosen = {name: motion for name, motion in runs.motions.items() if motion.run.split == split}
    return [
        prepare_run(runs.stages[name], motion, settings, catalogue)
        for name, motion in chosen.items()
    ]


def prepare_run(
    stage: Stage, motion: Motion, settings: ReplaySettings, catalogue: Catalogue
) -> ObservedRun:
    """A run as the observer sees it; without usable stretches it has no spans.

    Args:
        stage: its poses on a uniform clock, before the filter; binned recordings as they are.
        motion: the same run, filtered and differentiated.
        settings: the longest integration step, and how commands are held.
        catalogue: effects that may act in it.
    """
    grid = StepGrid.over(motion, settings.step)
    ends, readings = _read_bins(motion, grid) if motion.binned else _read_poses(stage, grid)
    spans = tuple((a, b - 1) for a, b in motion.segments() if _lasts(motion, a, b))
    return ObservedRun(
        motion=motion,
        readings=readings,
        ends=ends,
        edges=grid.edges,
        spans=spans,
        starts=np.array([motion.state[a] for a, _ in spans]).reshape(-1, 13),
        between=settings.commands,
        wrenches=tuple(c for c in catalogue.values() if issubclass(c, Wrench)),
    )


def _lasts(motion: Motion, a: int, b: int) -> bool:
    """Whether the stretch from sample or bin a to b - 1 is long enough."""
    if motion.binned:
        return bool(motion.time[b - 1] - motion.time[a] > SHORTEST)
    return bool((b - a) * (motion.time[1] - motion.time[0]) > SHORTEST)


def _read_poses(stage: Stage, grid: StepGrid) -> tuple[Array, Array]:
    """Steps (k,) at which readings (k, 13) hold: the poses."""
    assert isinstance(stage, Poses)
    count = len(stage.eta)
    return np.arange(count) * grid.stride, np.hstack([stage.eta, np.zeros((count, 6))])


def _read_bins(motion: Motion, grid: StepGrid) -> tuple[Array, Array]:
    """Steps (k,) at which readings (k, 13) hold: the pose there, the mean velocity of the bin."""
    h = grid.edges[1] - grid.edges[0]
    means = np.vstack([np.zeros(6), motion.nu[:-1]])
    ends = np.round((motion.time - motion.time[0]) / h).astype(int)
    return ends, np.hstack([motion.eta, means])


def number_blocks(runs: Sequence[ObservedRun]) -> Array:
    """Number of the block of some 10 s that each settled innovation lies in, over all runs."""
    parts, count = [np.arange(0)], 0
    for one in runs:
        number = (one.time[one.settled] / BLOCK).astype(int)
        kept, own = np.unique(number, return_inverse=True)
        parts.append(own + count)
        count += len(kept)
    return np.concatenate(parts)
