"""Refuse quaternions whose columns are numbered: which of them is w cannot be known."""

import re
from collections import defaultdict

import numpy as np

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.formats.csv import QUATERNION
from rovsim.measurement.recording.tables.delimited import Lines
from rovsim.measurement.recording.tables.numbers import numbers

NUMBERED_COMPONENT = re.compile(
    r"(q|quat|quaternion|orientation|rot|rotation)[\W_]*(\d)[\W_]*", re.IGNORECASE
)
LENGTH_TOLERANCE = 0.01  # off length one


def check_quaternion(lines: Lines) -> None:
    """Refuse four numbered columns of unit length, unless the file has qw, qx, qy, qz as well.

    Raises:
        BadInput: there are such columns.
    """
    if set(QUATERNION) <= set(lines.names):
        return
    groups: dict[str, list[int]] = defaultdict(list)
    for place, name in enumerate(lines.names):
        if match := NUMBERED_COMPONENT.fullmatch(name):
            groups[match[1].lower()].append(place)
    for places in groups.values():
        if len(places) == 4 and _of_unit_length(lines, places):
            names = ", ".join(lines.names[k] for k in places)
            raise BadInput(
                f"the columns {names} hold a quaternion, and none says which is w",
                where=lines.path,
                expected="qw, qx, qy, qz, in any order",
                remedy="Rename them. ROS, Motive and SciPy write x, y, z, w; Eigen's constructor, "
                "MATLAB and PX4 w, x, y, z.",
            )


def _of_unit_length(lines: Lines, places: list[int]) -> bool:
    try:
        length = np.linalg.norm(numbers(lines, places), axis=1)
    except BadInput:
        return False
    valid = length[np.isfinite(length) & (length > 0.0)]
    return bool(len(valid)) and bool(np.mean(np.abs(valid - 1.0) < LENGTH_TOLERANCE) > 0.5)
