"""Find our channels in csv files whose columns have other names."""

import re
from collections import defaultdict
from typing import Iterator, Sequence

from rovsim.measurement.recording.formats.csv import ANGULAR, EULER, LINEAR, POSITION, QUATERNION
from rovsim.measurement.recording.tables.delimited import Lines
from rovsim.measurement.recording.tables.named_columns import TIME_COLUMN
from rovsim.measurement.recording.tables.units import TIME_FACTORS, split_unit

# Our name -> regex of names that mean the same, once unit, brackets and case are removed.
NAME_PATTERNS = {
    TIME_COLUMN: "t|(time_?)?stamp|(date_?)?time|utc(_time)?|secs?|seconds|elapsed(_time)?|"
    "time_boot|rostime",
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
NAME_PATTERNS["roll_rad"] += "|phi"
NAME_PATTERNS["pitch_rad"] += "|theta"
NAME_PATTERNS["yaw_rad"] += "|psi|heading"
# Columns of a ROS topic with poses: the group of our channels, and the regex of their names.
POSE_TOPIC_COLUMNS = (
    (POSITION, r"(.*_pose)_position_([xyz])"),
    (QUATERNION, r"(.*_pose)_orientation_([wxyz])"),
)


def find_columns(lines: Lines) -> dict[str, int]:
    """Find the column of each of our channels.

    Preferred is our own name, then our name without its unit, then other words in the order of the
    file, and last a ROS topic with poses: with several topics, it is unknown which is meant.

    Returns:
        Positions of columns, by our names; without channels that the file lacks.
    """
    names = list(map(split_unit, lines.names))
    columns = ((ours, next(_places(ours, lines, names), None)) for ours in NAME_PATTERNS)
    return _of_a_topic(names) | {ours: place for ours, place in columns if place is not None}


def _places(ours: str, lines: Lines, names: Sequence[tuple[str, str]]) -> Iterator[int]:
    """List positions of the columns that may be one of our channels, the likeliest first."""
    yield from (k for k, name in enumerate(lines.names) if name == ours)
    fitting = [k for k, (_, unit) in enumerate(names) if not unit or _fits(ours, unit)]
    bare_name = split_unit(ours)[0]
    yield from (k for k in fitting if names[k][0] == bare_name)
    yield from (k for k in fitting if re.fullmatch(NAME_PATTERNS[ours], names[k][0]))


def _fits(ours: str, unit: str) -> bool:
    return (unit in TIME_FACTORS) == (ours == TIME_COLUMN)


def _of_a_topic(names: Sequence[tuple[str, str]]) -> dict[str, int]:
    """Find positions and quaternions of a ROS topic, if exactly one topic has all components."""
    columns: dict[str, int] = {}
    for group, form in POSE_TOPIC_COLUMNS:
        topics: dict[str, dict[str, int]] = defaultdict(dict)
        for k, (stem, _) in enumerate(names):
            if part := re.fullmatch(form, stem):
                topics[part[1]][next(n for n in group if part[2] in n.split("_")[0])] = k
        complete = [places for places in topics.values() if len(places) == len(group)]
        columns |= complete[0] if len(complete) == 1 else {}
    return columns
