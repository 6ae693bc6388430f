"""Read from the header of a file when its recording began."""

import re
from datetime import UTC, datetime
from typing import Callable

from rovsim.measurement.recording.signature import decoded


def reads_time(pattern: str, form: str) -> Callable[[bytes], float | None]:
    """Make a function that reads a local time from the first bytes of a file, as s since 1970.

    It returns None where there is no such time.

    Args:
        pattern: regex with groups for the time without decimals of its seconds, for these decimals
            (they may be missing), and for what follows, if anything does. `^` is any line's start.
        form: of the time without the decimals, for `datetime.strptime`.
    """
    stamp = re.compile(pattern, re.MULTILINE)

    def read(head: bytes) -> float | None:
        match = stamp.search(decoded(head) or "")
        if match is None:
            return None
        seconds, decimals, *rest = match.groups("")
        try:
            began = datetime.strptime("".join((seconds, *rest)), form)
        except ValueError:
            return None
        return began.replace(tzinfo=UTC).timestamp() + float(decimals or 0.0)

    return read
