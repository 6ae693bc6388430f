"""Where, when and with what a flight would be recorded: as the campaign's train runs were."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.run import CommandKind, Commands, Site
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Wrench
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.measurement.signals.measured import Measured
from rovsim.simulation.drive import Drives
from rovsim.simulation.settings import ReplaySettings

MAX_STEP_SECONDS = 0.05  # of a predicted path: one step of the observer (observed_run.py)


@dataclass(frozen=True, eq=False)
class RecordingSetup:
    """What flights have in common.

    `like` the train run whose clock, channels and log they would have; `seconds` each; `axes` (6,)
    that a log holds demands of, `largest` (6,) N, N m a log of wrenches went up to; `swum` (3, 2) m
    NED between which the train runs moved, NaN along an axis that nobody measured.
    """

    like: ObservedRun
    seconds: float
    axes: Array
    largest: Array
    swum: Array
    replay: ReplaySettings
    catalogue: Catalogue

    @cached_property
    def coarser(self) -> "RecordingSetup":
        """The same, thrust steady over each step of the observer: half the work."""
        return replace(self, replay=self.replay.model_copy(update={"step": MAX_STEP_SECONDS}))

    @property
    def site(self) -> Site:
        """Walls, and signs of the axes."""
        return self.like.motion.site

    @property
    def kind(self) -> CommandKind:
        """Of the commands."""
        return self.like.motion.commands.kind

    @cached_property
    def wrenches(self) -> tuple[type[Wrench], ...]:
        """Effects of the engine, so that one serves the whole design."""
        return self.like.wrenches

    @cached_property
    def lines(self) -> Array:
        """When the log has lines (n,), s: as often as that run's."""
        step = float(np.median(np.diff(self.like.motion.commands.time)))
        return np.round(step * np.arange(int(self.seconds / step - 1e-9) + 1), 4)

    @cached_property
    def parts(self) -> int:
        """Steps of a predicted path from one reading to the next."""
        return max(1, int(np.ceil(self.like.period / MAX_STEP_SECONDS - 1e-9)))

    @cached_property
    def edges(self) -> Array:
        """Ends (k+1,) s of the steps; readings are `parts` of them apart."""
        count = int(self.seconds / self.like.period)
        return self.like.period / self.parts * np.arange(count * self.parts + 1)

    @property
    def step(self) -> float:
        """Length in s of the steps of a predicted path."""
        return float(self.edges[1] - self.edges[0])

    def drives(self, commands: Commands) -> Drives:
        """What a log does to models over these steps."""
        return Drives(commands, self.edges, self.replay.commands)

    @cached_property
    def measured(self) -> Measured | None:
        """What readings show, each as often as that run's; None: everything."""
        shown = self.like.motion.measured
        if shown is None:
            return None
        mask = self.like.reading_mask
        count = len(self.edges[:: self.parts])
        readings = mask[np.arange(count) % len(mask)]
        return Measured(
            shown.coordinates, shown.heading, shown.axes, shown.summed, readings, shown.cutoff
        )


def describe_setup(
    runs: Sequence[ObservedRun],
    seconds: float,
    axes: Sequence[int] | None,
    replay: ReplaySettings,
    catalogue: Catalogue,
) -> RecordingSetup:
    """What flights have in common with the commanded run of most readings.

    Args:
        runs: the train runs.
        seconds: how long flights last.
        axes: of the columns of a log per axis; None: the log is of thrusters.
        replay: how commands are held.
        catalogue: all effects.

    Raises:
        BadInput: nothing was ever commanded.
    """
    commanded = [run for run in runs if len(run.motion.commands.time) > 1]
    if not commanded:
        raise BadInput(
            "no train run has commands",
            where="rovsim design",
            expected="a campaign that logs commands: they are what a flight is made of",
            remedy="Record a run with commands first, however short.",
        )
    longest = max(commanded, key=lambda run: len(run.reading_steps))
    logged = np.ones(6, bool) if axes is None else np.isin(np.arange(6), axes)
    largest = np.zeros(6)
    for run in commanded:
        if run.motion.commands.kind == "wrench":
            largest = np.maximum(largest, np.max(np.abs(run.motion.commands.value), axis=0))
    return RecordingSetup(
        longest, seconds, logged & longest.free_axes, largest, _span(runs), replay, catalogue
    )


def _span(runs: Sequence[ObservedRun]) -> Array:
    """The least and largest place (3, 2) m NED of all runs; NaN where none was measured."""
    positions = np.concatenate([run.motion.eta[run.motion.usable, :3] for run in runs])
    finite = np.isfinite(positions)
    low = np.where(finite, positions, np.inf).min(axis=0, initial=np.inf)
    high = np.where(finite, positions, -np.inf).max(axis=0, initial=-np.inf)
    return np.where(finite.any(axis=0)[:, None], np.stack([low, high], axis=1), np.nan)
