"""Find units by the size of the numbers, where the names of columns do not state them."""

from dataclasses import dataclass, field
from typing import Callable, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.robust import usual_range
from rovsim.core.rotations import unwrapped
from rovsim.measurement.recording.csv_checks import MAX_SPEED, usual_speed
from rovsim.measurement.recording.formats.csv import EULER, POSITION
from rovsim.measurement.recording.tables.delimited import Lines
from rovsim.measurement.recording.tables.units import DEGREE, split_unit

# Sizes that no vehicle reaches in a tank or a bay.
MAX_DISTANCE_M = 1000.0
MAX_TURN_RATE = 10.0  # rad/s, usual over a recording
MAX_METRE_SPEED = 10.0  # m/s in which a unit of metres is believed
# Usual speeds in mm/s below this may be cm/s as well: a vehicle at 1.2 m/s, or one that creeps.
MIN_MM_PER_S = 120.0
MAX_HEADING = 20.0 * np.pi  # rad: a heading that has turned ten times
MIN_WRAP_RAD = 5.5  # rad from one line to the next: a heading that begins anew after a turn
EXPECTED_ANGLES = "roll_rad, pitch_rad, yaw_rad or roll_deg, pitch_deg, yaw_deg"

Key = tuple[str, ...]  # names of columns in a file


@dataclass(frozen=True)
class Unit:
    """A unit that the size of the numbers tells.

    Attributes:
        factor: from the file's unit to ours.
        note: the unit and how it is known, to append to a sentence; may be empty.
        sure: whether numbers of another unit could not look like these; small ones could.
        shared: whether columns of these names have this unit in all files. Times need not: those of
            cameras may be in s and those of a microcontroller in ms.
    """

    factor: float
    note: str
    sure: bool
    shared: bool = True


@dataclass(frozen=True)
class Units:
    """Units of columns without a unit in their names.

    Attributes:
        other_files: units that other files tell, by names of columns.
        settled: units that this file's numbers tell; filled by `settle`.
    """

    other_files: Mapping[Key, Unit] = field(default_factory=dict)
    settled: dict[Key, Unit] = field(default_factory=dict)

    def settle(self, key: Key, decide: Callable[[], Unit]) -> Unit:
        """Return the unit of columns: that of other files, else what `decide` returns."""
        if key not in self.other_files:
            self.settled[key] = decide()
        return self.other_files.get(key) or self.settled[key]


class UnknownUnit(BadInput):
    """Columns without a unit, whose numbers may be of two units.

    Attributes:
        key: names of the columns.
        large: whether the numbers are large. Small ones take an unsure unit of another file; large
            ones only a sure one.
    """

    def __init__(
        self, found: str, lines: Lines, key: Key, expected: str, *, large: bool = False
    ) -> None:
        super().__init__(found, where=lines.path, expected=expected, remedy="Rename these columns.")
        self.key, self.large = key, large


def find_by_size(
    lines: Lines, here: Mapping[str, int], value: Array, time: Array, units: Units
) -> tuple[float, str]:
    """Find the unit of positions or angles by the size of their numbers.

    Args:
        lines: of the file.
        here: positions of the c columns, by our names.
        value: (n, c) numbers.
        time: (n,) s.
        units: that other files tell; what is found is added.

    Returns:
        The factor to our unit and how it is known; 1 and nothing for other columns, and for units
        that the names state.

    Raises:
        UnknownUnit: the columns name no unit, or a wrong one, and their numbers allow two.
    """
    names, file_names = list(here), [lines.names[place] for place in here.values()]
    stated = all(a == b or split_unit(b)[1] for a, b in zip(names, file_names, strict=True))
    other_units: tuple[str, ...]
    if names[0] in POSITION:
        other_units, judge = ("mm", "cm"), _metres
    elif names[0] in EULER:
        other_units, judge = ("deg",), _radians
    else:
        return 1.0, ""
    if stated and any(split_unit(name)[1] in other_units for name in file_names):
        return 1.0, ""
    if not np.isfinite(value).any():
        return 1.0, ""
    key = tuple(file_names)

    def decide() -> Unit:
        return judge(_ColumnGroup(lines, key, names, value, time, stated))

    unit = units.settle(key, decide)
    return unit.factor, unit.note


