"""What the names of columns say of commands: forces and moments, sticks, units of no command."""

import re
from typing import Collection, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.measurement.recording.commands import guess_unit
from rovsim.measurement.recording.tables.units import in_words

# Axis -> regex of names in lower case with underscores, without their units.
WRENCH_NAMES = dict(
    zip(
        AXES,
        [rf"(.*_)?({word})_?{axis}" for word in ("f|force", "m|t|moment|torque") for axis in "xyz"],
        strict=True,
    )
)
SNAME_LETTERS = dict(zip(AXES, "xyzkmn", strict=True))  # X Y Z K M N (SNAME 1950)
FORCE_UNIT = r"_?(n|nm|n_m|n\*m)"
OTHER_UNIT_NAME = re.compile(r".*[\W_](n|nm|n_m|%|percent|pct|rpm)\W*", re.IGNORECASE)
FORCE_NAME = re.compile(r".*[\W_]n\W*", re.IGNORECASE)
POSE_NAME = re.compile(
    r"(?!tau)(^|[^a-z])(p?[xyz]|q[wxyz]|roll|pitch|yaw|heading|lat|lon|alt(itude)?|depth|position|"
    r"orientation|east|north|up)([^a-z]|$)",
    re.IGNORECASE,
)
STICKS = ("x", "y", "z", "r")  # of MAVLink's MANUAL_CONTROL
FULL_STICK = 1000.0


def find_wrench(names: Collection[str]) -> dict[str, str]:
    """Find columns of forces and moments: Fx, Mz, wrench.force.x, surge [N], tau_k.

    At least two have to be found, one of them a force: mx, my, mz alone may be a magnetic field.

    Returns:
        Names of columns, by the axis along or about which they push; empty where there are none.
    """
    by_stem = {stem(name): name for stem in (in_words, _without_force) for name in names}
    for form in ("{}", "tau_{}", "tau{}"):
        if all(form.format(letter) in by_stem for letter in SNAME_LETTERS.values()):
            return {axis: by_stem[form.format(letter)] for axis, letter in SNAME_LETTERS.items()}
    by_axis: dict[str, str] = {}
    for stem, name in by_stem.items():
        axis = stem if stem in AXES and stem != in_words(name) else None
        axis = axis or next(
            (a for a, form in WRENCH_NAMES.items() if re.fullmatch(form, stem)), None
        )
        if axis:
            by_axis.setdefault(axis, name)
    if len(by_axis) < 2 or not set(AXES[:3]) & by_axis.keys():
        return {}
    return {axis: by_axis[axis] for axis in AXES if axis in by_axis}


def _without_force(name: str) -> str:
    """Write a name in lower case with underscores, without a unit of forces or moments."""
    text = in_words(name)
    return re.sub(rf"{FORCE_UNIT}$", "", text) if re.search(rf"_{FORCE_UNIT[2:]}$", text) else text


def has_other_unit(name: str) -> bool:
    """Whether a name states a unit (N, %, rpm …) that neither pulses nor shares have."""
    return bool(OTHER_UNIT_NAME.fullmatch(name))


def are_sticks(columns: Mapping[str, Array]) -> bool:
    """Whether x, y, z and r are whole numbers within 1000, as MAVLink's MANUAL_CONTROL has them."""
    by_name = {name.lower(): value for name, value in columns.items()}
    if not set(STICKS) <= by_name.keys():
        return False
    value = np.concatenate([by_name[name][np.isfinite(by_name[name])] for name in STICKS])
    small = np.abs(value) <= FULL_STICK
    return bool(len(value) and small.all() and np.array_equal(value, np.round(value)))


def hint(columns: Mapping[str, Array]) -> str:
    """Say what columns of numbers may be, and what to do with them; empty where unknown."""
    if are_sticks(columns):
        return (
            "They may be MANUAL_CONTROL: write surge = x / 1000, sway = y / 1000, heave = "
            "(500 - z) / 500 where 500 is neutral, and yaw = r / 1000"
        )
    if any(POSE_NAME.search(name) for name in columns):
        return "They may be a pose: name them x_m, y_m, … as docs/formats.md does"
    if all(FORCE_NAME.fullmatch(name) for name in columns):
        return (
            "They are forces in N by their names: add them up to the wrench on the vehicle, with "
            "columns surge … yaw in N and N m, kind wrench"
        )
    unit = guess_unit(*find_range(list(columns.values())))
    return f"They may be {unit}" if unit else ""


def find_range(values: Sequence[Array]) -> tuple[float, float]:
    """Return the smallest and the largest number in columns, without NaN."""
    return min(float(np.nanmin(v)) for v in values), max(float(np.nanmax(v)) for v in values)
