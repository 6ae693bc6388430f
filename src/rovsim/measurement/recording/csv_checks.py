"""Refuse numbers of a csv that are implausible for the units of its columns; nothing is guessed."""

from pathlib import Path
from typing import Mapping, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.tables.cells import find_filler

MAX_STEP_S = 5.0  # between two lines of any recording
POSITION = ["x_m", "y_m", "z_m"]
MAX_SPEED = 30.0  # m/s: 58 kn, the fastest ship (HSC Francisco, 2013)
MAX_TURN_RATE = 10.0  # rad/s: more than one and a half turns a second
USUAL_PERCENTILE = 90.0
LINEAR, ANGULAR = ["u_m_s", "v_m_s", "w_m_s"], ["p_rad_s", "q_rad_s", "r_rad_s"]


class Limit(NamedTuple):
    """The velocity or rate that no vehicle usually reaches.

    Attributes:
        columns: names of the columns in a csv.
        fastest: the limit.
        unit: its unit.
        others: other units that sensors often use.
    """

    columns: list[str]
    fastest: float
    unit: str
    others: tuple[str, ...]

    def beyond(self, value: Array) -> float | None:
        """The 90th percentile of the size of `value` (n, c) if it is above the limit; else None."""
        if not np.isfinite(value).any():
            return None
        usual = float(np.nanpercentile(np.abs(value), USUAL_PERCENTILE))
        return usual if usual > self.fastest else None


LIMITS = {  # by channel
    "velocity": Limit(LINEAR, MAX_SPEED, "m/s", ("mm/s", "cm/s")),
    "rates": Limit(ANGULAR, MAX_TURN_RATE, "rad/s", ("deg/s",)),
}
MAX_PITCH = np.pi + 0.1  # rad: a pitch lies within a quarter turn, and is hardly ever unwrapped
ABOVE_SURFACE, MIN_ABOVE_SHARE = -0.1, 0.95  # m, beyond a wrong zero of the sensor; of the lines
MIN_HEIGHT_REACH = 0.5  # m: a height must reach so far
UPRIGHT_COSINE, TUMBLING_COSINE = 0.9, 0.5  # fifth percentile of the tilt's: 26 and 60 degrees
RENAME_COLUMN = "Name the column after its unit ({}), and let `rovsim init` make a copy in {}."


def without_fillers(names: Sequence[str], values: Array) -> tuple[Array, tuple[str, ...]]:
    """Replace numbers that stand for "not measured" by NaN; with sentences about them.

    Args:
        names: names (c,) of the columns.
        values: the numbers (n, c).
    """
    column_fillers = [find_filler(column) for column in values.T]
    notes = tuple(
        f"{int(np.sum(column == filler))} cells of '{name}' hold {filler:g}: not measured."
        for name, filler, column in zip(names, column_fillers, values.T, strict=True)
        if filler is not None
    )
    fillers = np.array([np.nan if filler is None else filler for filler in column_fillers])
    return np.where(values == fillers, np.nan, values), notes


def check_plausible(path: Path, time: Array, values: Mapping[str, Array]) -> None:
    """Refuse times that are not in s, positions not in m, angles not in rad, and heights as depths.

    Args:
        path: the file.
        time: (n,) s.
        values: columns (n,) by name.

    Raises:
        BadInput: says which column is implausible, and how to correct it.
    """
    _check_steps(path, time)
    _check_positions(path, time, values)
    _check_pitch(path, values)
    _check_velocities(path, values)
    _check_depth(path, values)


def _check_steps(path: Path, time: Array) -> None:
    step = float(np.median(np.abs(np.diff(time)))) if len(time) > 1 else 0.0
    if step > MAX_STEP_S:
        raise _refused(
            path,
            "time_s",
            f"steps of {step:.3g} s: ms, us or ns?",
            "seconds",
            RENAME_COLUMN.format("time_ms", "s"),
        )


def _check_positions(path: Path, time: Array, values: Mapping[str, Array]) -> None:
    if not values.keys() >= set(POSITION):
        return
    order = np.argsort(time, kind="stable")
    position = np.stack([values[name] for name in POSITION], axis=1)
    speed = usual_speed(position[order], time[order])
    if speed > MAX_SPEED:
        raise _refused(
            path,
            "x_m",
            f"a vehicle that moves at {speed:.3g} m/s: mm or cm?",
            "m",
            RENAME_COLUMN.format("x_mm", "m"),
        )


