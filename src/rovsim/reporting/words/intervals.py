"""Say fitted values with their 95 % intervals."""

import math

from rovsim.core.normal import Z_95
from rovsim.core.signs import minus
from rovsim.reporting.units import unit
from rovsim.reporting.wording import significant
from rovsim.results.base import or_nan
from rovsim.results.fitted import FittedValue


def interval(value: FittedValue) -> str:
    """Return a fitted value with its 95 % interval and unit as text: "0.181 ± 0.002 s"."""
    half = Z_95 * or_nan(value.std)
    if not math.isfinite(half) or half <= 0.0:
        return f"{significant(or_nan(value.value), 4)} {unit(value.unit)}".strip()
    places = max(0, 1 - math.floor(math.log10(half)))
    number = minus(f"{or_nan(value.value):.{places}f}")
    return f"{number} ± {half:.{places}f} {unit(value.unit)}".strip()


def differs_from_zero(value: FittedValue) -> bool:
    """Whether a fitted value's 95 % interval excludes zero; False where it has no interval."""
    return abs(or_nan(value.value)) > Z_95 * or_nan(value.std) > 0.0
