"""Check motions against their commands: clocks, conventions of attitudes, order of thrusters."""

from itertools import combinations
from typing import Container, Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import Commands, RunInfo, Site
from rovsim.evaluation.commanded_motion.clocks import tell_following, tell_together
from rovsim.evaluation.commanded_motion.conventions import MIN_GAIN, find_convention
from rovsim.evaluation.commanded_motion.cross_correlation import MIN_CORRELATION
from rovsim.evaluation.commanded_motion.predicted import predict_velocity
from rovsim.intake.facts import Facts
from rovsim.intake.motions import CommandFile, MotionFile
from rovsim.intake.survey.starts import find_start
from rovsim.intake.vehicles import VehicleMatch, convert_log
from rovsim.measurement.quality.excitation import MIN_SPREAD
from rovsim.measurement.quality.usability import usable_reason
from rovsim.measurement.recording import Recording
from rovsim.measurement.recording.tidying import measured_rate
from rovsim.measurement.rough_motion import even_poses


def unusable(motion: MotionFile) -> str | None:
    """Say why rovsim will not use a motion (too short, or it does not move); None if it will."""
    export = motion.track.export
    commands = Commands(np.empty(0), np.empty((0, 6)), "wrench")
    recording = Recording(
        RunInfo("", "", ""),
        Site.unknown(),
        export.time,
        export.position,
        export.attitude,
        export.tracked,
        commands,
        export.rate or measured_rate(export.time),
        export.nu,
        export.channels,
    )
    return usable_reason(recording)


def check_clocks(facts: Facts, axes: Array, reported: Container[int] = ()) -> Iterator[str]:
    """Tell of runs whose motion does not follow its commands, or comes too early or too late.

    Args:
        facts: of the campaign.
        axes: rotation (3, 3) from FRD into the file's body axes.
        reported: positions of runs that a message exists for already; they are skipped.
    """
    runs = {k: correlation for k, correlation in facts.choice.runs.items() if k not in reported}
    starts = {k: find_start(facts.pairs[k].motion.path) for k in runs}
    if remark := tell_together([*runs.values()], axes, next(iter(starts.values()), None)):
        yield f"all runs: {remark}"
        return
    for k, correlation in runs.items():
        if remark := tell_following(correlation, axes, starts[k]):
            yield f"{facts.ids[k]}: {remark}"


def check_attitudes(
    motion: MotionFile,
    log: CommandFile,
    fit: VehicleMatch,
    axes: Sequence[Array],
    lag: float,
    angles: bool,
) -> str:
    """Check whether the motion follows its commands better in another convention of poses.

    Args:
        motion: of one run.
        log: its commands.
        fit: the vehicle, which says what velocities the commands cause.
        axes: rotations (3, 3) from FRD into the file's body axes that are possible.
        lag: by how much the motion comes after its commands, s.
        angles: whether the file's z is vertical, so that roll, pitch and yaw can be tried.

    Returns:
        A sentence on that convention; empty where the present one is as good or nothing tells.
    """
    caused = log.caused(fit)
    if caused is None or not motion.track.posed or motion.track.export.nu is not None:
        return ""
    convention = find_convention(even_poses(motion.track.export), caused, axes, lag, angles)
    return "" if convention is None else str(convention)


def _alike(a: Array, b: Array) -> Array:
    """Correlate two arrays (n, c) column by column; NaN where a column was never measured.

    Only rows count in which every measured column has a value.
    """
    measured = np.isfinite(a).any(axis=0) & np.isfinite(b).any(axis=0)
    correlation = np.full(a.shape[1], np.nan)
    a, b = a[:, measured], b[:, measured]
    complete = np.isfinite(a).all(axis=1) & np.isfinite(b).all(axis=1)
    if complete.any() and measured.any():
        a, b = (x[complete] - x[complete].mean(axis=0) for x in (a, b))
        correlation[measured] = (a * b).mean(axis=0) / np.maximum(
            a.std(axis=0) * b.std(axis=0), 1e-12
        )
    return correlation


def check_order(
    motion: MotionFile, log: CommandFile, fit: VehicleMatch, axes: Array, lag: float
) -> str:
    """Check whether the motion follows better if two outputs are swapped, or one is reversed.

    Args:
        motion: of one run.
        log: its commands.
        fit: the vehicle.
        axes: rotation (3, 3) from FRD into the file's body axes.
        lag: by how much the motion comes after its commands, s.

    Returns:
        A sentence on that change; empty where none is clearly better, or commands are not those of
        thrusters alone.
    """
    commands, measured = convert_log(log.drive, fit, log.path), motion.measured
    if commands is None or measured is None or any(fit.vehicle.angles):
        return ""
    if commands.kind != "thruster":
        return ""
    nu = _turned(measured.nu, axes)
    scores = {
        label: _score(nu, measured.time - lag, Commands(commands.time, value, "thruster"), fit)
        for label, value in _orders(commands.value, fit.columns)
    }
    score_unchanged = scores.pop("")
    label = max(scores, key=lambda key: scores[key])
    if scores[label] < max(score_unchanged + MIN_GAIN, MIN_CORRELATION):
        return ""
    return (
        f"with {label} the motion would follow the commands better (correlation "
        f"{scores[label]:.2f} against {score_unchanged:.2f}). Check the order and the signs of "
        "'commands.columns'"
    )


def _turned(nu: Array, axes: Array) -> Array:
    """Turn velocities (n, 6) along a file's body axes into FRD; NaN stays with its axis."""
    place = np.argmax(np.abs(axes), axis=0)
    sign = axes[place, np.arange(3)]
    return np.hstack([nu[:, place] * sign, nu[:, 3 + place] * sign])


def _score(nu: Array, time: Array, commands: Commands, fit: VehicleMatch) -> float:
    """Correlate body velocities (n, 6), FRD, with those that commands cause; mean of the axes.

    Only axes count that the commands excite; 0 where none of these was measured.
    """
    caused = predict_velocity(fit.vehicle, commands, time)
    excited = caused.std(axis=0) > MIN_SPREAD
    correlation = _alike(nu, caused)[excited]
    measured = np.isfinite(correlation)
    return float(correlation[measured].mean()) if measured.any() else 0.0


def _orders(value: Array, names: Sequence[str]) -> Iterator[tuple[str, Array]]:
    """Vary commands (n, c): as logged, then each pair of outputs swapped, then each reversed."""
    yield "", value
    for a, b in combinations(range(len(names)), 2):
        swapped = value.copy()
        swapped[:, [a, b]] = value[:, [b, a]]
        yield f"{names[a]} and {names[b]} swapped", swapped
    for k, name in enumerate(names):
        negated = value.copy()
        negated[:, k] *= -1.0
        yield f"{name} reversed", negated
