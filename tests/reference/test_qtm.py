"""The QTM 6DOF export, as Qualisys writes it and as the practice campaigns hold it."""

import os
from pathlib import Path

import numpy as np
import pytest

from recordings import Swim, qtm_cells, qtm_columns, qtm_header, qtm_lines, write_lines
from rovsim.core.errors import BadInput
from rovsim.core.rotations import matrix
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.quality.assessment import assess
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.formats.qtm_tsv import read_qtm

SHARED = Path(__file__).parents[2] / ".." / "shared"
DATA = Path(os.environ.get("ROVSIM_DATA", SHARED / "data"))
PRACTICE = DATA.parent / "practice"
MOCAP = Mocap(format="qtm_tsv", body="BlueROV2", world_axes="z_up", body_axes="flu")

needs_practice = pytest.mark.skipif(
    not PRACTICE.is_dir(), reason="no practice campaigns beside the data ($ROVSIM_DATA/../practice)"
)


def read(tmp_path, lines, body="BlueROV2"):
    path = write_lines(tmp_path / "run_6D.tsv", lines)
    return read_qtm(path, MOCAP.model_copy(update={"body": body}))


def test_a_frame_written_out_by_hand(tmp_path):
    # a body that looks along world y: its x axis, the first stored column, is (0, 1, 0)
    lines = [
        "FREQUENCY\t50",
        "BODY_NAMES\tBlueROV2",
        "Frame\tTime\tBlueROV2 X\tY\tZ\tRoll\tPitch\tYaw\tResidual\t"
        + "\t".join(f"Rot[{k}]" for k in range(9)),
        "1\t0.00000\t1234.500\t-20.000\t3.000\t0\t0\t0\t0.2\t0\t1\t0\t-1\t0\t0\t0\t0\t1",
    ]
    export = read(tmp_path, lines)
    np.testing.assert_allclose(export.position, [[1.2345, -0.02, 0.003]])
    np.testing.assert_allclose(matrix(export.attitude[0]) @ [1, 0, 0], [0, 1, 0], atol=1e-12)
    assert export.rate == 50.0


def test_the_matrix_counts_and_not_the_euler_angles(tmp_path):
    swim = Swim.ned(50)  # the builder writes nonsense angles
    export = read(tmp_path, qtm_lines(swim))
    np.testing.assert_allclose(matrix(export.attitude), swim.rotation, atol=3e-6)


@pytest.mark.parametrize(("residual", "zeros"), [("-1.000", False), ("0.350", True)])
def test_a_body_that_was_not_found(tmp_path, residual, zeros):
    lines = qtm_lines(Swim.ned(20))
    cells = lines[-5].split("\t")
    if zeros:
        cells[2:] = ["0.000"] * (len(cells) - 2)
    cells[8] = residual
    lines[-5] = "\t".join(cells)
    export = read(tmp_path, lines)
    assert np.flatnonzero(~export.tracked).tolist() == [15]


def test_a_damaged_matrix_counts_as_not_found(tmp_path):
    lines = qtm_lines(Swim.ned(20))
    cells = lines[-5].split("\t")
    cells[9] = "5.0"
    lines[-5] = "\t".join(cells)
    export = read(tmp_path, lines)
    assert np.flatnonzero(~export.tracked).tolist() == [15]
    assert export.repairs.bad_rotations == 1


def several_bodies(swim):
    names = ["Float", "BlueROV2", "Dock 2"]
    lines = [*qtm_header(swim, names), "\t".join(["Frame", "Time", *qtm_columns(names)])]
    for k, t in enumerate(swim.time):
        bodies = [qtm_cells(swim.position[k] + shift, swim.rotation[k]) for shift in (1, 0, 2)]
        lines.append("\t".join([str(k + 1), f"{t:.5f}", *bodies[0], *bodies[1], *bodies[2]]))
    return lines


@pytest.mark.parametrize(("body", "shift"), [("BlueROV2", 0), ("Float", 1), ("Dock 2", 2)])
def test_one_of_several_bodies(tmp_path, body, shift):
    swim = Swim.ned(20)
    export = read(tmp_path, several_bodies(swim), body)
    np.testing.assert_allclose(export.position, swim.position + shift, atol=1e-6)


