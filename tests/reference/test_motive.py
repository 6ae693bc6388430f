"""Motive exports: the real one, angles, units, and axes that the file does not tell."""

import os
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recordings import Swim, campaign_content, motive_lines, write_campaign, write_lines, write_run
from rovsim.core.errors import BadInput
from rovsim.core.rotations import matrix
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.formats.motive_csv import read_motive

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("ROVSIM_DATA", ROOT / ".." / "shared" / "data")) / "mocap_exports"
TAKE = DATA / "optitrack_motive_v1.21_rigidbody.csv"
MOCAP = Mocap(format="motive_csv", body="BlueROV2", world_axes="z_up", body_axes="flu")
SWIM = Swim.ned(50)
# Y up, right-handed: what is (x, y, z) with z up is (x, z, -y)
Y_UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])


def test_without_a_name_the_only_body_is_read(tmp_path):
    path = write_lines(tmp_path / "take.csv", motive_lines(SWIM))
    assert read_motive(path, MOCAP.model_copy(update={"body": ""})).tracked.all()


@pytest.mark.parametrize("order", ["XYZ", "ZYX", "YZX"])
@pytest.mark.parametrize(("unit", "scale"), [("Meters", 1.0), ("Centimeters", 100.0)])
def test_angles_are_relative_in_the_order_of_the_header(tmp_path, order, unit, scale):
    lines = motive_lines(SWIM)
    lines[0] = lines[0].replace("Quaternion", order).replace("Millimeters", unit)
    kept = [0, 1, 2, 3, 4, *range(6, 10)]  # one column of rotation less
    angles = Rotation.from_matrix(SWIM.rotation).as_euler(order, degrees=True)
    columns = [order.index(axis) for axis in "XYZ"]  # the file has X, Y, Z whatever the order
    for n in range(2, len(lines)):
        cells = lines[n].split(",")
        if n >= 8:
            cells[2:5] = [f"{angle:.7f}" for angle in angles[n - 8, columns]]
            cells[6:9] = [f"{scale * p:.7f}" for p in SWIM.position[n - 8]]
        lines[n] = ",".join(cells[k] for k in kept)
    export = read_motive(write_lines(tmp_path / "take.csv", lines), MOCAP)
    np.testing.assert_allclose(export.position, SWIM.position, atol=1e-6)
    np.testing.assert_allclose(matrix(export.attitude), SWIM.rotation, atol=1e-7)


@pytest.mark.parametrize("body", ["flu", "fur"])
def test_y_up_is_turned_and_everything_else_is_told_to_check_it(tmp_path, body):
    upright = SWIM.along("z_up", "flu")
    axes = Y_UP if body == "fur" else np.eye(3)
    lying = Swim(SWIM.time, upright.position @ Y_UP.T, Y_UP @ upright.rotation @ axes.T)
    folder = write_run(tmp_path, "motive_csv")
    write_lines(folder / "take.csv", motive_lines(lying))
    content = campaign_content("motive_csv")
    content["mocap"] |= {"world_axes": "y_up", "body_axes": body}
    recording, anomalies = read_run(load_campaign(write_campaign(folder, content)), "one")
    np.testing.assert_allclose(recording.position, SWIM.position, atol=1e-6)
    np.testing.assert_allclose(matrix(recording.attitude), SWIM.rotation, atol=3e-6)
    assert anomalies.notes == ()
    assert any("y up" in note for note in read_motive(folder / "take.csv", MOCAP).notes)


def test_y_up_is_for_motive_alone(tmp_path):
    folder = write_run(tmp_path)
    content = campaign_content()
    content["mocap"]["world_axes"] = "y_up"
    with pytest.raises(BadInput, match=r"'y_up' with 'mocap.format: qtm_tsv'"):
        load_campaign(write_campaign(folder, content))


def test_frames_without_the_body_have_empty_cells(tmp_path):
    lines = motive_lines(SWIM)
    lines[20] = ",".join([*lines[20].split(",")[:2], *[""] * 8])
    export = read_motive(write_lines(tmp_path / "take.csv", lines), MOCAP)
    assert np.flatnonzero(~export.tracked).tolist() == [12]


def test_versions_with_other_lines_of_names_are_read(tmp_path):
    lines = motive_lines(SWIM)
    # 1.21 has neither words at the left nor parents; 1.24 may have a column of time code
    old = [
        line.replace(",Type,", ",,").replace(",Name,", ",,").replace(",ID,", ",,")
        for k, line in enumerate(lines)
        if k != 5
    ]
    assert read_motive(write_lines(tmp_path / "old.csv", old), MOCAP).tracked.all()
    new = lines[:2]
    for k, line in enumerate(lines[2:]):
        first, second, rest = line.split(",", 2)
        new.append(",".join([first, second, "TimeCode" if k == 5 else "", rest]))
    export = read_motive(write_lines(tmp_path / "new.csv", new), MOCAP)
    np.testing.assert_allclose(export.position, SWIM.position, atol=1e-6)


@pytest.mark.skipif(not TAKE.is_file(), reason="no real Motive export ($ROVSIM_DATA)")
def test_a_real_take():
    export = read_motive(TAKE, MOCAP.model_copy(update={"body": "Rigid Body 1"}))
    assert len(export.time) == 250
    assert export.tracked.all()
    assert export.rate == 120.0
    np.testing.assert_allclose(np.diff(export.time), 1 / 120.0, atol=2e-6)
    np.testing.assert_allclose(export.position[-1], [0.060349, 0.019146, 0.076408])
    np.testing.assert_allclose(
        matrix(export.attitude[-1]), np.eye(3), atol=1e-3
    )  # its quaternion is (-0.00004, -0.00015, 0.00002, -1)
