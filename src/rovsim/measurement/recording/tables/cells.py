"""Cells of delimited text: numbers, and what stands for "not measured"."""

import numpy as np
from numpy import ndarray as Array

# Words for "not measured", in any case.
MISSING_WORDS = {"", "na", "n/a", "#n/a", "null", "none", "-"}
# What loggers write where a sensor gave nothing; believed where no other value comes near.
FILLER_VALUES = (-999.0, -9999.0, -99999.0, 9999.0, 99999.0)
READING_SHARE = 0.5  # of a filler: a column that reaches so far may mean it


def find_filler(values: Array) -> float | None:
    """Find the number that stands for "not measured" in a column (n,); None if there is none."""
    for filler in FILLER_VALUES:
        is_filler = values == filler
        readings = np.abs(values[~is_filler & np.isfinite(values)])
        if is_filler.sum() > 1 and len(readings) and readings.max() < READING_SHARE * abs(filler):
            return filler
    return None


def is_number(cell: str) -> bool:
    """Whether a cell holds a number or one of the words for "not measured"."""
    try:
        float(cell)
    except ValueError:
        return cell.strip().lower() in MISSING_WORDS
    return True
