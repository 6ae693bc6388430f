"""Csv files as other tools write them: read right, or refused with one message and a way out."""

from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from recordings import Swim, csv_lines, write_lines
from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler, from_matrix, matrix
from rovsim.intake.survey.csv_files import look_into_csv
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.formats.csv import read_csv

MOCAP = Mocap(format="csv", world_axes="ned", body_axes="frd")
SWIM = Swim.ned(frames=400)
LINES = csv_lines(SWIM)
HEAD, ROWS = LINES[0], LINES[1:]
POSE = np.array([row.split(",") for row in ROWS], float)
FREE = "time,x,y,z,roll,pitch,yaw"
ROUND = np.hstack([POSE[:, :4], np.rad2deg(POSE[:, 4:]) % 360.0])
QUATERNIONS = np.hstack([POSE[:, :4], from_matrix(SWIM.rotation)])


def scaled(*factors: float) -> list[str]:
    """Rows with their columns times these."""
    return [",".join(f"{x:.9f}" for x in row) for row in POSE * np.array(factors)]


def stamped(factor: int) -> list[str]:
    """Rows whose times are since 1970, so many to a second."""
    late = (round((1.7e9 + t) * factor) for t in POSE[:, 0])
    return [f"{t},{row.partition(',')[2]}" for t, row in zip(late, ROWS, strict=True)]


def dated(shape: str, zone: str = "") -> list[str]:
    """Rows whose times are dates, or times of day, that pass midnight."""
    begin = datetime(2026, 5, 12, 23, 59, 59, 500_000)
    late = (begin + timedelta(seconds=t) for t in POSE[:, 0])
    each = zip(late, ROWS, strict=True)
    return [f"{t.strftime(shape)}{zone},{row.partition(',')[2]}" for t, row in each]


def every_50th(cell: str) -> list[str]:
    """Rows of which some hold another word in all cells but the time."""
    gone = [f"{row.partition(',')[0]},{','.join([cell] * 6)}" for row in ROWS]
    return [gone[k] if k % 50 == 1 else row for k, row in enumerate(ROWS)]


WRITTEN = {
    "semicolons and decimal commas": [line.replace(",", ";").replace(".", ",") for line in LINES],
    "tabs": [line.replace(",", "\t") for line in LINES],
    "byte order mark": ["\ufeff" + HEAD, *ROWS],
    "remarks": ["# logger 3", "# 2026-05-12", *LINES],
    "names in a remark": [f"# {HEAD}", *ROWS],
    "names again": [*LINES[:200], HEAD, *LINES[200:]],
    "units below": [FREE, "s,m,m,m,rad,rad,rad", *ROWS],
    "other units below": [
        FREE,
        "[s],[mm],[mm],[mm],[deg],[deg],[deg]",
        *scaled(1, *[1e3] * 3, *[180 / np.pi] * 3),
    ],
    "ns in time_s": [HEAD, *stamped(10**9)],
    "ms since 1970": [
        HEAD.replace("time_s", "stamp_ms").replace("stamp", "timestamp"),
        *stamped(1000),
    ],
    "ms in time_s": [HEAD, *scaled(1e3, *[1] * 6)],
    "dates": [HEAD, *dated("%Y-%m-%dT%H:%M:%S.%f")],
    "dates of pandas": [FREE.replace("time", "datetime"), *dated("%Y-%m-%d %H:%M:%S.%f")],
    "dates in quotes": [HEAD, *dated('"%Y-%m-%d %H:%M:%S.%f"')],
    "dates in UTC": [HEAD, *dated("%Y-%m-%dT%H:%M:%S.%f", "Z")],
    "dates in Sweden": [
        FREE.replace("time", "timestamp"),
        *dated("%Y-%m-%d %H:%M:%S.%f", "+02:00"),
    ],
    "dates below names in a remark": [f"# {HEAD}", *dated("%Y-%m-%dT%H:%M:%S.%f")],
    "dates and decimal commas": [
        line.replace(",", ";").replace(".", ",") for line in [HEAD, *dated("%Y-%m-%dT%H:%M:%S.%f")]
    ],
    "times of day": [HEAD, *dated("%H:%M:%S.%f")],
    "quotes": ['"' + line.replace(",", '","') + '"' for line in LINES],
    "blanks": [line.replace(",", " ") for line in LINES],
    "numpy.savetxt": [f"# {HEAD.replace(',', ' ')}", *(row.replace(",", "  ") for row in ROWS)],
    "commas in names": [
        "Time, s;x, m;y, m;z, m;roll, rad;pitch, rad;yaw, rad",
        *(row.replace(",", ";").replace(".", ",") for row in ROWS),
    ],
    "minutes": ["Time [min],x,y,z,roll,pitch,yaw", *scaled(1 / 60, *[1] * 6)],
    "signs of degrees": [
        "Time [s],X [mm],Y [mm],Z [mm],Roll [°],Pitch [°],Yaw [°]",
        *scaled(1, *[1e3] * 3, *[180 / np.pi] * 3),
    ],
    "words of units below": [
        FREE,
        "seconds,metres,metres,metres,radians,radians,radians",
        *ROWS,
    ],
    "angles from 0 to 360": [
        "time_s,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg",
        *(",".join(f"{x:.9f}" for x in row) for row in ROUND),
    ],
    "a second heading": [f"{FREE},heading", *(f"{row},{k % 3}" for k, row in enumerate(ROWS))],
    "a second clock": [f"timestamp,{FREE}", *(f"{7 * k},{row}" for k, row in enumerate(ROWS))],
    "a topic": [
        "__time,/rov/pose/pose/position/x,/rov/pose/pose/position/y,/rov/pose/pose/position/z,"
        "/rov/pose/pose/orientation/w,/rov/pose/pose/orientation/x,/rov/pose/pose/orientation/y,"
        "/rov/pose/pose/orientation/z",
        *(",".join(f"{x:.9f}" for x in row) for row in QUATERNIONS),
    ],
    "no pose is -999": [HEAD, *every_50th("-999")],
    "no pose is NA": [HEAD, *every_50th("NA")],
    "no pose is null": [HEAD, *every_50th("null")],
}


