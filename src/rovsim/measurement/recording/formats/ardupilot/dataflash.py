"""Read dataflash logs (.BIN), which describe their own messages.

They are parsed here into arrays: pymavlink makes an object of every message, which takes 13 s where
this takes one (ten minutes of an inertial unit at 400 Hz), and prints warnings about damaged logs.
A test compares the two. The format: ArduPilot, libraries/AP_Logger/README.md; every message is
0xA3 0x95, its type, its fields; type 128 (FMT) describes another type: its length, its name, and
the types and names of its fields.
"""

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.recording.formats.ardupilot.series import ArduPilotLog, Series, no_log

MESSAGE_MARKER = b"\xa3\x95"
FORMAT_ID = 128
# Character of a field -> NumPy type and factor (AP_Logger/README.md, "Format types").
FIELD_TYPES = {
    "a": ("64V", 1.0), "b": ("i1", 1.0), "B": ("u1", 1.0), "h": ("<i2", 1.0), "H": ("<u2", 1.0),
    "i": ("<i4", 1.0), "I": ("<u4", 1.0), "f": ("<f4", 1.0), "d": ("<f8", 1.0), "g": ("<f2", 1.0),
    "n": ("S4", 1.0), "N": ("S16", 1.0), "Z": ("S64", 1.0), "c": ("<i2", 0.01), "C": ("<u2", 0.01),
    "e": ("<i4", 0.01), "E": ("<u4", 0.01), "L": ("<i4", 1e-7), "M": ("u1", 1.0),
    "q": ("<i8", 1.0), "Q": ("<u8", 1.0),
}  # fmt: skip
WANTED_TYPES = ["ATT", "IMU", "BARO", "CTUN", "BAT", "CURR", "XKF1", "XKF4", "NKF1", "NKF4"]
WANTED_TYPES += ["RCOU", "RCIN", "MODE", "MSG"]
INSTANCE_FIELDS = ("I", "C", "Inst", "Instance")  # the number of the sensor, or of the filter


@dataclass(frozen=True)
class Format:
    """Layout of one type of message.

    Attributes:
        name: of the type.
        length: with header, bytes.
        fields: structured NumPy type of its fields.
        factors: what the number of each field is multiplied by.
    """

    name: str
    length: int
    fields: np.dtype | None
    factors: dict[str, float]


class _Index(NamedTuple):
    """Where the messages of a log lie.

    Attributes:
        formats: layout of the messages by their type.
        places: first byte of each message by its type.
        skipped: how many bytes belong to no message.
    """

    formats: dict[int, Format]
    places: dict[int, list[int]]
    skipped: int


def read_dataflash(path: Path) -> ArduPilotLog:
    """Read the messages of the types in `WANTED_TYPES`.

    Raises:
        BadInput: not a dataflash log, or nothing in it can be read.
    """
    raw = path.read_bytes()
    if not raw.startswith(MESSAGE_MARKER):
        raise no_log(path, "the file is empty" if not raw else "it does not start as a .BIN does")
    formats, places, skipped = _index(raw)
    kind_by_name = {form.name: kind for kind, form in formats.items() if form.fields is not None}
    tables = {
        name: _table(raw, formats[kind_by_name[name]], places[kind_by_name[name]])
        for name in WANTED_TYPES
        if name in kind_by_name and places[kind_by_name[name]]
    }
    messages = tables.pop("MSG", None)
    has_text = messages is not None and "Message" in (messages.dtype.names or ())
    texts = b" ".join(messages["Message"]) if messages is not None and has_text else b""
    series = {
        name: signal
        for name, table in tables.items()
        if (signal := _series(table, formats[kind_by_name[name]])) is not None
    }
    if not series:
        raise no_log(path, f"no message of a known type in {len(raw)} bytes")
    notes = (f"{skipped} bytes of the log are damaged and were skipped.",) if skipped else ()
    return ArduPilotLog(path, "dataflash", series, _submarine(texts), notes)


def _submarine(texts: bytes) -> bool | None:
    kinds = (b"ArduSub", b"ArduRover", b"ArduCopter", b"ArduPlane", b"Rover ", b"Blimp")
    vehicle = next((kind for kind in kinds if kind in texts), None)
    return None if vehicle is None else vehicle == b"ArduSub"


def _index(raw: bytes) -> _Index:
    """Find all messages in a log, and skip what is damaged."""
    formats = {FORMAT_ID: Format("FMT", 89, None, {})}
    places: dict[int, list[int]] = defaultdict(list)
    offset = end = 0  # where to look, and where the last message ended
    skipped = 0
    while (offset := raw.find(MESSAGE_MARKER, offset)) >= 0 and offset + 2 < len(raw):
        form = formats.get(raw[offset + 2])
        if form is None or offset + form.length > len(raw):
            offset += 1
            continue
        if raw[offset + 2] == FORMAT_ID:
            _learn(raw[offset + 3 : offset + 89], formats)
        places[raw[offset + 2]].append(offset)
        skipped += offset - end
        offset = end = offset + form.length
    return _Index(formats, places, skipped)


def _learn(body: bytes, formats: dict[int, Format]) -> None:
    """Add the format in a message FMT; a contradictory or repeated one is ignored as damaged."""
    kind, length = body[0], body[1]
    name, codes, columns = (
        part.split(b"\0")[0].decode("ascii", "replace")
        for part in (body[2:6], body[6:22], body[22:])
    )
    names = columns.split(",")
    if kind in formats or length < 4 or any(code not in FIELD_TYPES for code in codes):
        return
    if len(names) != len(codes) or len(set(names)) < len(names) or not all(names):
        return
    fields = np.dtype([(n, FIELD_TYPES[c][0]) for n, c in zip(names, codes, strict=True)])
    if fields.itemsize + 3 == length:
        factors = {n: FIELD_TYPES[c][1] for n, c in zip(names, codes, strict=True)}
        formats[kind] = Format(name, length, fields, factors)


def _table(raw: bytes, form: Format, places: list[int]) -> Array:
    """Messages of one type, at n offsets, as a structured array (n,)."""
    assert form.fields is not None
    data = np.frombuffer(raw, np.uint8)
    body = np.array(places)[:, None] + np.arange(3, form.length)
    return data[body].view(form.fields)[:, 0]


def _series(table: Array, form: Format) -> Series | None:
    """Take the numbers of the first sensor of several; None for messages without times."""
    names = table.dtype.names or ()
    clock = next((n for n in ("TimeUS", "TimeMS") if n in names), None)
    if clock is None:
        return None
    instance = next(
        (n for n in INSTANCE_FIELDS if n in names and table[n].dtype.kind in "iu"), None
    )
    if instance:
        table = table[table[instance] == table[instance].min()]
    time = table[clock] * (1e-6 if clock == "TimeUS" else 1e-3)
    numbers = [n for n in names if table[n].dtype.kind in "iuf"]
    return Series(time, {n: table[n].astype(float) * form.factors[n] for n in numbers})
