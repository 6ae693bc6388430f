"""Poses and commands in csv files; the published KTH runs where they are at hand."""

import os
from pathlib import Path

import numpy as np
import pytest

from recordings import Swim, csv_lines, write_lines, write_run
from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_matrix, matrix, rotate
from rovsim.measurement.campaign_file import CommandLog, Mocap
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.quality.assessment import assess
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.formats.commands_csv import read_commands
from rovsim.measurement.recording.formats.csv import read_csv

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("ROVSIM_DATA", ROOT / ".." / "shared" / "data"))
MOCAP = Mocap(format="csv", world_axes="ned", body_axes="frd")


def commands(tmp_path, lines, kind="pwm", columns=("t1", "t2")):
    path = write_lines(tmp_path / "commands.csv", lines)
    return read_commands(path, CommandLog(format="csv", kind=kind, columns=list(columns)))


def test_quaternions_are_taken_instead_of_angles(tmp_path):
    swim = Swim.ned(30)
    q = from_matrix(swim.rotation)
    rows = np.column_stack([2.0 * q, swim.time, swim.position])  # any order of columns
    rows[:, :4] /= 1.99  # loosely normalised
    names = "qw,qx,qy,qz,time_s,x_m,y_m,z_m"
    lines = [names, *(",".join(f"{x:.9f}" for x in row) for row in rows)]
    export = read_csv(write_lines(tmp_path / "a.csv", lines), MOCAP)
    np.testing.assert_allclose(matrix(export.attitude), swim.rotation, atol=1e-7)


def test_an_empty_pose_and_a_zero_quaternion_are_not_found(tmp_path):
    lines = [
        "time_s,x_m,y_m,z_m,qw,qx,qy,qz",
        "0.0,1,2,3,1,0,0,0",
        "0.1,,,,,,,",
        "0.2,nan,2,3,1,0,0,0",
        "0.3,0,0,0,0,0,0,0",
    ]
    export = read_csv(write_lines(tmp_path / "a.csv", lines), MOCAP)
    assert export.tracked.tolist() == [True, False, False, False]


def test_euler_order_is_yaw_then_pitch_then_roll(tmp_path):
    lines = ["time_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad", f"0,0,0,0,0.3,0.2,{np.pi / 2}"]
    export = read_csv(write_lines(tmp_path / "a.csv", lines), MOCAP)
    # nose: turned 0.2 up, then a quarter turn to starboard (east); roll leaves it alone
    nose = rotate(export.attitude[0], np.array([1.0, 0, 0]))
    np.testing.assert_allclose(nose, [0, np.cos(0.2), -np.sin(0.2)], atol=1e-12)


def test_pwm_becomes_thruster_commands(tmp_path):
    log = commands(tmp_path, ["time_s,t1,t2", "0,1500,1900", "0.02,1100,1700", "0.04,2000,1500"])
    np.testing.assert_allclose(log.value, [[0, 1], [-1, 0.5], [1, 0]])
    assert log.kind == "thruster"
    assert log.repairs.clipped == 1


def test_demands_go_to_the_axes_they_name(tmp_path):
    lines = ["time_s,yaw,surge", "0,0.5,-0.25"]
    log = commands(tmp_path, lines, "demand", ("yaw", "surge"))
    np.testing.assert_allclose(log.value, [[-0.25, 0, 0, 0, 0, 0.5]])
    six = ["time_s,a,b,c,d,e,f", "0,1,2,3,4,5,6"]
    log = commands(tmp_path, six, "wrench", "abcdef")
    np.testing.assert_allclose(log.value, [[1, 2, 3, 4, 5, 6]])


def test_command_lines_are_sorted_the_last_of_equals_holds_and_empty_ones_go(tmp_path):
    folder = write_run(tmp_path)
    lines = ["time_s,t1,t2", "0.00,1500,1500", "0.04,1520,1500", "0.02,1510,1500", "0.06,1530,1500",
             "0.06,1540,1500", "0.08,,", "0.10,nan,nan", "0.12,1560,1500"]  # fmt: skip
    write_lines(folder / "commands.csv", lines)
    recording, anomalies = read_run(load_campaign(folder), "one")
    np.testing.assert_allclose(recording.commands.time, [0, 0.02, 0.04, 0.06, 0.12])
    np.testing.assert_allclose(400 * recording.commands.value[:, 0], [0, 10, 20, 40, 60])
    counted = (
        anomalies.commands.unsorted,
        anomalies.commands.duplicates,
        anomalies.commands.dropped,
        anomalies.commands.long_steps,
    )
    assert counted == (1, 1, 2, 1)
    remarks = " ".join(assess(recording, anomalies).remarks)
    assert "2 command lines without a value" in remarks
    assert "held over them" in remarks