def _check_pitch(path: Path, values: Mapping[str, Array]) -> None:
    pitch = np.abs(values.get("pitch_rad", np.zeros(0)))
    if np.nanmax(pitch, initial=0.0) > MAX_PITCH:
        raise _refused(
            path,
            "pitch_rad",
            f"angles up to {np.nanmax(pitch):.3g}: degrees?",
            "rad, within a quarter turn",
            RENAME_COLUMN.format("pitch_deg", "rad"),
        )


def _check_velocities(path: Path, values: Mapping[str, Array]) -> None:
    for limit in LIMITS.values():
        columns = [values[name] for name in limit.columns if name in values]
        if columns and (usual := limit.beyond(np.stack(columns))):
            name, other_units = limit.columns[0], [unit.replace("/", "_") for unit in limit.others]
            raise _refused(
                path,
                name,
                f"values of {usual:.3g} {limit.unit}: {' or '.join(other_units)}?",
                limit.unit,
                RENAME_COLUMN.format(f"{name[0]}_{other_units[0]}", limit.unit),
            )


def _check_depth(path: Path, values: Mapping[str, Array]) -> None:
    depth = values.get("depth_m", np.zeros(0))
    if is_height(depth):
        low, high = np.nanmin(depth), np.nanmax(depth)
        raise _refused(
            path,
            "depth_m",
            f"depths from {low:.3g} to {high:.3g} m: heights?",
            "m, positive down",
            "Turn the sign of the column; `rovsim init` does so in a copy.",
        )


def usual_speed(value: Array, time: Array) -> float:
    """Speed that is exceeded in a tenth of the time, from steps of 0.2 s, long against noise.

    Args:
        value: positions (n, c), m; rows of zeros count as not measured.
        time: (n,) s, increasing.

    Returns:
        The 90th percentile, m/s; 0 with fewer than ten known positions.
    """
    valid = np.isfinite(value).all(axis=1) & np.isfinite(time) & value.any(axis=1)
    if valid.sum() < 10:
        return 0.0
    t, x = time[valid], value[valid]
    stride = max(1, round(0.2 / max(float(np.median(np.diff(t))), 1e-6)))
    dt, dx = t[stride:] - t[:-stride], np.linalg.norm(x[stride:] - x[:-stride], axis=1)
    increasing = dt > 0
    return float(np.percentile(dx[increasing] / dt[increasing], 90)) if increasing.any() else 0.0


def doubt_order(quaternion: Array) -> tuple[str, ...]:
    """Sentence where quaternions (n, 4) tumble as (w, x, y, z) but stay upright as (x, y, z, w).

    Upside down counts as upright, because that depends on the axes.
    """
    nonzero = quaternion[np.isfinite(quaternion).all(axis=1) & quaternion.any(axis=1)]
    if not len(nonzero):
        return ()
    square = (nonzero / np.linalg.norm(nonzero, axis=1, keepdims=True)) ** 2
    tilts = [np.abs(1.0 - 2.0 * (square[:, k] + square[:, k + 1])) for k in (1, 0)]
    as_named, reordered = (float(np.percentile(tilt, 5)) for tilt in tilts)
    if as_named > TUMBLING_COSINE or reordered < UPRIGHT_COSINE:
        return ()
    return (
        "As qw, qx, qy, qz say, the vehicle tumbles; it would stay upright if these columns, in "
        "this order, held x, y, z, w, as ROS, Motive and SciPy write them. Rename them if they do.",
    )


def is_height(depth: Array) -> bool:
    """Whether a depth (n,) m is positive up, since otherwise nearly all is above the surface."""
    finite = depth[np.isfinite(depth)]
    return bool(
        len(finite)
        and np.mean(finite < ABOVE_SURFACE) > MIN_ABOVE_SHARE
        and finite.min() < -MIN_HEIGHT_REACH
    )


def _refused(path: Path, column: str, found: str, expected: str, remedy: str) -> BadInput:
    return BadInput(found, where=f"{path}, column '{column}'", expected=expected, remedy=remedy)
