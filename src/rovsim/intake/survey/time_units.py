"""Find the unit of times by their size, their steps and how long they last."""

import numpy as np
from numpy import ndarray as Array

from rovsim.intake.survey.sizes import Unit, Units, UnknownUnit
from rovsim.measurement.recording.csv_checks import MAX_STEP_S
from rovsim.measurement.recording.tables.delimited import Lines
from rovsim.measurement.recording.tables.named_columns import TIME_COLUMN
from rovsim.measurement.recording.tables.times import MAX_TIME_S, times
from rovsim.measurement.recording.tables.units import SI_FACTORS

MIN_STEP_S = 2e-4  # between two lines of any recording
MIN_RECORDING_S = 3.0  # where its lines would come faster than any camera
MAX_CAMERA_RATE_HZ = 1000.0
EXPECTED_TIME_COLUMN = "time_s, or time_ms, time_us, time_ns, time_min; days times 86400 are time_s"


def find_time_unit(
    lines: Lines, place: int, value: Array, unit: str, units: Units
) -> tuple[float, str]:
    """Find the factor from times to seconds.

    Args:
        lines: of the file.
        place: position of the column of times.
        value: (n,) the times as logged.
        unit: that the column's name states; empty where it states none.
        units: that other files tell; what is found is added.

    Returns:
        The factor, and how it is known.

    Raises:
        UnknownUnit: no unit is stated, and the steps of the times allow two units, or none.
        BadInput: these are no times.
    """
    if not np.isfinite(value).any():
        times(lines, place)  # says what they are
    latest = float(np.nanmax(np.abs(value), initial=0.0))
    step = float(np.nanmedian(np.abs(np.diff(value)))) if len(value) > 1 else 1.0
    in_seconds = lines.names[place] == TIME_COLUMN
    if in_seconds and step < MAX_STEP_S and not latest > MAX_TIME_S:
        return 1.0, ""
    if unit and not in_seconds:
        return SI_FACTORS[unit], f" in {unit}"
    for name, size in (("ns", 1e17), ("us", 1e14), ("ms", 1e11)):
        if latest > size:
            return SI_FACTORS[name], f" in {name} since 1970, by its size"
    if not step > 0.0:
        return 1.0, " in s, by its steps"
    key, duration = (lines.names[place],), float(np.nanmax(value) - np.nanmin(value))
    settled = units.settle(key, lambda: _by_steps(lines, key, step, duration))
    return settled.factor, settled.note


def _by_steps(lines: Lines, key: tuple[str], step: float, lasts: float) -> Unit:
    """Tell the unit of times by their usual step and their duration, both in the file's unit.

    Raises:
        UnknownUnit: several units suit, or none.
    """
    names = [n for n in ("s", "ms", "us", "ns") if _is_step(step * SI_FACTORS[n])]
    suited = [n for n in names if _is_recording(step * SI_FACTORS[n], lasts * SI_FACTORS[n])]
    if len(suited) == 1:
        sure = len(names) == 1
        return Unit(SI_FACTORS[suited[0]], f" in {suited[0]}, by its steps", sure, shared=False)
    options = " or ".join(suited) if suited else "days (of a spreadsheet, or datenum) or minutes"
    raise UnknownUnit(
        f"times ('{key[0]}') in steps of {step:.3g} over {lasts:.3g} ({options}?)",
        lines,
        key,
        EXPECTED_TIME_COLUMN,
        large=True,
    )


def _is_step(seconds: float) -> bool:
    """Whether two lines of a recording can be so far apart."""
    return MIN_STEP_S <= seconds < MAX_STEP_S


def _is_recording(step: float, lasts: float) -> bool:
    """Whether a recording of this step and duration, in s, is long enough for its rate."""
    return lasts >= MIN_RECORDING_S or step >= 1.0 / MAX_CAMERA_RATE_HZ
