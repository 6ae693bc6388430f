"""Numbers rounded to significant digits."""

import math


def rounded(value: float, digits: int = 6) -> float:
    """Round to so many significant digits; infinities and NaN stay."""
    return float(f"{value:.{digits}g}")


def rounded_or_none(value: float | None, digits: int = 6) -> float | None:
    """Round to so many significant digits; None where it is None or not finite, as in JSON."""
    return None if value is None or not math.isfinite(value) else rounded(value, digits)