def test_an_empty_cell_of_a_log_of_changes_means_the_value_before(tmp_path):
    lines = ["time_s,t1,t2", "0.00,,1600", "0.02,1500,", "0.06,1580,", "0.04,,1700", "0.08,,",
             "0.10,nan,1500", "0.12,1540,"]  # fmt: skip
    log = commands(tmp_path, lines)
    np.testing.assert_allclose(log.time, [0.02, 0.06, 0.04, 0.10, 0.12])
    pulses = [[1500, 1600], [1580, 1700], [1500, 1700], [1580, 1500], [1540, 1500]]
    np.testing.assert_allclose(1500 + 400 * log.value, pulses)
    assert log.repairs.dropped == 2  # before t1 had a value, and a line without any
    assert log.notes[0].startswith("5 cells of the commands are empty beside others")


def test_an_input_that_was_not_given_is_not_the_value_before(tmp_path):
    log, lines = radio(["surge", "yaw"], rows=("1500,1900", "65535,1100", ",1300", "1600,"))
    found = read_commands(write_lines(tmp_path / "rc.csv", lines), log)
    np.testing.assert_allclose(found.value[:, [0, 5]], [[0, 1], [0.25, -0.5]])


def test_poses_and_commands_may_share_a_file_with_words_in_it(tmp_path):
    lines = csv_lines(Swim.ned())
    lines = [f"{line},{'t1,mode' if k == 0 else '1600,manual'}" for k, line in enumerate(lines)]
    path = write_lines(tmp_path / "a.csv", lines)
    assert len(read_csv(path, MOCAP).time) == 400
    log = read_commands(path, CommandLog(format="csv", kind="pwm", columns=["t1"]))
    np.testing.assert_allclose(log.value, 0.25)


@pytest.mark.skipif(not (DATA / "kth_tank_2025").is_dir(), reason="no KTH runs ($ROVSIM_DATA)")
@pytest.mark.parametrize("run", ["115750", "114038", "120945", "114603"])
def test_the_kth_runs_are_ned_and_frd(run):
    campaign = load_campaign(ROOT / "campaigns" / "kth_tank_2025")
    recording, anomalies = read_run(campaign, run)
    assert recording.tracked.all()
    assert np.isnan(recording.site.tank).all()
    # Displacement over about 2 s against the exported body velocity turned into the world: same
    # sign on every axis. (Slope 0.98 to 1.03 where the published attitude is reliable.)
    step = np.diff(recording.time)[:, None]
    path = np.cumsum(rotate(recording.attitude, recording.nu[:, :3])[:-1] * step, axis=0)
    moved, expected = (x[13:] - x[:-13] for x in (recording.position[:-1], path))
    for axis in range(3):
        assert np.corrcoef(moved[:, axis], expected[:, axis])[0, 1] > 0.65
    heave, w = recording.commands.value[:, 2], recording.nu[:, 2]
    if heave.any():  # positive down, like w
        assert np.corrcoef(heave, w)[0, 1] > 0.5
    assert assess(recording, anomalies).unusable is None


def radio(columns, axes=(), rows=("1500,1900,1300", "1540,1100,1500")):
    """Lines of a log of pulses, and the section that reads it as demands."""
    log = CommandLog(format="csv", kind="demand", columns=columns, axes=list(axes))
    names = ",".join(log.names)
    return log, [f"time_s,{names}", *(f"{0.1 * k:.1f},{row}" for k, row in enumerate(rows))]


def test_demands_of_a_radio_are_pulses(tmp_path):
    names = ("surge", "heave", "yaw")
    log, lines = radio(["chan5_raw", "-chan3_raw", "chan4_raw"], names)
    found = read_commands(write_lines(tmp_path / "rc.csv", lines), log)
    np.testing.assert_allclose(found.value[:, [0, 2, 5]], [[0, -1, -0.5], [0.1, 1, 0]])
    assert found.notes == ("The demands are pulses in us, read as (pulse - 1500) / 400.",)
    log, lines = radio(list(names))
    said = read_commands(write_lines(tmp_path / "rc.csv", lines), log).notes[0]
    assert "'-heave'" in said


def test_inputs_that_were_not_given_leave_their_line_out(tmp_path):
    rows = ("1500,1900,1300", "0,1100,1500", "1500,65535,1500")
    log, lines = radio(["surge", "sway", "yaw"], rows=rows)
    found = read_commands(write_lines(tmp_path / "rc.csv", lines), log)
    assert (len(found.time), found.repairs.dropped) == (1, 2)


def test_pulses_beside_shares_are_refused(tmp_path):
    log, lines = radio(["surge", "sway", "yaw"], rows=("0.1,1900,1300",))
    with pytest.raises(BadInput, match=r"in \[-1, 1\], or pulses of 800 to 2200 us in all"):
        read_commands(write_lines(tmp_path / "rc.csv", lines), log)
