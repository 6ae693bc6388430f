"""Which format a file has, by what stands in it and not by its name."""

from pathlib import Path

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.readers import mocap_readers
from rovsim.measurement.recording.signature import HEAD, Signature, decoded, head_lines

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
FORMATS = "a QTM, Motive, C3D or csv export, a ROS 2 bag or an ArduPilot log"


def sniff(path: Path) -> str:
    """The format, as `mocap.format` calls it; of a folder it is that of a bag.

    Raises:
        BadInput: none of ours; says what it seems to be.
    """
    readers = mocap_readers().values()
    if path.is_dir():
        return next(reader.name for reader in readers if reader.folder)
    with path.open("rb") as file:
        head = file.read(HEAD)
    for reader in readers:
        if reader.general:
            _refuse_known(path, head)
        for signature in reader.signatures:
            if signature.matches(head):
                _check_ending(path, signature)
                return reader.name
    raise _unknown(path, head)


def _check_ending(path: Path, signature: Signature) -> None:
    if signature.endings and path.suffix.lower() not in signature.endings:
        raise BadInput(
            f"{signature.what}, by what stands in it, whose name ends in '{path.suffix}'",
            where=path,
            expected=f"a name that ends in {' or '.join(signature.endings)}",
            remedy="Rename the file.",
        )


def _refuse_known(path: Path, head: bytes) -> None:
    for magic, (what, remedy) in KNOWN.items():
        if head.startswith(magic):
            raise BadInput(what, where=path, expected=FORMATS, remedy=remedy)
    if "".join(head_lines(head)[:1]).startswith(("Trajectories", "PathFileType")):
        raise BadInput(
            "an export of markers (Vicon or TRC), not of rigid bodies",
            where=path,
            expected=FORMATS,
            remedy="Export the rigid body (segment): position and attitude, as csv.",
        )


def _unknown(path: Path, head: bytes) -> BadInput:
    lines, remedy = head_lines(head), "Export the run again in one of these formats."
    if decoded(head) is None:
        found = "binary data of no known kind"
    elif lines:
        found = f"text that starts with {lines[0].strip()[:40]!r}"
    else:
        found, remedy = "the file is empty", "Export it again."
    return BadInput(found, where=path, expected=FORMATS, remedy=remedy)
