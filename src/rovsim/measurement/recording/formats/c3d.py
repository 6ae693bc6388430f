"""Read C3D files that hold rigid bodies (the group ROTATION), not only markers.

Bytes are parsed here, because ezc3d 1.7.2 ends the whole process on damaged files (aborts and
segmentation faults in 2 of 80). The format: c3d.org user guide, sections "parameter section" and
"rotation data". It has blocks of 512 bytes; each rotation is a 4 x 4 matrix, column by column, and
a reliability, which is negative where the body was not seen.
"""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_matrix
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.attitudes import finite_rows, orthonormal
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.foreign import read_by
from rovsim.measurement.recording.readers import MocapReader, choose_body
from rovsim.measurement.recording.repairs import MotionRepairs
from rovsim.measurement.recording.signature import FileSignature

BLOCK_BYTES, C3D_KEY = 512, 0x50
INTEL_PROCESSOR, SUN_PROCESSOR = 84, 86  # processor types; 85 is DEC, with floats of its own
NUMBERS_PER_ROTATION = 17
METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
RE_EXPORT = "Export rigid bodies (rotations) with the file, or another format that holds them."

Values = list[float] | list[str]


@dataclass(frozen=True)
class Content:
    """A C3D file in memory.

    Attributes:
        path: the file.
        raw: its bytes.
        order: their byte order, as `struct` writes it (< or >).
        parameters: values by `GROUP:NAME`.
    """

    path: Path
    raw: bytes
    order: str
    parameters: dict[str, Values]

    def number(self, name: str) -> float:
        """Return the first value of a numeric parameter.

        Raises:
            BadInput: there is no such parameter.
        """
        values = self.parameters.get(name)
        if values and not isinstance(values[0], str):
            return float(values[0])
        raise BadInput(
            f"no parameter {name}", where=self.path, expected="a number", remedy=RE_EXPORT
        )


def read_c3d(path: Path, mocap: Mocap) -> Export:
    """Read one rigid body; frames in which it was not seen are marked.

    Raises:
        BadInput: not a C3D file, no rigid bodies in it, or not the one that was asked for.
    """
    with read_by("C3D", path, "a whole C3D file", RE_EXPORT):
        content = _open(path)
        names = _bodies(content)
        body = names.index(choose_body(names, mocap.body, content.path))
        rate = content.number("ROTATION:RATE")
        if not (np.isfinite(rate) and rate > 0):
            raise _refused(path, f"ROTATION:RATE is {rate:g}", "the capture rate in Hz")
        table, cut_lines = _rotations(content, len(names))
        R = table[:, body, :16].reshape(-1, 4, 4).transpose(0, 2, 1)
        position = R[:, :3, 3] * _metres(content)
        visible = finite_rows(table[:, body]) & (table[:, body, 16] >= 0.0)
        valid = visible & orthonormal(R[:, :3, :3])
        attitude = from_matrix(np.where(valid[:, None, None], R[:, :3, :3], np.eye(3)))
        repairs = MotionRepairs(cut_lines=cut_lines, bad_rotations=int(np.sum(visible & ~valid)))
        time = np.arange(len(table)) / rate
        return Export(time, position, attitude, valid, rate, repairs=repairs)


def _refused(path: Path, found: str, expected: str) -> BadInput:
    return BadInput(found, where=path, expected=expected, remedy=RE_EXPORT)


def _open(path: Path) -> Content:
    raw = path.read_bytes()
    if len(raw) < 2 * BLOCK_BYTES or raw[1] != C3D_KEY or raw[0] < 1:
        problem = "the file is empty" if not raw else "it does not start as a C3D file does"
        raise _refused(path, problem, "a C3D file")
    start = (raw[0] - 1) * BLOCK_BYTES
    processor = raw[start + 3]
    if processor not in (INTEL_PROCESSOR, SUN_PROCESSOR):
        raise _refused(path, f"processor type {processor}", "84 (Intel) or 86 (Sun)")
    order = "<" if processor == INTEL_PROCESSOR else ">"
    return Content(path, raw, order, _parameters(raw, start + 4, order))


