"""Errors of many models in windows of 2 s, in one compiled call: what users see of a model.

Nearly the number that the ladder calls `windows_2s`, on the train runs: predictions are not
filtered once more, and means over bins are those of Simpson's rule. Disturbances may push, so the
same code tells what noise alone would give.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.integrate import cumulative_simpson

from rovsim.core.horizons import STANDARD_WINDOW
from rovsim.core.progress import step
from rovsim.core.threads import map_on_cores
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.innovations import batch_of, find_fluid_memory
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.evaluation.error_metrics import measured_spread, normalize, rms
from rovsim.measurement.signals.measured import find_measured
from rovsim.simulation.batch import Starts
from rovsim.simulation.measured_states import undo_mocap_view
from rovsim.simulation.unfiltered_motion import stage_outputs
from rovsim.simulation.unmeasured_velocities import propagate_unmeasured_velocities
from rovsim.simulation.windows import find_windows, predicted


@dataclass(frozen=True, eq=False)
class WindowErrors:
    """Of m models: velocity RMSE (m, 6) m/s and rad/s, and its mean relative to how much it varies.

    NaN, or None, for models that cannot exist.
    """

    rmse: Array
    normalised: list[float | None]


def score_windows(models: Sequence[Model], runs: Sequence[ObservedRun]) -> WindowErrors:
    """Errors of models in windows of 2 s."""
    step()
    possible = [m for m in models if m.possible]
    parts = map_on_cores(lambda run: Windows(run).compare(possible), runs)
    rmse = np.full((len(models), 6), np.nan)
    counts = sum(part.shape[1] * run.axes for part, run in zip(parts, runs, strict=True))
    rmse[[m.possible for m in models]] = [
        rms(np.concatenate([p[k] for p in parts]), np.maximum(counts, 1))
        for k in range(len(possible))
    ]
    spread = measured_spread(run.motion for run in runs)
    return WindowErrors(rmse, [normalize(spread, row) for row in rmse])


@dataclass(frozen=True, eq=False)
class Windows:
    """Windows of one run, in which models are started anew at what was measured."""

    run: ObservedRun
    seconds: float = STANDARD_WINDOW

    @cached_property
    def spans(self) -> list[tuple[int, int]]:
        """First sample or bin (a) of each window, and the last one (b)."""
        return list(find_windows(self.run.motion, self.seconds))

    @property
    def first(self) -> Array:
        """First sample or bin (w,) of each."""
        return np.array([a for a, _ in self.spans], int)

    @property
    def number(self) -> Array:
        """Number (n,) of the window that each compared velocity lies in."""
        lengths = [b - a for a, b in self.spans]
        return np.repeat(np.arange(len(lengths)), lengths)

    @property
    def compared(self) -> Array:
        """Samples or bins (n,) at which velocities are compared: not the sample it starts from."""
        samples = np.arange(len(self.run.motion.time))
        parts = [samples[predicted(self.run.motion, span)] for span in self.spans]
        return np.concatenate([np.empty(0, int), *parts])

    def compare(
        self, models: Sequence[Model], starts: Array | None = None, wrenches: Array | None = None
    ) -> Array:
        """Predicted minus measured velocity (m, n, 6); zero where none was measured or can be.

        Args:
            models: to predict with.
            starts: states (m, w, 13) as measured to start from; None: the measured ones.
            wrenches: further wrench (m, k, 6) over the integration steps, N and N m.
        """
        if starts is None:
            begin = [undo_mocap_view(m, self.run.motion).state[self.first] for m in models]
        else:
            pairs = zip(models, starts, strict=True)
            begin = [m.mocap_view.inverse.states(state) for m, state in pairs]
        paths = self._simulate(models, np.array(begin), wrenches)
        pairs = zip(models, paths, strict=True)
        nu = [self._report(m, of_model) for m, of_model in pairs]
        # all models at once: a window is short, and there are many
        by_window = [np.stack(of_models) for of_models in zip(*nu, strict=True)]
        return self._subtract_measured(len(models), by_window)

    def _report(self, model: Model, paths: Sequence[Array]) -> list[Array]:
        """Velocities (steps + 1, 6) of each window, as the motion capture would report them."""
        view = model.mocap_view
        if not view.low_pass.time_constants:
            return [view.twists(path[:, 7:]) for path in paths]
        begins = stage_outputs(model, self.run.motion)[1:, self.first, :14]
        binned, grid = self.run.motion.binned, self.run.grid
        return [
            view.report(
                path,
                np.diff(grid[start:][: len(path)]) if binned else grid[1] - grid[0],
                begins[:, i],
                straight=binned,
            )[:, 7:]
            for i, (start, path) in enumerate(zip(self._steps, paths, strict=True))
        ]

    def _simulate(
        self, models: Sequence[Model], begin: Array, wrenches: Array | None
    ) -> list[list[Array]]:
        """States (steps + 1, 13) of each model from true states (m, w, 13), every step."""
        run = self.run
        drives = run.replay_drives.of(models)
        if wrenches is not None:
            drives = [
                drive.with_wrench(wrench) for drive, wrench in zip(drives, wrenches, strict=True)
            ]
        begin_steps = self._steps
        steps = np.array([run.at[b] for _, b in self.spans], np.int64) - begin_steps
        begins = Starts(
            begin, begin_steps, steps, find_fluid_memory(models, run, run.grid, begin_steps)
        )
        batch, time = batch_of(models, run), run.since_start(run.grid)
        begins = propagate_unmeasured_velocities(
            batch, drives, begins, time, find_measured(run.motion.measured)
        )
        return batch.trajectories(drives, begins, time)

    @property
    def _steps(self) -> Array:
        """Integration step (w,) at which each begins."""
        return np.array([self.run.at[a] for a, _ in self.spans], np.int64)

    def _subtract_measured(self, count: int, nu: Sequence[Array]) -> Array:
        """Differences (m, n, 6) of velocities (m, steps + 1, 6) of each window."""
        pairs = zip(self.spans, nu, strict=True)
        motion = self.run.motion
        parts = [self._at_readings(s, v) - motion.nu[predicted(motion, s)] for s, v in pairs]
        errors = np.concatenate([np.empty((count, 0, 6)), *parts], axis=1)
        return np.where(self.run.axes, errors, 0.0)

    def _at_readings(self, span: tuple[int, int], nu: Array) -> Array:
        """Velocities (m, k, 6) at the samples, or their means over the bins, of one window."""
        a, b = span
        begin, at = self.run.at[a], self.run.at[a : b + 1]
        if not self.run.motion.binned:
            return nu[:, at[1:] - begin]
        distance = cumulative_simpson(
            nu, dx=self.run.grid[1] - self.run.grid[0], axis=1, initial=0.0
        )
        increments = np.diff(distance[:, at - begin], axis=1)
        return np.asarray(increments / np.diff(self.run.grid[at])[:, None])