@pytest.mark.parametrize("name", WRITTEN)
def test_what_other_tools_write_is_read_right(tmp_path, name):
    path = write_lines(tmp_path / "run.csv", WRITTEN[name])
    export = look_into_csv(path, tmp_path).tracks[0].export
    seen = np.flatnonzero(export.tracked)
    lost = np.arange(1, 400, 50) if name.startswith("no pose") else []
    np.testing.assert_array_equal(np.delete(np.arange(400), lost), seen)
    np.testing.assert_allclose(export.time - export.time[0], POSE[:, 0], atol=1e-6)
    np.testing.assert_allclose(export.position[seen], SWIM.position[seen], atol=1e-5)
    np.testing.assert_allclose(matrix(export.attitude[seen]), SWIM.rotation[seen], atol=1e-5)


def test_a_filler_is_only_what_nothing_comes_near(tmp_path):
    deep = [f"{0.1 * k:.1f},{999 if k < 3 else 5 * k}" for k in range(190)]
    far = read_csv(write_lines(tmp_path / "a.csv", ["time_s,depth_m", *deep]), MOCAP)
    assert len(far.channels["depth"].time) == 190
    holed = ["time_s,depth_m", *(f"{0.1 * k:.1f},{-999 if k % 9 < 2 else 2}" for k in range(90))]
    found = read_csv(write_lines(tmp_path / "b.csv", holed), MOCAP)
    assert found.channels["depth"].value.max() == found.channels["depth"].value.min() == 2.0
    assert found.notes == ("20 cells of 'depth_m' hold -999: not measured.",)


def test_a_depth_that_is_a_height_is_turned_by_init_and_refused_by_the_reader(tmp_path):
    rows = [f"{0.1 * k:.1f},{-1.0 - 0.01 * k:.2f}" for k in range(100)]
    path = write_lines(tmp_path / "run.csv", ["time_s,depth_m", *rows])
    with pytest.raises(BadInput, match=r"depths from -1.99 to -1 m: heights\?.*positive down"):
        read_csv(path, MOCAP)
    found = look_into_csv(path, tmp_path / "copy")
    assert found.tracks[0].export.channels["depth"].value.min() == pytest.approx(1.0)
    assert "with its sign turned" in found.notes[0]


def with_quaternion(names: str) -> list[str]:
    rows = [",".join(f"{x:.6f}" for x in row) for row in QUATERNIONS]
    return [f"time_s,x_m,y_m,z_m,{names}", *rows]


@pytest.mark.parametrize("turns", [0.0, 1.5], ids=["near north", "all around"])
@pytest.mark.parametrize("wrong", [False, True], ids=["w first", "w last"])
def test_a_quaternion_in_another_order_than_its_names_is_doubted(tmp_path, turns, wrong):
    yaw = np.linspace(-0.3, 0.3 + 2.0 * np.pi * turns, 200)
    q = from_euler(0.1 * np.sin(yaw), 0.1 * np.cos(3.0 * yaw), yaw)
    q = np.roll(q, -1, axis=1) if wrong else q
    rows = [f"{0.1 * k:.1f},0,0,{k},{','.join(f'{x:.6f}' for x in row)}" for k, row in enumerate(q)]
    path = write_lines(tmp_path / "run.csv", ["time_s,x_m,y_m,z_m,qw,qx,qy,qz", *rows])
    doubted = any("x, y, z, w" in note for note in read_csv(path, MOCAP).notes)
    assert doubted == (wrong and turns > 0.0)  # near one heading both orders are upright


