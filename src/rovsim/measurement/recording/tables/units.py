"""Units of columns as loggers write them, behind the names or in a separate line below."""

import re
from typing import Sequence

import numpy as np

DEGREE = np.pi / 180.0
# Factor of each unit that turns a number into SI: s, m, rad and their quotients.
TIME_FACTORS = {"h": 3600.0, "min": 60.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
SI_FACTORS = {
    **TIME_FACTORS,
    "m": 1.0, "cm": 1e-2, "mm": 1e-3, "rad": 1.0, "deg": DEGREE,
    "m_s": 1.0, "cm_s": 1e-2, "mm_s": 1e-3, "rad_s": 1.0, "deg_s": DEGREE,
}  # fmt: skip
UNCONVERTED_UNITS = {"m_s2", "v"}  # read as they are
UNIT_SPELLINGS = {
    "hours": "h", "minutes": "min", "mins": "min", "sec": "s", "secs": "s", "second": "s",
    "seconds": "s", "milliseconds": "ms", "msec": "ms", "microseconds": "us", "usec": "us",
    "nanoseconds": "ns", "nsec": "ns", "metre": "m", "metres": "m", "meter": "m", "meters": "m",
    "millimetre": "mm", "millimetres": "mm", "millimeter": "mm", "millimeters": "mm",
    "centimetre": "cm", "centimetres": "cm", "centimeter": "cm", "centimeters": "cm",
    "radian": "rad", "radians": "rad", "degree": "deg", "degrees": "deg", "°": "deg",
    "m/s": "m_s", "mps": "m_s", "cm/s": "cm_s", "mm/s": "mm_s", "rad/s": "rad_s", "rads": "rad_s",
    "deg/s": "deg_s", "°/s": "deg_s", "°_s": "deg_s", "dps": "deg_s",
    "m/s2": "m_s2", "m/s^2": "m_s2", "m/s²": "m_s2",
}  # fmt: skip
# Further words in a line of units, for columns that are no measured channels.
OTHER_UNITS = {
    "", "-", "1", "%", "us", "n", "nm", "n m", "n*m", "a", "pa", "mbar", "bar", "hz", "rpm",
}  # fmt: skip
TIME_NAME = re.compile(r"t|.*(time|stamp).*", re.IGNORECASE)
MICRO_SIGNS = str.maketrans("µμ", "uu")


def find_unit_of(text: str) -> str:
    """The unit that a text means, of `SI_FACTORS` or `UNCONVERTED_UNITS`; empty if it is none."""
    text = text.strip().strip('"[]()').strip().lower().translate(MICRO_SIGNS)
    text = UNIT_SPELLINGS.get(text, text)
    return text if text in SI_FACTORS or text in UNCONVERTED_UNITS else ""


def split_unit(name: str) -> tuple[str, str]:
    """Split the name of a column into the bare name, as `in_words` writes it, and its unit."""
    text = in_words(name.strip().lstrip("%")).translate(MICRO_SIGNS)
    for unit in _UNITS_BY_LENGTH:
        if text.endswith(f"_{unit}"):
            return text.removesuffix(f"_{unit}"), UNIT_SPELLINGS.get(unit, unit)
    return text, ""


_UNITS_BY_LENGTH = sorted((*SI_FACTORS, *UNIT_SPELLINGS), key=len, reverse=True)


def in_words(name: str) -> str:
    """Write a name in lower case, with underscores for blanks, dots, slashes and brackets."""
    return re.sub(r"[\s.,\[\](){}/]+", "_", name.strip().lower()).strip("_")


def with_units(
    names: Sequence[str], lines: Sequence[str], header: int, separator: str
) -> tuple[list[str], int]:
    """Append the units in the line below the names, if it holds units, to the names.

    `time` over `s` becomes `time_s`; a name that ends in its unit stays as it is.

    Args:
        names: the column names.
        lines: all lines of the file.
        header: index of the line of names.
        separator: what separates cells.

    Returns:
        The names, and the index of the line below which the data begin.
    """
    below = next((n for n in range(header + 1, len(lines)) if lines[n].strip()), None)
    if below is None:
        return list(names), header
    cells = [cell.strip().strip('"[]()').lower() for cell in lines[below].split(separator)]
    units = [find_unit_of(cell) for cell in cells]
    recognised = [
        u or c.translate(MICRO_SIGNS) in OTHER_UNITS - {"1"}
        for u, c in zip(units, cells, strict=True)
    ]
    if not any(cells) or not all(recognised):
        return list(names), header
    padded = units + [""] * len(names)
    return [_ended(name, unit) for name, unit in zip(names, padded, strict=False)], below


def _ended(name: str, unit: str) -> str:
    pulses = unit == "us" and not TIME_NAME.fullmatch(name)
    return name if not unit or pulses or split_unit(name)[1] == unit else f"{name}_{unit}"
