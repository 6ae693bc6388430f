"""Tell the format of a file by its first bytes, not by its name."""

import re
from pathlib import Path
from typing import Sequence

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.readers import (
    CommandReader,
    MocapReader,
    command_readers,
    mocap_readers,
)
from rovsim.measurement.recording.signature import HEAD_BYTES, FileSignature, decoded, head_lines
from rovsim.measurement.recording.tables.delimited import is_table

CSV_HINT = "docs/formats.md lists the columns"
# First bytes of files that people take for recordings -> what they are, and what to do about it.
FILE_MAGIC = {
    b"#ROSBAG V": ("a ROS 1 bag", "Turn it into a ROS 2 bag with `rosbags-convert`."),
    b"MATLAB 5.0": ("a MATLAB file", f"Save its signals as csv: {CSV_HINT}."),
    b"\x89HDF": ("an HDF5 file", f"Save its signals as csv: {CSV_HINT}."),
    b"\x1f\x8b": ("a gzip archive", "Unpack it."),
    b"\x93NUMPY": ("a NumPy array", f"Save it as csv: {CSV_HINT}."),
    b"\x89PNG": ("a picture", "Name a recording."),
    b"%PDF": ("a PDF", "Name a recording."),
    b"\xff\xfe": ("text in UTF-16", "Save it as UTF-8."),
    b"\xfe\xff": ("text in UTF-16", "Save it as UTF-8."),
    b"ULog": (
        "a log of PX4",
        "Turn it into csv with `ulog2csv` of pyulog, and join what was measured and what was sent "
        f"to the thrusters under our names of columns: {CSV_HINT}. "
        "timestamp is time_us, q[0] is qw.",
    ),
    b"LabVIEW Measurement": (
        "a LabVIEW measurement file",
        "Save the table below its last ***End_of_Header*** as csv, with our names of columns "
        f"(X_Value is time_s): {CSV_HINT}.",
    ),
}
ZIP_MAGIC, MEMBER_OFFSET = b"PK\x03\x04", 30  # where the name of its first member starts
ZIP_KINDS = {
    b".npy": (
        "NumPy arrays (.npz)",
        "Save them as csv: numpy.savetxt(file, table, delimiter=',', header='time_s,x_m,…', "
        f"comments=''); {CSV_HINT}.",
    ),
    b"": ("a zip archive or a spreadsheet", "Unpack it, or save the sheet as csv."),
}
# First lines of exports of Vicon, by what follows.
VICON_MARKERS = ("Trajectories", "PathFileType")
VICON_SECTIONS = ("Objects", "Segments", "Devices", "Joints", "Model Outputs")
TUM_NUMBERS = 8  # a line: time, position, quaternion (x, y, z, w)


def sniff(path: Path) -> str:
    """Tell the format of a file, as campaign.yaml names it; a folder is taken for a bag.

    Raises:
        BadInput: rovsim does not read this format; the message says what the file seems to be.
    """
    motions = mocap_readers().values()
    if path.is_dir():
        return next(reader.name for reader in motions if reader.folder)
    with path.open("rb") as file:
        head = file.read(HEAD_BYTES)
    specific = [reader for reader in motions if not reader.general]
    name = _match(path, head, [*specific, *command_readers().values()])
    if not name:
        _refuse_known(path, head)
        name = _match(path, head, [reader for reader in motions if reader.general])
    if not name:
        raise _unknown(path, head)
    return name


def _match(path: Path, head: bytes, readers: Sequence[MocapReader | CommandReader]) -> str | None:
    """Name the first format whose files begin with such bytes; None where there is none."""
    for reader in readers:
        for signature in reader.signatures:
            if signature.matches(head):
                _check_ending(path, signature)
                return reader.name
    return None


def _readable() -> str:
    """Say which files can be read."""
    motions, logs = mocap_readers().values(), command_readers().values()
    names = [*(reader.what for reader in motions), *(reader.what for reader in logs)]
    *others, last = filter(None, names)
    return f"{', '.join(others)} or {last}"


def _check_ending(path: Path, signature: FileSignature) -> None:
    if signature.endings and path.suffix.lower() not in signature.endings:
        raise BadInput(
            f"{signature.what}, by what stands in it, whose name ends in '{path.suffix}'",
            where=path,
            expected=f"a name that ends in {' or '.join(signature.endings)}",
            remedy="Rename the file.",
        )


def _refuse_known(path: Path, head: bytes) -> None:
    matches = [match for magic, match in FILE_MAGIC.items() if head.startswith(magic)]
    if head.startswith(ZIP_MAGIC):
        size = int.from_bytes(head[26:28], "little")
        matches = [
            ZIP_KINDS[
                b".npy" if head[MEMBER_OFFSET : MEMBER_OFFSET + size].endswith(b".npy") else b""
            ]
        ]
    if not matches and not is_table(head):
        matches = [text] if (text := _known_text(head_lines(head))) else []
    for match in matches:
        raise BadInput(match[0], where=path, expected=_readable(), remedy=match[1])


def _known_text(lines: list[str]) -> tuple[str, str] | None:
    """Tell by its first line what a text is, and what to do about it; None where unknown."""
    line = lines[0].strip() if lines else ""
    if line.startswith(VICON_MARKERS):
        return (
            "an export of markers (Vicon or TRC), not of rigid bodies",
            "Export the rigid body (segment): position and attitude, as csv.",
        )
    if line.rstrip(",;") in VICON_SECTIONS:
        return (
            f"a csv export of Vicon that starts with {line.rstrip(',;')}",
            "Export the object (segment) and save it as csv with our columns: time_s is (Frame − "
            "1) over the rate in its second line, x_m, y_m, z_m are TX, TY, TZ / 1000, and qx, qy, "
            "qz, qw are scipy's Rotation.from_rotvec of RX, RY, RZ, a rotation vector.",
        )
    if _is_tum(line):
        return (
            "text of eight numbers a line (a trajectory as TUM writes it)",
            "Put the line time_s,x_m,y_m,z_m,qx,qy,qz,qw above, and commas for the spaces.",
        )
    return None


def _is_tum(line: str) -> bool:
    try:
        return len([float(cell) for cell in line.split()]) == TUM_NUMBERS
    except ValueError:
        return False


def _begins_as_text(head: bytes) -> bool:
    """Whether bytes begin with lines of text, and a NUL comes later."""
    text = decoded(head.partition(b"\0")[0]) or ""
    return "\n" in text and all(c.isprintable() or c in "\r\n\t" for c in text)


def _unknown(path: Path, head: bytes) -> BadInput:
    lines, remedy = head_lines(head), f"Export the run as {_readable()}."
    if decoded(head) is None:
        problem = "binary data of no known kind"
        if _begins_as_text(head):
            problem, remedy = (
                "text with NUL bytes in it, as after a power cut",
                "Remove these bytes.",
            )
    elif len(lines) == 1 and re.search(r"[,;\t]", lines[0]):
        problem, remedy = "a line of column names, and no data below", "Export the run again."
    elif lines:
        problem = f"text that starts with {lines[0].strip()[:40]!r}"
    else:
        problem, remedy = "the file is empty", "Export it again."
    return BadInput(problem, where=path, expected=_readable(), remedy=remedy)