@dataclass(frozen=True, eq=False)
class _ColumnGroup:
    """Columns of one group of channels.

    Attributes:
        lines: of the file.
        key: the file's names of the columns.
        names: our names of them.
        value: (n, c) numbers.
        time: (n,) s.
        named: whether the file's names state units.
    """

    lines: Lines
    key: Key
    names: list[str]
    value: Array
    time: Array
    named: bool

    def asked(self, found: str, expected: str, *, large: bool = False) -> UnknownUnit:
        """Make the error that asks for the unit of these columns."""
        return UnknownUnit(found, self.lines, self.key, expected, large=large)


def _metres(of: _ColumnGroup) -> Unit:
    """Tell the unit of positions by how far and how fast a vehicle would move in m."""
    low, high = usual_range(of.value)
    extent, speed = float(np.nanmax(high - low)), usual_speed(of.value, of.time)
    if speed > MIN_MM_PER_S:
        return Unit(1e-3, f" in mm, by its size ({speed:.0f} m/s if it were m)", True)
    if of.named and speed <= MAX_SPEED:
        return Unit(1.0, "", False)
    if speed < MAX_METRE_SPEED and extent < 0.1 * MAX_DISTANCE_M:
        return Unit(1.0, " in m, by its size", False)
    raise of.asked(
        f"positions ({', '.join(of.key)}) over {extent:.3g}, {speed:.3g} per second, without a "
        f"unit ({'mm or cm' if speed > MAX_SPEED else 'm, cm or mm'}?)",
        "x_m, y_m, z_m, or x_cm, y_cm, z_cm, or x_mm, y_mm, z_mm",
        large=True,
    )


def _radians(of: _ColumnGroup) -> Unit:
    """Tell the unit of angles by how large roll and pitch are, and how fast angles change."""
    size = np.nanmax(np.abs(of.value), axis=0)
    tilts = [s for n, s in zip(of.names, size, strict=True) if n != "yaw_rad"]
    tilted = max(tilts, default=0.0)
    # a pitch lies within a quarter turn, a roll within half a turn; a heading may count its turns
    degrees = tilted > 1.02 * np.pi
    return _named_radians(of, tilted, degrees) if of.named else _free_radians(of, size, degrees)


def _named_radians(of: _ColumnGroup, tilted: float, degrees: bool) -> Unit:
    """Tell the unit of angles whose names say rad: rad, unless they turn too fast for a vehicle.

    Their size alone tells nothing: angles that count full turns may be large.
    """
    fast = usual_speed(unwrapped(of.value), of.time)
    if fast <= MAX_TURN_RATE:
        return Unit(1.0, "", False)
    if degrees or tilted == 0.0:
        return Unit(DEGREE, f" in degrees, by its size ({fast:.0f} rad/s)", True)
    raise of.asked(
        f"angles ({', '.join(of.key)}) that turn by {fast:.0f} rad/s, but roll and pitch up to "
        f"{tilted:.3g} (rad or degrees, and are all of them of one unit?)",
        EXPECTED_ANGLES,
        large=True,
    )


def _free_radians(of: _ColumnGroup, size: Array, degrees: bool) -> Unit:
    """Tell the unit of angles without a unit in their names.

    Args:
        of: the columns.
        size: (c,) the largest absolute number of each.
        degrees: whether roll or pitch is too large for rad.
    """
    heading = of.value[:, of.names.index("yaw_rad") if "yaw_rad" in of.names else 0]
    spread = float(np.nanmax(heading) - np.nanmin(heading))
    fast = usual_speed(of.value, of.time) > MAX_TURN_RATE and spread > 2.02 * np.pi
    if degrees or fast or size.max() > MAX_HEADING:
        return Unit(DEGREE, " in degrees, by its size", True)
    if 1.0 < spread < 2.02 * np.pi:
        sure = bool(np.nanmax(np.abs(np.diff(heading)), initial=0.0) > MIN_WRAP_RAD)
        return Unit(1.0, " in rad, by its size", sure)
    raise of.asked(
        f"angles ({', '.join(of.key)}) up to {size.max():.3g} without a unit (rad or degrees?)",
        EXPECTED_ANGLES,
        large=spread > 1.0,
    )
