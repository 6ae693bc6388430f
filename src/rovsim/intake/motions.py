"""Correlate measured motions with the motion that logged commands would cause in a vehicle."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.evaluation.commanded_motion.cross_correlation import (
    MAX_CLOCK_OFFSET_S,
    MIN_MOTION_S,
    CrossCorrelation,
    cross_correlate,
    rotations,
)
from rovsim.evaluation.commanded_motion.predicted import cause
from rovsim.intake.survey.contents import Track
from rovsim.intake.vehicles import VehicleMatch, convert_log
from rovsim.measurement.recording.candidates import CommandCandidate
from rovsim.measurement.rough_motion import Velocities, estimate_velocities

MAX_COMPARED_S = 600.0  # of commands that are looked at: minutes tell as much as hours


@dataclass(frozen=True, eq=False)
class MotionFile:
    """The motion of one run.

    Attributes:
        path: its file.
        track: the motion in it.
        beside: further files of the run.
    """

    path: Path
    track: Track
    beside: tuple[Path, ...] = ()

    @property
    def name(self) -> str:
        """The names of its files."""
        return ", ".join(path.name for path in (self.path, *self.beside))

    @cached_property
    def measured(self) -> Velocities | None:
        """Rough body velocities in the file's axes; None where these cannot be derived.

        Computed when first needed.
        """
        if len(self.track.export.time) < 2:
            return None
        estimate = estimate_velocities(self.track.export)
        return estimate if np.isfinite(estimate.nu).any() else None


@dataclass(frozen=True, eq=False)
class CommandFile:
    """One log of commands, and the velocity that they would cause in each vehicle."""

    path: Path
    drive: CommandCandidate

    def __post_init__(self) -> None:
        object.__setattr__(self, "_caused", {})

    def caused(self, fit: VehicleMatch) -> tuple[Array, Array] | None:
        """Predict the velocity that the commands cause in a vehicle; computed once for each.

        Returns:
            Times (m,) in s and body velocities (m, 6) in FRD, m/s and rad/s; None where the vehicle
            cannot take such commands.
        """
        cache: dict = self._caused  # type: ignore[attr-defined]
        if fit.name not in cache:
            cache[fit.name] = self._velocity(fit)
        return cache[fit.name]

    def _velocity(self, fit: VehicleMatch) -> tuple[Array, Array] | None:
        commands = convert_log(self.drive, fit, self.path)
        if commands is None or len(commands.time) < 2:
            return None
        return cause(fit.vehicle, commands, float(commands.time[0]), MAX_COMPARED_S)


def correlate(motion: MotionFile, log: CommandFile, fit: VehicleMatch) -> CrossCorrelation | None:
    """Correlate a motion with the one that a log would cause in a vehicle, at many lags.

    Where the two clocks do not overlap, their starts are aligned first, and longer lags are tried.

    Returns:
        None where either motion is unknown, or the measured one is too short.
    """
    caused = log.caused(fit)
    if motion.measured is None or caused is None:
        return None
    time, nu = caused
    clock = motion.measured.time
    if np.ptp(clock) < MIN_MOTION_S:
        return None
    disjoint = clock[-1] < time[0] or time[-1] < clock[0]
    shift = float(clock[0] - time[0]) if disjoint else 0.0
    reach = (
        max(MAX_CLOCK_OFFSET_S, abs(np.ptp(time) - np.ptp(clock)))
        if disjoint
        else MAX_CLOCK_OFFSET_S
    )
    return cross_correlate(motion.measured, time, nu, shift, min(reach, MAX_COMPARED_S))


def rank_rotations(correlations: Mapping[int, CrossCorrelation]) -> list[tuple[float, Array]]:
    """Average the best correlation of each run along each of the 24 axes.

    Args:
        correlations: correlations, by the position of their run.

    Returns:
        Pairs of mean correlation and rotation (3, 3) from FRD into the file's body axes, the best
        first.
    """
    scored = [
        (float(np.mean([correlation.best(axes)[0] for correlation in correlations.values()])), axes)
        for axes in rotations()
    ]
    return sorted(scored, key=lambda pair: -pair[0])


def highest(correlation: CrossCorrelation | None) -> float:
    """Return the highest correlation along any of the 24 axes; 0 without a comparison."""
    return 0.0 if correlation is None else max(correlation.best(axes)[0] for axes in rotations())
