"""C3D files of rigid bodies: units, byte orders, bodies, frames without the body."""

import numpy as np
import pytest

from c3ds import c3d_bytes
from recordings import Swim
from rovsim.core.errors import BadInput
from rovsim.core.rotations import matrix
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.formats.c3d import read_c3d

SWIM = Swim.ned(50)


def read(folder, raw, body="BlueROV2"):
    path = folder / "take.c3d"
    path.write_bytes(raw)
    return read_c3d(path, Mocap(format="c3d", body=body, world_axes="z_up", body_axes="flu"))


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("unit", ["mm", "m"])
def test_units_and_byte_orders(tmp_path, order, unit):
    export = read(tmp_path, c3d_bytes(SWIM, unit=unit, order=order), body="")
    np.testing.assert_allclose(export.position, SWIM.position, atol=1e-6)
    np.testing.assert_allclose(matrix(export.attitude), SWIM.rotation, atol=1e-6)
    assert export.rate == pytest.approx(100.0)


def test_the_campaign_chooses_the_body(tmp_path):
    raw = c3d_bytes(SWIM, bodies=("boat", "BlueROV2"))
    np.testing.assert_allclose(read(tmp_path, raw).position, SWIM.position + 1.0, atol=1e-6)
    with pytest.raises(BadInput, match=r"no rigid body 'bot'; the file has boat, BlueROV2.*'boat'"):
        read(tmp_path, raw, "bot")
    with pytest.raises(BadInput, match=r"no rigid body ''"):
        read(tmp_path, raw, "")


def test_frames_without_the_body_are_marked(tmp_path):
    raw = bytearray(c3d_bytes(SWIM))
    start = 3 * 512
    raw[start + 68 * 7 + 64 : start + 68 * 8] = np.float32(-1.0).tobytes()  # its reliability
    raw[start + 68 * 9 : start + 68 * 10] = bytes(68)
    export = read(tmp_path, bytes(raw))
    assert np.flatnonzero(~export.tracked).tolist() == [7, 9]
    assert export.repairs.bad_rotations == 1


def test_a_file_that_ends_early_keeps_its_whole_frames(tmp_path):
    export = read(tmp_path, c3d_bytes(SWIM)[:-100])
    assert len(export.time) == 48
    assert export.repairs.cut_lines == 1


BAD = {
    "empty": (b"", "the file is empty"),
    "another file": (b"PK\x03\x04" * 512, "does not start as a C3D file does"),
    "markers alone": (c3d_bytes(SWIM, rotations=False), "markers alone, no rigid bodies"),
    "a DEC file": (
        c3d_bytes(SWIM)[:515] + bytes([85]) + c3d_bytes(SWIM)[516:],
        "processor type 85",
    ),
    "feet": (c3d_bytes(SWIM).replace(b"mm", b"ft"), "POINT:UNITS is 'ft'"),
    "cut parameters": (c3d_bytes(SWIM)[:540].ljust(1024, b"\x05"), "cannot be read"),
}


@pytest.mark.parametrize("what", BAD)
def test_what_cannot_be_read_is_refused_in_words(tmp_path, what):
    raw, words = BAD[what]
    with pytest.raises(BadInput, match=words):
        read(tmp_path, raw)
