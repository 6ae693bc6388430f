"""A log by the ending of its name."""

from pathlib import Path

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.ardupilot.dataflash import read_dataflash
from rovsim.measurement.recording.ardupilot.series import RE_RECORD, Log, no_log
from rovsim.measurement.recording.ardupilot.telemetry import read_telemetry
from rovsim.measurement.recording.foreign import read_by

READERS = {".bin": read_dataflash, ".tlog": read_telemetry}


def open_log(path: Path) -> Log:
    """Read a log.

    Raises:
        BadInput: it is none, or nothing in it can be read.
    """
    ending = path.suffix.lower()
    if ending not in READERS:
        raise no_log(path, f"a file that ends in '{path.suffix}'")
    with read_by("ArduPilot log", path, "a whole log", RE_RECORD):
        return READERS[ending](path)


def needs(log: Log, names: list[str], what: str) -> BadInput:
    """The message for a log without any of the types of messages that tell something."""
    return BadInput(
        f"no messages {' or '.join(names)} ({what})",
        where=log.path,
        expected=f"some of them; the log holds {', '.join(sorted(log.series))}",
        remedy="Set LOG_BITMASK (dataflash) or the stream rates (telemetry) so that they are kept.",
    )