ALTERNATING = [(row, row.partition(",")[0]) for row in ROWS]
STAMPS = [f"{int(t)},{round((t % 1) * 1e9)}" for t in POSE[:, 0]]
PLACES = [row.partition(",")[2] for row in ROWS]
REFUSED = {
    "ms at 250 Hz": (
        [FREE, *(f"{4 * k},{place}" for k, place in enumerate(PLACES))],
        r"times \('time'\) in steps of 4 over 1.6e\+03 \(s or ms\?\)",
    ),
    "days of a spreadsheet": ([FREE, *scaled(1e-3 / 86.4, *[1] * 6)], "days .* or minutes"),
    "seconds and nanoseconds": (
        [FREE.replace("time", "secs,nsecs"), *(map(",".join, zip(STAMPS, PLACES, strict=True)))],
        r"time_s = secs \+ 1e-9 \* nsecs",
    ),
    "frames": (
        ["frame,x_m", *(f"{k},{k}" for k in range(9))],
        "divided by the rate of the cam",
    ),
    "times of MATLAB": ([HEAD, *(f"12-May-2026 10:00:{r}" for r in ROWS)], "not written by ISO"),
    "two runs": (
        [*LINES, *ROWS],
        r"2 runs in one file: its times begin anew \(400 samples",
    ),
    "two runs under other names": ([FREE, *ROWS, *ROWS], "run.csv.*2 runs in one file"),
    "two logs of commands": (
        ["time_s,t1,t2", *(f"{0.1 * (k % 200):.1f},{1500 + k},1500" for k in range(400))],
        "2 runs in one file",
    ),
    "two bodies": (
        [f"{HEAD},name", *(f"{r},ROV\n{t},9,9,9,0,0,0,crane" for r, t in ALTERNATING)],
        "2 bodies in one file: it jumps .* where 'name' changes \\(ROV, crane\\)",
    ),
    "rates in deg": (
        ["time_s,p_rad_s", *(f"{0.1 * k:.1f},{30 * np.sin(k)}" for k in range(90))],
        r"values of .* rad/s: deg_s\?",
    ),
    "numbered quaternion": (with_quaternion("q0,q1,q2,q3"), "none says which is w"),
    "dates of no norm": ([HEAD, *(f"12/05/2026 10:00:{r}" for r in ROWS)], "line 2.*by ISO 8601"),
    "afternoons": (
        [HEAD, *dated("%I:%M:%S PM")],
        "line 2, column 'time_s': '.*PM' is a date",
    ),
    "spreadsheet": ([HEAD, *dated("%m/%d/%Y %I:%M PM")], "not written by ISO 8601.*yyyy-mm-dd"),
    "afternoons of another name": (
        [HEAD.replace("time_s", "datetime"), *dated("%Y-%m-%d %I:%M:%S PM")],
        "run.csv, line 2, column 'datetime'",
    ),
    "a word under another name": (
        [HEAD.replace("x_m", "x [m]"), *ROWS[:3], ROWS[3].replace(",", ",oops,", 1), *ROWS[4:]],
        r"run.csv, line 5, column 'x \[m\]': the cell holds 'oops'",
    ),
    "dates, then seconds": ([HEAD, *dated("%Y-%m-%dT%H:%M:%S.%f")[:9], *ROWS], "all as dates"),
    "dates of depths": (
        ["time_s,depth_m", "0.1,2026-05-12T10:00:12", "0.2,1"],
        "Only times may be",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_no_file_says_is_refused_with_a_way_out(tmp_path: Path, name):
    lines, said = REFUSED[name]
    with pytest.raises(BadInput, match=said):
        look_into_csv(write_lines(tmp_path / "run.csv", lines), tmp_path)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ([HEAD, *stamped(10**9)], "ms, us or ns since 1970.*time_ms.*rovsim init"),
        ([HEAD, *scaled(1e3, *[1] * 6)], "steps of 10 s: ms, us or ns"),
        ([HEAD, *scaled(*[1] * 4, *[180 / np.pi] * 3)], "angles up to 11.5: degrees"),
    ],
)
def test_wrong_units_in_known_names_are_refused_by_the_reader(tmp_path, lines, said):
    with pytest.raises(BadInput, match=said):
        read_csv(write_lines(tmp_path / "run.csv", lines), MOCAP)


def test_a_depth_that_may_be_a_height_is_what_that_of_another_file_is(tmp_path):
    deep = [f"{0.1 * k:.1f},{-1.0 - 0.01 * k:.2f}" for k in range(100)]
    shallow = [f"{0.1 * k:.1f},{0.05 - 0.004 * k:.3f}" for k in range(100)]
    one = look_into_csv(write_lines(tmp_path / "a.csv", ["time_s,depth_m", *deep]), tmp_path / "a")
    path = write_lines(tmp_path / "b.csv", ["time_s,depth_m", *shallow])
    alone = look_into_csv(path, tmp_path / "b").tracks[0].export.channels["depth"].value
    beside = look_into_csv(path, tmp_path / "c", one.units).tracks[0].export.channels["depth"].value
    np.testing.assert_allclose(beside, -alone)


def test_labels_that_change_while_one_body_moves_on_are_no_bodies(tmp_path):
    rows = [f"{HEAD},tracked", *(f"{row},{k % 2}" for k, row in enumerate(ROWS))]
    assert look_into_csv(write_lines(tmp_path / "run.csv", rows), tmp_path).tracks
