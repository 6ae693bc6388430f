"""Which format a file has, by what stands in it and not by its name."""

import re
from pathlib import Path

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.c3d import KEY

ENOUGH = 1 << 16  # bytes from the start of a file: more than any header
SQLITE, MCAP, DATAFLASH = b"SQLite format 3\0", b"\x89MCAP", b"\xa3\x95\x80"
MAVLINK = (0xFD, 0xFE)
# First bytes of files that people take for recordings, and what to do about them.
KNOWN = {
    b"#ROSBAG V": ("a ROS 1 bag", "Turn it into a ROS 2 bag with `rosbags-convert`."),
    b"PK\x03\x04": ("a zip archive or a spreadsheet", "Unpack it, or save the sheet as csv."),
    b"MATLAB 5.0": ("a MATLAB file", "Save its signals as csv: docs/formats.md lists the columns."),
    b"\x89HDF": ("an HDF5 file", "Save its signals as csv: docs/formats.md lists the columns."),
    b"\x1f\x8b": ("a gzip archive", "Unpack it."),
    b"\x93NUMPY": ("a NumPy array", "Save it as csv: docs/formats.md lists the columns."),
    b"\x89PNG": ("a picture", "Name a recording."),
    b"%PDF": ("a PDF", "Name a recording."),
}
ENDINGS = {
    SQLITE: ("rosbag2", (".db3",), "a ROS 2 bag (sqlite3)"),
    MCAP: ("rosbag2", (".mcap",), "a ROS 2 bag (MCAP)"),
    DATAFLASH: ("ardupilot", (".bin",), "an ArduPilot dataflash log"),
}
FORMATS = "a QTM, Motive, C3D or csv export, a ROS 2 bag or an ArduPilot log"


def sniff(path: Path) -> str:
    """The format, as `mocap.format` calls it; of a folder it is that of a bag.

    Raises:
        BadInput: none of ours; says what it seems to be.
    """
    if path.is_dir():
        return "rosbag2"
    with path.open("rb") as file:
        start = file.read(ENOUGH)
    for magic, (name, endings, what) in ENDINGS.items():
        if start.startswith(magic):
            return _ending(path, name, endings, what)
    for magic, (what, remedy) in KNOWN.items():
        if start.startswith(magic):
            raise BadInput(what, where=path, expected=FORMATS, remedy=remedy)
    if _telemetry(start):
        return _ending(path, "ardupilot", (".tlog",), "an ArduPilot telemetry log")
    if len(start) > 2 and start[1] == KEY and start[0] < 32:
        return "c3d"
    return _of_text(path, start)


def _ending(path: Path, name: str, endings: tuple[str, ...], what: str) -> str:
    if path.suffix.lower() in endings:
        return name
    raise BadInput(
        f"{what}, by what stands in it, whose name ends in '{path.suffix}'",
        where=path,
        expected=f"a name that ends in {' or '.join(endings)}",
        remedy="Rename the file.",
    )


def _telemetry(start: bytes) -> bool:
    """Whether packets of MAVLink follow times: 8 bytes of us since 1970 before each marker."""
    if len(start) < 20 or start[8] not in MAVLINK:
        return False
    year = int.from_bytes(start[:8], "big") / (365.25 * 86400e6)
    return 30.0 < year < 130.0


def _of_text(path: Path, start: bytes) -> str:
    try:
        # the last character may be cut
        text = start.decode("utf-8-sig", errors="strict" if len(start) < ENOUGH else "ignore")
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:
        raise BadInput(
            "binary data of no known kind",
            where=path,
            expected=FORMATS,
            remedy="Export the run again in one of these formats.",
        )
    lines = [line for line in text.split("\n") if line.strip()]
    lines = [line for line in lines if not line.startswith("#")] or lines
    if not lines:
        raise BadInput("the file is empty", where=path, expected=FORMATS, remedy="Export it again.")
    return _of_lines(path, lines)


def _of_lines(path: Path, lines: list[str]) -> str:
    if lines[0].lstrip('"').startswith("Format Version"):
        return "motive_csv"
    if re.match(r"(NO_OF_FRAMES|FILE_VERSION)\b", lines[0]) or any(
        "Rot[0]" in line for line in lines[:40]
    ):
        return "qtm_tsv"
    if lines[0].startswith(("Trajectories", "PathFileType")):
        raise BadInput(
            "an export of markers (Vicon or TRC), not of rigid bodies",
            where=path,
            expected=FORMATS,
            remedy="Export the rigid body (segment): position and attitude, as csv.",
        )
    if re.search(r"[,;\t]", lines[0]) and len(lines) > 1:
        return "csv"
    raise BadInput(
        f"text that starts with {lines[0].strip()[:40]!r}",
        where=path,
        expected=FORMATS,
        remedy="Export the run again in one of these formats.",
    )
