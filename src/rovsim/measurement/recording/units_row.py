"""A line of units below the names of columns, as spreadsheets and loggers write it."""

from typing import Sequence

# As they stand at the end of a column's name; what has no such ending is left as it is.
ENDINGS = {
    "s": "s", "sec": "s", "ms": "ms", "ns": "ns", "m": "m", "cm": "cm", "mm": "mm", "rad": "rad",
    "deg": "deg", "°": "deg", "m/s": "m_s", "rad/s": "rad_s", "deg/s": "deg_s", "°/s": "deg_s",
    "m/s2": "m_s2", "m/s^2": "m_s2", "m/s²": "m_s2", "v": "v",
}  # fmt: skip
PLAIN = {
    "",
    "-",
    "1",
    "%",
    "us",
    "µs",
    "μs",
    "n",
    "nm",
    "n m",
    "n*m",
    "a",
    "pa",
    "mbar",
    "hz",
    "rpm",
}


def with_units(
    names: Sequence[str], lines: Sequence[str], header: int, separator: str
) -> tuple[list[str], int]:
    """Names with the units of the line below, if it holds units, and after which line data begin.

    `time` over `s` becomes `time_s`; a name that ends in its unit stays as it is.
    """
    below = next((n for n in range(header + 1, len(lines)) if lines[n].strip()), None)
    if below is None:
        return list(names), header
    units = [cell.strip().strip('"[]()').lower() for cell in lines[below].split(separator)]
    if not any(units) or not all(u in ENDINGS or u in PLAIN - {"1"} for u in units if u):
        return list(names), header
    known = [ENDINGS.get(unit, "") for unit in units] + [""] * len(names)
    return [_ended(name, unit) for name, unit in zip(names, known, strict=False)], below


def _ended(name: str, unit: str) -> str:
    return name if not unit or name.lower().endswith(f"_{unit}") else f"{name}_{unit}"
