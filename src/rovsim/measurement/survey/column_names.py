"""What columns of csv files are called: our channels in other words, and units behind them."""

import re

import numpy as np

from rovsim.measurement.recording.csv import ANGULAR, EULER, LINEAR, POSITION, QUATERNION
from rovsim.measurement.recording.table import Lines

DEGREE = np.pi / 180.0
# Names after their units, brackets and case are gone; `{}` stands for a letter of the channel.
FORMS = {
    "time_s": "t|(time_?)?stamp|(date_?)?time|utc(_time)?|secs?|seconds|elapsed(_time)?|time_boot|"
    "rostime",
    **{
        ours: f"{letter}|p{letter}|pos_?{letter}|position_?{letter}|(pose_)*position_{letter}|"
        f"t{letter}|translation_{letter}|{letter}_pos(ition)?"
        for ours, letter in zip(POSITION, "xyz", strict=True)
    },
    **{
        ours: f"q_?{letter}|quat(ernion)?_?{letter}|(pose_)*orientation_{letter}|{letter}_quat|"
        f"rot(ation)?_{letter}"
        for ours, letter in zip(QUATERNION, "wxyz", strict=True)
    },
    **{ours: ours.removesuffix("_rad") for ours in EULER},
    **{ours: ours.removesuffix("_m_s") for ours in LINEAR},
    **{ours: ours.removesuffix("_rad_s") for ours in ANGULAR},
    "depth_m": "depth",
}
FORMS["roll_rad"] += "|phi"
FORMS["pitch_rad"] += "|theta"
FORMS["yaw_rad"] += "|psi|heading"
UNITS = {
    "mm": 1e-3, "cm": 1e-2, "m": 1.0, "deg": DEGREE, "degrees": DEGREE, "rad": 1.0, "radians": 1.0,
    "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9,
    "m_s": 1.0, "mm_s": 1e-3, "deg_s": DEGREE, "rad_s": 1.0,
}  # fmt: skip


def in_words(name: str) -> str:
    """A name in lower case, underscores in place of blanks, dots, slashes and brackets."""
    return re.sub(r"[\s.\[\](){}/]+", "_", name.strip().lower()).strip("_")


def split_unit(name: str) -> tuple[str, str]:
    """A name without its unit, in lower case with underscores, and the unit."""
    text = in_words(name.strip().lstrip("%"))
    for unit in sorted(UNITS, key=len, reverse=True):
        if text.endswith(f"_{unit}"):
            return text.removesuffix(f"_{unit}"), unit
    return text, ""


def find_unit(lines: Lines, ours: str) -> str:
    """The unit behind the name of a channel of ours; empty where it has none."""
    found = [split_unit(name) for name in lines.names]
    return next((unit for stem, unit in found if re.fullmatch(FORMS[ours], stem) and unit), "")
