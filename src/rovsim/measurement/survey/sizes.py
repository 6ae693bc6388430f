"""Units that the size of the numbers tells, where no name does."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import unwrapped
from rovsim.measurement.recording.csv import EULER, POSITION
from rovsim.measurement.recording.csv_checks import FASTEST, usual_speed
from rovsim.measurement.recording.table import Lines
from rovsim.measurement.survey.column_names import DEGREE, find_unit, split_unit

# Sizes that no vehicle reaches in a tank or a bay.
FARTHEST = 1000.0  # m
FASTEST_TURN = 10.0  # rad/s, usual over a recording
SLOW_ENOUGH = 10.0  # m/s in which a unit of metres is believed


def find_by_size(lines: Lines, names: list[str], value: Array, time: Array) -> tuple[float, str]:
    """Factor to our unit where the size of the numbers says one, and how; else 1 and nothing.

    Raises:
        BadInput: the columns name no unit, and their numbers allow two.
    """
    named = all(name in lines.names or find_unit(lines, name) for name in names)
    if names[0] in POSITION:
        return _metres(lines, value, time, named)
    if names[0] in EULER:
        return _radians(lines, names, value, time, named)
    return 1.0, ""


def _metres(lines: Lines, value: Array, time: Array, named: bool) -> tuple[float, str]:
    far = float(np.nanmax(np.nanpercentile(value, 99, axis=0) - np.nanpercentile(value, 1, axis=0)))
    fast = usual_speed(value, time)
    unit = any(split_unit(name)[1] in ("mm", "cm") for name in lines.names)
    if unit and named:
        return 1.0, ""
    if fast > FASTEST or far > FARTHEST:
        return 1e-3, f" in mm, by its size ({fast:.0f} m/s if it were m)"
    if named:
        return 1.0, ""
    if fast < SLOW_ENOUGH and far < 0.1 * FARTHEST:
        return 1.0, " in m, by its size"
    raise BadInput(
        f"positions over {far:.3g}, {fast:.3g} per second, without a unit",
        where=lines.path,
        expected="x_m, y_m, z_m or x_mm, y_mm, z_mm",
        remedy="Rename these columns.",
    )


def _radians(
    lines: Lines, names: list[str], value: Array, time: Array, named: bool
) -> tuple[float, str]:
    unit = any(split_unit(name)[1] in ("deg", "degrees") for name in lines.names)
    if named and unit:
        return 1.0, ""
    if named:  # angles that count on may be large: only what no vehicle does speaks against a name
        fast = usual_speed(unwrapped(value), time)
        absurd = fast > FASTEST_TURN
        return (DEGREE, f" in degrees, by its size ({fast:.0f} rad/s)") if absurd else (1.0, "")
    size = np.nanmax(np.abs(value), axis=0)
    turns = [s for n, s in zip(names, size, strict=True) if n != "yaw_rad"]
    # a pitch lies within a quarter turn, a roll within half a turn; a heading may count its turns
    degrees = max(turns, default=0.0) > 1.02 * np.pi or (not turns and size.max() > 6 * np.pi)
    if degrees:
        return DEGREE, " in degrees, by its size"
    heading = value[:, names.index("yaw_rad")] if "yaw_rad" in names else value[:, 0]
    spread = float(np.nanmax(heading) - np.nanmin(heading))
    if 1.0 < spread < 2.02 * np.pi:
        return 1.0, " in rad, by its size"
    if spread >= 2.02 * np.pi:
        return DEGREE, " in degrees, by its size"
    raise BadInput(
        f"angles up to {size.max():.3g} without a unit: rad or degrees?",
        where=lines.path,
        expected="roll_rad, pitch_rad, yaw_rad or roll_deg, pitch_deg, yaw_deg",
        remedy="Rename these columns.",
    )
