"""Small C3D files of rigid bodies, packed by hand."""

import struct
from pathlib import Path

import numpy as np

BLOCK = 512


def _record(name: str, group: int, body: bytes, order: str) -> bytes:
    """A group or parameter: names, where the next one is, its content, no description."""
    content = body + b"\0"
    head = struct.pack("bb", len(name), group) + name.encode()
    return head + struct.pack(order + "h", 2 + len(content)) + content


def _numbers(code: str, values, order: str) -> bytes:
    kind = {"h": 2, "f": 4}[code]
    sizes = [len(values)] if len(values) > 1 else []
    packed = struct.pack(f"{order}{len(values)}{code}", *values)
    return struct.pack("bB", kind, len(sizes)) + bytes(sizes) + packed


def _texts(values) -> bytes:
    width = max(map(len, values))
    return (
        struct.pack("bB", -1, 2)
        + bytes([width, len(values)])
        + "".join(value.ljust(width) for value in values).encode()
    )


def c3d_bytes(swim, bodies=("BlueROV2",), unit="mm", order="<", rotations=True) -> bytes:
    """A swim of each body, the later ones shifted by 1 m each."""
    frames, scale = len(swim.time), {"mm": 1e3, "m": 1.0}[unit]
    parameters = _record("POINT", -1, b"", order)
    parameters += _record("UNITS", 1, _texts([unit]), order)
    if rotations:
        rate = 1.0 / float(np.median(np.diff(swim.time)))
        parameters += _record("ROTATION", -2, b"", order)
        parameters += _record("USED", 2, _numbers("h", [len(bodies)], order), order)
        parameters += _record("DATA_START", 2, _numbers("h", [4], order), order)
        parameters += _record("RATE", 2, _numbers("f", [rate], order), order)
        parameters += _record("LABELS", 2, _texts(bodies), order)
    head = bytearray(BLOCK)
    head[:2] = 2, 0x50
    struct.pack_into(order + "5Hf", head, 2, 0, 0, 1, frames, 0, -1.0)
    section = bytes([1, 0x50, 2, 84 if order == "<" else 86]) + parameters + b"\0\0"
    matrices = np.zeros((frames, len(bodies), 17))
    for k in range(len(bodies)):
        whole = np.tile(np.eye(4), (frames, 1, 1))
        whole[:, :3, :3] = swim.rotation
        whole[:, :3, 3] = scale * (swim.position + k)
        matrices[:, k, :16] = whole.transpose(0, 2, 1).reshape(frames, 16)  # by columns
    data = matrices.astype(order + "f4").tobytes()
    return bytes(head) + section.ljust(2 * BLOCK, b"\0") + data


def write_swim(path: Path, swim) -> Path:
    """A file of one rigid body."""
    path.write_bytes(c3d_bytes(swim))
    return path