def _parameters(raw: bytes, at: int, order: str) -> dict[str, Values]:
    """Read all parameters; a group may be defined before or after its parameters.

    Args:
        raw: bytes of the file.
        at: place of the first group or parameter.
        order: byte order, as `struct` writes it.
    """
    groups: dict[int, str] = {}
    entries: list[tuple[int, str, Values]] = []
    while raw[at] and (length := abs(struct.unpack_from("b", raw, at)[0])):
        number = struct.unpack_from("b", raw, at + 1)[0]
        name = raw[at + 2 : at + 2 + length].decode("ascii", "replace").upper()
        link = at + 2 + length
        step = struct.unpack_from(order + "h", raw, link)[0]
        if number < 0:
            groups[-number] = name
        else:
            entries.append((number, name, _values(raw, link + 2, order)))
        if step <= 2:  # the last one; a damaged small step would repeat the same place for ever
            break
        at = link + step
    return {f"{groups.get(number, '?')}:{name}": values for number, name, values in entries}


def _values(raw: bytes, at: int, order: str) -> Values:
    kind, count = struct.unpack_from("bB", raw, at)
    sizes = list(raw[at + 2 : at + 2 + count])
    total = int(np.prod(sizes)) if sizes else 1
    start = at + 2 + count
    if kind == -1:
        width = sizes[0] if sizes else 1
        text = raw[start : start + total].decode("utf-8", "replace")
        return [text[k : k + width].strip(" \0") for k in range(0, total, max(width, 1))]
    code = {1: "B", 2: "h", 4: "f"}[kind]
    return [float(v) for v in struct.unpack_from(f"{order}{total}{code}", raw, start)]


def _bodies(content: Content) -> list[str]:
    if "ROTATION:USED" not in content.parameters:
        raise _refused(content.path, "markers alone, no rigid bodies", "a group ROTATION")
    count = int(content.number("ROTATION:USED"))
    labels = [str(label) for label in content.parameters.get("ROTATION:LABELS", [])]
    if count < 1:
        raise _refused(content.path, "no rigid bodies", "at least one in ROTATION:USED")
    return [labels[k] if k < len(labels) else f"body {k + 1}" for k in range(count)]


def _rotations(content: Content, used: int) -> tuple[Array, int]:
    """Read the rotations (frames, used, 17), and 1 when the file ends before the last frame.

    The last axis holds the 16 numbers of the matrix, column by column, and the reliability.
    """
    ratio = content.parameters.get("ROTATION:RATIO") or [1.0]
    # unsigned, as the header's count of frames is
    first_frame, last_frame = struct.unpack_from(content.order + "HH", content.raw, 6)
    expected = (last_frame - first_frame + 1) * max(int(float(ratio[0])), 1)
    start = (int(content.number("ROTATION:DATA_START")) - 1) * BLOCK_BYTES
    if start < BLOCK_BYTES:
        raise _refused(content.path, "ROTATION:DATA_START is not behind the header", "a block")
    size = NUMBERS_PER_ROTATION * used
    frames = max(min(expected, (len(content.raw) - start) // (4 * size)), 0)
    values = np.frombuffer(content.raw, content.order + "f4", frames * size, start if frames else 0)
    with np.errstate(invalid="ignore"):  # damaged numbers may be signalling NaN
        table = values.reshape(frames, used, NUMBERS_PER_ROTATION).astype(float)
    return table, int(frames < expected)


def _metres(content: Content) -> float:
    units = content.parameters.get("POINT:UNITS") or ["mm"]
    unit = str(units[0]).lower()
    if unit not in METRES:
        raise _refused(content.path, f"POINT:UNITS is '{units[0]}'", f"one of {', '.join(METRES)}")
    return METRES[unit]


def body_names(path: Path) -> list[str]:
    """List the rigid bodies of a file.

    Raises:
        BadInput: not a C3D file, or no rigid bodies in it.
    """
    with read_by("C3D", path, "a whole C3D file", RE_EXPORT):
        return _bodies(_open(path))


def _recognised(head: bytes) -> bool:
    return len(head) > 2 and head[1] == C3D_KEY and head[0] < 32


MOCAP_READER = MocapReader("c3d", "a C3D file", read_c3d, (FileSignature(_recognised),), body_names)
