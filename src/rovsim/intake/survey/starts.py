"""Read from the header of a file when its recording began."""

from pathlib import Path

from rovsim.measurement.recording.readers import mocap_readers
from rovsim.measurement.recording.signature import HEAD_BYTES


def find_start(path: Path) -> float | None:
    """Read the local time at which a motion began, as s since 1970; None where it is not given."""
    if not path.is_file():
        return None
    with path.open("rb") as file:
        head = file.read(HEAD_BYTES)
    starts = (reader.start(head) for reader in mocap_readers().values())
    return next((start for start in starts if start is not None), None)