def without(lines, *names):
    """Drop columns by name, below and including the column line."""
    start = next(k for k, line in enumerate(lines) if "Rot[0]" in line)
    columns = lines[start].split("\t")
    keep = [k for k, name in enumerate(columns) if name not in names]
    cut = ["\t".join(line.split("\t")[k] for k in keep) for line in lines[start:]]
    return lines[:start] + cut


@pytest.mark.parametrize("missing", [("Time",), ("Frame",), ("Frame", "Time")])
def test_frame_and_time_may_be_absent(tmp_path, missing):
    swim = Swim.ned(30)
    export = read(tmp_path, without(qtm_lines(swim), *missing))
    # frame 1 is time 0, as in exports that carry both columns
    np.testing.assert_allclose(export.time, swim.time, atol=1e-9)


def test_newer_headers_events_and_trailing_tabs(tmp_path):
    lines = qtm_lines(Swim.ned(30))
    header = [
        "FILE_VERSION\t2.0.0",
        *reversed(lines[:8]),
        "EVENT\tStart\t11\t0.10000",
        "EVENT\tX Y Z\t12\t0.11000",
    ]
    export = read(tmp_path, [line + "\t" for line in header + lines[8:]])
    plain = read(tmp_path, lines)
    np.testing.assert_array_equal(export.position, plain.position)
    np.testing.assert_array_equal(export.time, plain.time)


def test_a_header_rate_that_is_not_the_rate_of_the_times(tmp_path):
    from recordings import write_run

    folder = write_run(tmp_path)
    text = (folder / "poses.tsv").read_text().replace("FREQUENCY\t100", "FREQUENCY\t200")
    (folder / "poses.tsv").write_text(text)
    recording, anomalies = read_run(load_campaign(folder), "one")
    assert recording.rate == pytest.approx(100.0)
    report = assess(recording, anomalies)
    assert any("FREQUENCY is not the 100 Hz" in remark for remark in report.remarks)


@pytest.mark.skipif(not (DATA / "mocap_exports").is_dir(), reason="no real exports ($ROVSIM_DATA)")
def test_a_real_3d_export_is_refused_with_the_way_out():
    path = DATA / "mocap_exports" / "qualisys_qtm_3D_Measurement1.tsv"
    with pytest.raises(BadInput, match=r"Measurement1\.tsv.*holds 3D data.*data type 6D"):
        read_qtm(path, MOCAP)


@pytest.mark.skipif(not (DATA / "mocap_exports").is_dir(), reason="no real exports ($ROVSIM_DATA)")
def test_a_real_motive_export_named_as_qtm_is_refused():
    path = DATA / "mocap_exports" / "optitrack_motive_v1.21_rigidbody.csv"
    with pytest.raises(BadInput, match=r"rigidbody\.csv.*QTM 6DOF export"):
        read_qtm(path, MOCAP)


@needs_practice
@pytest.mark.parametrize("campaign", sorted(p.name for p in PRACTICE.glob("*") if p.is_dir()))
def test_practice_campaigns_read_whole(campaign):
    loaded = load_campaign(PRACTICE / campaign)
    low, high = loaded.tank_ned().T
    for run in loaded.runs:
        recording, anomalies = read_run(loaded, run.id)
        report = assess(recording, anomalies)
        rows = loaded.mocap_paths(run)[0].read_text().splitlines()[11:]
        lost = sum(row.split("\t")[8] in ("-1", "-1.000") for row in rows)
        assert (report.frames, report.not_found) == (len(rows), lost)
        assert np.isnan(recording.position[~recording.tracked]).all()
        seen = recording.position[recording.tracked]
        inside = ((seen > low) & (seen < high)).all(axis=1)
        assert inside.mean() > 0.99  # the rest are outlier frames
        assert recording.site.tank[2].tolist() == [-3.0, 0.0]  # NED: the surface is zero, z down
        assert np.abs(recording.commands.value).max() <= 0.9 + 1e-9  # the pilot's limit
        assert report.unusable is None
