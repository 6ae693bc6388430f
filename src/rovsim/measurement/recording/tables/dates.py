"""Times that are written as dates or as times of day (ISO 8601), as loggers and pandas do."""

import re
from datetime import UTC, datetime, time
from typing import Iterable

import numpy as np
from numpy import ndarray as Array

DATE = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d")
TIME_OF_DAY = re.compile(r"\d\d:\d\d:\d\d")
# As people, MATLAB and spreadsheets write them: 27.11.2026, 11/27/2026 1:02 PM, 27-Nov-2026.
DATE_SPELLINGS = re.compile(
    r"\d{1,4}([/.-])\d{1,2}\1\d{1,4}\b.*|\d{1,2}-[A-Za-z]{3}-\d{2,4}\b.*|\d{1,2}:\d\d\b.*"
)
DAY = 86_400.0  # s


def is_date(cell: str) -> bool:
    """Whether a cell begins with a date and time, or with a time of day, by ISO 8601."""
    return bool(DATE.match(cell) or TIME_OF_DAY.match(cell))


def resembles_date(cell: str) -> bool:
    """Whether a cell is a date or a time of day in one of several spellings other than ISO 8601."""
    return bool(DATE_SPELLINGS.fullmatch(cell))


def to_seconds(cells: Iterable[str]) -> Array:
    """Convert dates to seconds (n,) since 1970, times of day to seconds since the first midnight.

    Dates without a time zone are taken for UTC. Other texts become NaN.
    """
    seconds = np.array([_seconds(cell) for cell in cells], float)
    midnights = np.diff(seconds, prepend=seconds[:1]) < -0.5 * DAY
    return seconds + DAY * np.cumsum(midnights)


def _seconds(cell: str) -> float:
    try:
        if DATE.match(cell):
            date = datetime.fromisoformat(cell)
            return (date if date.tzinfo else date.replace(tzinfo=UTC)).timestamp()
        time_of_day = time.fromisoformat(cell)
    except ValueError:
        return float("nan")
    seconds = 60.0 * (60.0 * time_of_day.hour + time_of_day.minute) + time_of_day.second
    return seconds + 1e-6 * time_of_day.microsecond
