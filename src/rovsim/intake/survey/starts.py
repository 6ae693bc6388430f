"""Read from the header of a file when its recording began."""

import re
from datetime import UTC, datetime
from pathlib import Path

from rovsim.measurement.recording.signature import HEAD, decoded

# TIME_STAMP<tab>2026-05-12, 10:14:07.250 of QTM, and of Motive
# Capture Start Time,2026-05-12 10.14.07.250 AM
STAMPS = re.compile(
    r"^TIME_STAMP\t(?P<qtm>\d{4}-\d\d-\d\d, \d\d:\d\d:\d\d(\.\d+)?)"
    r"|Capture Start Time,(?P<motive>\d{4}-\d\d-\d\d \d\d\.\d\d\.\d\d(\.\d+)? [AP]M)",
    re.MULTILINE,
)


def find_start(path: Path) -> float | None:
    """Read the local time at which a motion began, as s since 1970; None where it is not given."""
    if not path.is_file():
        return None
    with path.open("rb") as file:
        match = STAMPS.search(decoded(file.read(HEAD)) or "")
    if match is None:
        return None
    text = match["qtm"] or match["motive"]
    form = "%Y-%m-%d, %H:%M:%S" if match["qtm"] else "%Y-%m-%d %I.%M.%S %p"
    part = re.search(r"(?<=[:.]\d\d[:.]\d\d)\.\d+", text)
    share = part[0] if part else ""
    try:
        began = datetime.strptime(text.replace(share, "", 1) if share else text, form)
    except ValueError:
        return None
    return began.replace(tzinfo=UTC).timestamp() + float(share or 0.0)
