"""Open an ArduPilot log by the ending of its name."""

from pathlib import Path

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.foreign import read_by
from rovsim.measurement.recording.formats.ardupilot.dataflash import MESSAGE_MARKER, read_dataflash
from rovsim.measurement.recording.formats.ardupilot.series import (
    DOWNLOAD_AGAIN,
    ArduPilotLog,
    no_log,
)
from rovsim.measurement.recording.formats.ardupilot.telemetry import PACKET_OVERHEAD, read_telemetry
from rovsim.measurement.recording.signature import FileSignature, starts_with

READERS = {".bin": read_dataflash, ".tlog": read_telemetry}


def open_log(path: Path) -> ArduPilotLog:
    """Read a log.

    Raises:
        BadInput: it is not a log, or nothing in it can be read.
    """
    ending = path.suffix.lower()
    if ending not in READERS:
        raise no_log(path, f"a file that ends in '{path.suffix}'")
    with read_by("ArduPilot log", path, "a whole log", DOWNLOAD_AGAIN):
        return READERS[ending](path)


def needs(log: ArduPilotLog, names: list[str], what: str) -> BadInput:
    """Make the error for a log without any message of the needed types."""
    return BadInput(
        f"no messages {' or '.join(names)} ({what})",
        where=log.path,
        expected=f"some of them; the log holds {', '.join(sorted(log.series))}",
        remedy="Set LOG_BITMASK (dataflash) or the stream rates (telemetry) so that they are kept.",
    )


def _telemetry(head: bytes) -> bool:
    """Whether a file starts with a time (8 bytes, us since 1970) and the marker of a packet."""
    if len(head) < 20 or head[8] not in PACKET_OVERHEAD:
        return False
    year = int.from_bytes(head[:8], "big") / (365.25 * 86400e6)
    return 30.0 < year < 130.0


SIGNATURES = (
    FileSignature(starts_with(MESSAGE_MARKER + b"\x80"), "an ArduPilot dataflash log", (".bin",)),
    FileSignature(_telemetry, "an ArduPilot telemetry log", (".tlog",)),
)
