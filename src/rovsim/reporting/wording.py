"""Names and numbers as people write them."""

import math
from typing import Iterable, Sequence

LONGEST = 40  # letters of a name before its middle is left out
MOST = 8  # names told of many: a line of run ids


def short(name: str, length: int = LONGEST) -> str:
    """Return `name`, its middle left out where it is longer than `length` letters."""
    if len(name) <= length:
        return name
    return f"{name[: length // 2]}…{name[-(length // 2 - 1) :]}"


def several(names: Sequence[str]) -> str:
    """Names that may be hundreds: of many the first ones, and how many more."""
    if len(names) <= MOST + 1:
        return ", ".join(names)
    return f"{', '.join(names[:MOST])} and {len(names) - MOST} more"


def listed(names: Iterable[str]) -> str:
    """Return names as people list them: a, b and c."""
    *first, last = [short(n) for n in names] or [""]
    return f"{', '.join(first)} and {last}" if first else last


def significant(value: float, digits: int = 3) -> str:
    """Return `value` to so many significant figures, without an exponent where it is readable."""
    if not math.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    if not 1e-4 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    places = digits - 1 - math.floor(math.log10(abs(float(f"{value:.{digits - 1}e}"))))
    return f"{round(value, places):.{max(places, 0)}f}"
