"""`rovsim init`: what is written is read back the same; what cannot be used is one message."""

import re
import shutil
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML

import bags
from damage import damaged
from recordings import FORMATS, Swim, command_lines, pose_lines, write_lines, write_poses
from rovsim.apps.cli.main import main
from rovsim.core.errors import RovsimError
from rovsim.core.yaml_files import read_yaml
from rovsim.intake.compose import propose
from rovsim.intake.motions import CommandFile, MotionFile
from rovsim.intake.names import run_ids, run_key
from rovsim.intake.pairing import pair
from rovsim.intake.proposal import ANSWER, CampaignProposal, OpenQuestion
from rovsim.intake.survey import Track
from rovsim.intake.survey.csv_files import look_into_csv
from rovsim.intake.survey.starts import find_start
from rovsim.intake.write import write_proposal
from rovsim.intake.yaml_file import as_yaml
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording.candidates import CommandCandidate
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.readers import mocap_readers
from said import unfolded

NAMES = st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]), min_size=1)
WORDS = st.text("abc :#-'\"[]{},&*!|>%@`0123.nyesNO~", max_size=30)


def refused(capsys, *words) -> str:
    """The one message of a command that must end with exit code 2."""
    with pytest.raises(SystemExit) as ended:
        main(["init", *map(str, words)])
    assert ended.value.code == 2
    said = unfolded(capsys.readouterr().err)
    assert "Traceback" not in said
    return said


@given(name=NAMES, column=WORDS, comments=st.lists(WORDS, max_size=3), asked=st.booleans())
def test_whatever_is_written_is_read_back_the_same(name, column, comments, asked):
    content = {
        "name": name,
        "mocap": {"format": "csv", "world_axes": ANSWER if asked else "ned", "body": column},
        "commands": {"columns": [column, name]},
        "runs": [{"id": name, "mocap": column}, {"id": column, "mocap": name}],
    }
    told = tuple(comments)
    places = ("name", "mocap", "mocap.body", "commands.columns", "runs", "runs.0", "runs.1")
    question = OpenQuestion("mocap.world_axes", f"which? {column}", (("ned", name), (column, "")))
    proposal = CampaignProposal(
        content, dict.fromkeys(places, told), (question,) * asked, checks=told
    )
    assert YAML(typ="safe", pure=True).load(as_yaml(proposal)) == content


@given(st.lists(NAMES, min_size=1, max_size=5))
def test_runs_get_names_that_can_be_file_names_and_differ(stems):
    ids = run_ids(stems)
    assert len({i.casefold() for i in ids}) == len(stems)
    assert all(i and not set(i) & set('/\\:*?"<>|{}') for i in ids)


@pytest.mark.parametrize(
    ("motion", "commands"),
    [
        ("3dof-1_6D", "3dof-1_commands"),
        ("Run 7 mocap", "run_7_pwm"),
        ("dive.3", "dive-3-thrusters"),
    ],
)
def test_names_that_differ_in_their_role_alone_go_together(motion, commands):
    assert run_key(motion) == run_key(commands)


@pytest.mark.parametrize(
    ("header", "start"),
    [
        ("NO_OF_FRAMES\t6000\nTIME_STAMP\t2026-05-12, 20:14:07.250\t812.5\n", 1778616847.25),
        ("Format Version,1.23,Capture Start Time,2026-05-12 08.14.07.250 PM,x\n", 1778616847.25),
        ("TIME_STAMP\t2026-05-12, 20:14:07\n", 1778616847.0),
        ("Format Version,1.23,Capture Start Time,2026-05-12 08.14.07.14 PM\n", 1778616847.14),
        ("TIME_STAMP\t2026-15-12, 20:14:07\n", None),
        ("time_s,x_m\n", None),
    ],
)
def test_the_start_of_a_recording_stands_in_its_header(tmp_path, header, start):
    (tmp_path / "take").write_text(header)
    assert find_start(tmp_path / "take") == start


def pairs(motions, logs, correlation=0.0):
    """The pairs of motions and logs where every motion tells as much of every log."""
    time = np.arange(0.0, 20.0, 0.1)
    drive = CommandCandidate("csv", ("t1",), time, np.zeros((200, 1)), "pwm", "")
    track = Track("", Export(time, *(np.zeros((200, n)) for n in (3, 4)), np.ones(200, bool)))
    return pair(
        [MotionFile(Path(f"{name}.csv"), track) for name in motions],
        [CommandFile(Path(f"{name}.csv"), drive) for name in logs],
        lambda motion, log: correlation,
    )


def paired(motions, logs):
    """Which log each motion gets where the motions tell nothing."""
    return [one.log.path.stem if one.log else None for one in pairs(motions, logs)]


@pytest.mark.parametrize(
    ("motion", "log", "correlation", "reason"),
    [
        ("dive_poses", "dive_pwm", 0.8, "correlation 0.80), and the names agree"),
        ("alpha", "zulu", 0.8, "its commands cause this motion (correlation 0.80)"),
        ("dive_poses", "dive_pwm", 0.0, "by its name"),
        ("alpha", "zulu", 0.0, "the only log beside it"),
    ],
)
def test_a_pair_says_how_it_is_known(motion, log, correlation, reason):
    (found,) = pairs([motion], [log], correlation)
    assert found.log is not None
    assert found.reason.endswith(reason)


def test_names_in_any_language_that_start_alike_go_together():
    logs = ["3dof-2_Stellgroessen", "6dof-1_Stellgroessen", "3dof-1_Stellgroessen"]
    motions = ["3dof-1_Messung", "3dof-2_Messung", "6dof-1_Messung"]
    assert paired(motions, logs) == [logs[2], logs[0], logs[1]]
    assert paired(["run_2_weg", "run_3_weg"], ["run_1_kraft", "run_4_kraft"]) == [None, None]


def test_a_campaign_that_is_there_is_kept_unless_it_is_forced(tmp_path, capsys):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    write_lines(tmp_path / "poses_commands.csv", command_lines(12.0))
    (tmp_path / "campaign.yaml").write_text("name: mine")
    said = refused(capsys, tmp_path)
    assert "campaign.yaml: there is one already" in said
    assert "force=true" in said
    assert (tmp_path / "campaign.yaml").read_text() == "name: mine"
    main(["init", str(tmp_path), "force=true", "-q"])
    assert "format: csv" in (tmp_path / "campaign.yaml").read_text()


def test_recordings_elsewhere_stay_there(tmp_path):
    raw, out = tmp_path / "raw, (a=b) é", tmp_path / "out"
    write_poses(raw, "csv", Swim.ned(frames=1200)) if raw.mkdir() is None else None
    before = sorted(raw.iterdir())
    main(["init", str(raw / "poses.csv"), f"out={out}", "-q"])
    assert sorted(raw.iterdir()) == before
    assert [path.name for path in out.iterdir()] == ["campaign.yaml"]
    text = (out / "campaign.yaml").read_text()
    assert "folder: ../raw" in text
    for place, answer in (("vehicle", "bluerov2"), ("world_axes", "ned"), ("body_axes", "frd")):
        text = text.replace(f"{place}: ANSWER", f"{place}: {answer}")
    (out / "campaign.yaml").write_text(text)
    campaign = load_campaign(out)
    assert campaign.mocap_paths(campaign.runs[0]) == [raw / "poses.csv"]


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("empty.csv", b"", "the file is empty"),
        ("noise.bin", bytes(range(128, 256)) * 40, "binary data of no known kind"),
        ("bag.bag", b"#ROSBAG V2.0" + bytes(99), "a ROS 1 bag"),
        ("book.csv", b"PK\x03\x04" + bytes(99), "a zip archive or a spreadsheet"),
        ("signals.mat", b"MATLAB 5.0 MAT-file" + bytes(99), "a MATLAB file"),
        ("poses.dat", b"SQLite format 3\0" + bytes(99), "whose name ends in '.dat'"),
        ("notes.txt", b"Dear diary", "text that starts with 'Dear diary'"),
        ("walk.csv", b"Trajectories\n100\n,,A\n", "an export of markers"),
        ("rov.csv", b"Objects\n100\n,,ROV\nFrame,Sub Frame,RX,RY,RZ,TX,TY,TZ\n", "rotation vector"),
        ("path.txt", b"# time x\n" + b"0.0 1 2 3 0 0 0 1\n" * 9, "time_s,x_m,y_m,z_m,qx,qy,qz,qw"),
        ("log.ulg", b"ULog\x01\x125\x01" + bytes(99), "`ulog2csv`"),
        ("run.npz", b"PK\x03\x04" + bytes(22) + b"\5\0\0\0t.npy" + bytes(9), "numpy.savetxt"),
        ("run.lvm", b"LabVIEW Measurement\t\nSeparator\tTab\n", "***End_of_Header***"),
        ("bare.csv", b"0.0,1500,1500\n0.1,1510,1500\n", "no line of column names"),
        (
            "clock.csv",
            b"10:14:07.25,1500,1500\n10:14:07.35,1510,1500\n",
            "no line of column names above the values 10:14:07.25, 1500",
        ),
        ("table.csv", b"time_s,colour\n0,red\n1,blue\n", "no measured channel"),
        (
            "timeless.csv",
            b"Unnamed: 0,t1,t2\n0,1500,1500\n1,1510,1600\n",
            "Did you mean 'Unnamed: 0'? If it holds the times, name it time_s",
        ),
        ("pwm.csv", "\n".join(command_lines()).encode(), "commands alone (pwm.csv)"),
        (
            "euler.csv",
            b"t,x,y,z,roll,pitch,yaw\n"
            + b"".join(b"%g,0.1,0.2,%g,0.01,0.02,0.1\n" % (0.1 * k, 0.01 * k) for k in range(40)),
            "rad or degrees?",
        ),
    ],
)
def test_what_cannot_be_used_is_one_message_and_nothing_is_written(
    tmp_path, capsys, name, content, said
):
    path, out = tmp_path / name, tmp_path / "out"
    path.write_bytes(content)
    told = refused(capsys, path, f"out={out}")
    assert said in told
    assert told.count("rovsim: ") == 1
    assert not out.exists()


def test_a_folder_says_what_to_do_about_each_of_its_files(tmp_path, capsys):
    (tmp_path / "pwm.csv").write_text("\n".join(command_lines()))
    for name in ("one.mat", "two.mat"):
        (tmp_path / name).write_bytes(b"MATLAB 5.0 MAT-file" + bytes(99))
    (tmp_path / "run.bag").write_bytes(b"#ROSBAG V2.0" + bytes(99))
    told = refused(capsys, tmp_path)
    assert "one.mat, two.mat: a MATLAB file" in told
    assert "Save its signals as csv" in told
    assert "rosbags-convert" in told
    assert "Name the export" not in told


def test_transforms_that_are_not_read_are_named(tmp_path, capsys):
    kind = "tf2_msgs/msg/TFMessage"
    wrench = "geometry_msgs/msg/WrenchStamped"
    topics = {
        "/tf": (kind, [(bags.START + t, bags.message(kind)) for t in range(9)]),
        "/push": (wrench, [(bags.START + t, bags.message(wrench)) for t in range(9)]),
    }
    told = refused(capsys, bags.write_bag(tmp_path / "bag", topics), f"out={tmp_path / 'out'}")
    assert "commands alone" in told
    assert "/tf are not read" in told


def test_wished_velocities_are_no_commands_and_are_named(tmp_path, capsys):
    kind = "geometry_msgs/msg/Twist"
    topics = {
        "/pose": bags.poses(Swim.ned(frames=1200)),
        "/cmd_vel": (kind, [(bags.START + t, bags.message(kind)) for t in range(9)]),
    }
    main(["init", str(bags.write_bag(tmp_path / "bag", topics)), f"out={tmp_path / 'out'}"])
    assert "/cmd_vel says how fast the vehicle should be" in unfolded(capsys.readouterr().out)


def test_each_bad_file_has_its_own_message(tmp_path, capsys):
    for name in ("one.txt", "two.txt"):
        (tmp_path / name).write_text(f"Dear {name}")
    told = refused(capsys, tmp_path / "one.txt", tmp_path / "two.txt", f"out={tmp_path / 'out'}")
    assert told.count("Dear") == 2


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # numbers near the largest overflow
@pytest.mark.parametrize("name", sorted(mocap_readers()))
def test_damaged_files_are_described_or_refused(tmp_path, name):
    raw = tmp_path / "raw"
    raw.mkdir()
    target = write_poses(raw, name, Swim.ned(frames=60))
    write_lines(raw / "commands.csv", command_lines(1.0, name))
    files = [*(sorted(target.iterdir()) if target.is_dir() else [target]), raw / "commands.csv"]
    random = np.random.default_rng(zlib.crc32(name.encode()))
    for k in range(25):
        file = files[int(random.integers(len(files)))]
        good = file.read_bytes()
        file.write_bytes(damaged(good, random))
        described_or_refused(raw, tmp_path / f"scratch{k}")
        file.write_bytes(good)
    assert FORMATS[name] in described_or_refused(raw, tmp_path / "last")


def described_or_refused(raw: Path, scratch: Path) -> str:
    """What was written, nothing where it was refused."""
    try:
        proposal = propose([raw], raw, scratch)
        text = write_proposal(proposal, raw).read_text()
    except RovsimError:
        return ""
    finally:
        (raw / "campaign.yaml").unlink(missing_ok=True)
        shutil.rmtree(scratch, ignore_errors=True)
    return text


def sensor_lines(column: str, start: float = 0.0) -> list[str]:
    """A csv of one sensor: ten seconds at 10 Hz."""
    return [f"time_s,{column}", *(f"{start + 0.1 * k:.1f},{0.01 * k:.2f}" for k in range(100))]


def taken_for_runs(folder: Path, files: dict[str, list[str]]) -> list[list[str]]:
    """The files of each run, of files that init finds in a folder; their campaign can be read."""
    for name, lines in files.items():
        write_lines(folder / name, lines)
    main(["init", str(folder), "-q"])
    text = (folder / "campaign.yaml").read_text()
    for asked in re.findall(r"(\w+): ANSWER", text):
        known = {"vehicle": "bluerov2", "world_axes": "ned", "body_axes": "frd"}
        text = text.replace(f"{asked}: ANSWER", f"{asked}: {known[asked]}")
    (folder / "campaign.yaml").write_text(text)
    return [run.sensor_files for run in load_campaign(folder).runs]


@pytest.mark.parametrize("name", ["run{}_{}.csv", "{1}{0}.csv", "{1}-dive {0}.csv", "run{}/{}.csv"])
def test_files_whose_names_differ_in_the_sensor_are_one_run(tmp_path, name):
    files = {
        name.format(k, sensor): sensor_lines(column)
        for k in (1, 2, 3)
        for sensor, column in (("depth", "depth_m"), ("imu", "p_rad_s"))
    }
    names = list(files)
    assert taken_for_runs(tmp_path, files) == [sorted(names[k : k + 2]) for k in (0, 2, 4)]
    assert "their names differ in the sensor alone" in told(tmp_path)


def test_clocks_that_go_on_tell_which_files_are_one_run(tmp_path):
    files = {
        "a.csv": sensor_lines("depth_m", 1e3),
        "b.csv": sensor_lines("depth_m", 2e3),
        "c.csv": sensor_lines("p_rad_s", 2e3),
        "d.csv": sensor_lines("p_rad_s", 1e3),
    }
    assert taken_for_runs(tmp_path, files) == [["a.csv", "d.csv"], ["b.csv", "c.csv"]]


def test_where_nothing_tells_which_files_are_one_run_init_says_so(tmp_path):
    files = {f"{n}.csv": sensor_lines("depth_m" if n < "c" else "p_rad_s") for n in "abcd"}
    assert taken_for_runs(tmp_path, files) == [[name] for name in files]
    assert "CHECK: a.csv, b.csv (depth) and c.csv, d.csv (rates): neither names" in told(tmp_path)


def test_one_name_and_two_clocks_are_told(tmp_path):
    files = {
        "run1_depth.csv": sensor_lines("depth_m"),
        "run1_imu.csv": sensor_lines("p_rad_s", 1.7e9),
    }
    assert taken_for_runs(tmp_path, files) == [[name] for name in files]
    assert "look like one run by their names, but runs from 1700000000" in told(tmp_path)


def told(folder: Path) -> str:
    """The text of campaign.yaml on one line."""
    return re.sub(r"\n\s*#\s*", " ", (folder / "campaign.yaml").read_text())


@pytest.mark.parametrize(
    ("names", "columns", "axes"),
    [
        (
            ["chan3_raw", "chan4_raw", "chan5_raw"],
            ["chan5_raw", "-chan3_raw", "chan4_raw"],
            ["surge", "heave", "yaw"],
        ),
        (["surge", "heave", "yaw"], ["surge", "heave", "yaw"], None),
    ],
)
def test_pulses_of_a_radio_are_demands(tmp_path, names, columns, axes):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    time = np.arange(0.0, 12.0, 0.1)
    rows = [f"{t:.1f},{1500 + 300 * np.sin(t):.0f},1500,1600" for t in time]
    write_lines(tmp_path / "poses_rc.csv", [",".join(["time_s", *names]), *rows])
    main(["init", str(tmp_path), "-q"])
    content = YAML(typ="safe", pure=True).load((tmp_path / "campaign.yaml").read_text())
    assert content["commands"]["kind"] == "demand"
    assert content["commands"]["columns"] == columns
    assert content["commands"].get("axes") == axes


def percent(names):
    """A log of commands in percent."""
    rows = [f"{t:.1f},{60 * np.sin(t):.1f},{-80 * np.cos(t):.1f}" for t in np.arange(0, 12, 0.1)]
    return [f"time_s,{names}", *rows]


def test_a_log_in_percent_that_is_left_out_is_to_be_checked(tmp_path, capsys):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    write_lines(tmp_path / "poses_commands.csv", percent("port,starboard"))
    main(["init", str(tmp_path)])
    for said in (told(tmp_path), unfolded(capsys.readouterr().out)):
        assert "CHECK" in said
        assert "not used as commands" in said
        assert "port (-60 to 60), starboard (-80 to 80). They may be percent" in said
        assert "'commands: none'" in said
    assert "percent: divide them by 100" in refused(
        capsys, tmp_path / "poses.csv", tmp_path / "poses_commands.csv", "force=true"
    )


def test_percent_beside_poses_and_of_axes_are_told(tmp_path):
    poses, both, axes = (tmp_path / name for name in ("poses", "both", "axes"))
    for folder in (poses, both, axes):
        folder.mkdir()
    write_poses(poses, "csv", Swim.ned(frames=1200))
    lines = (poses / "poses.csv").read_text().splitlines()
    own = [f"{line},{k % 90 - 40 if k else 'port'}" for k, line in enumerate(lines)]
    write_lines(both / "run.csv", own)
    main(["init", str(both), "-q"])
    assert "CHECK: not used as commands: run.csv: port (-40 to 49). They may be percent" in told(
        both
    )
    write_poses(axes, "csv", Swim.ned(frames=1200))
    write_lines(axes / "poses_commands.csv", percent("surge,yaw"))
    main(["init", str(axes), "-q"])
    assert "beyond -1 and 1 (-80 to 80). If these are percent, divide them by 100" in told(axes)


def test_columns_that_nothing_uses_are_named(tmp_path, capsys):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    lines = (tmp_path / "poses.csv").read_text().splitlines()
    own = [
        f"{line},{k % 7 if k else 'altitude'},{0.1 * k if k else 'gyro_x'}"
        for k, line in enumerate(lines)
    ]
    write_lines(tmp_path / "poses.csv", own)
    write_lines(tmp_path / "poses_commands.csv", command_lines(12.0))
    main(["init", str(tmp_path)])
    assert "not used: altitude, gyro_x (in poses.csv)" in unfolded(capsys.readouterr().out)
    assert "poses.csv: not used: altitude, gyro_x" in told(tmp_path)
    assert "poses_commands.csv: not used" not in told(tmp_path)


@pytest.mark.parametrize(
    ("size", "said"), [(80.0, "percent, divide them by 100"), (800.0, "divide them by 1000")]
)
def test_a_wrench_or_percent_is_asked_and_not_taken(tmp_path, capsys, size, said):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    rows = [
        f"{t:.1f},{size * np.sin(t):.1f},{-size * np.cos(t):.1f}" for t in np.arange(0, 12, 0.1)
    ]
    write_lines(tmp_path / "poses_commands.csv", ["time_s,surge,yaw", *rows])
    main(["init", str(tmp_path)])
    out = unfolded(capsys.readouterr().out)
    content = YAML(typ="safe", pure=True).load((tmp_path / "campaign.yaml").read_text())
    assert content["commands"]["kind"] == content["vehicle"] == ANSWER
    assert said in told(tmp_path)
    assert said in out
    assert "columns of commands: surge, yaw" in out


def test_what_was_taken_and_every_guess_is_printed(tmp_path, capsys):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    main(["init", str(tmp_path)])
    out = unfolded(capsys.readouterr().out)
    guesses = re.findall(r"guess: ([^,;(]{20,40})", told(tmp_path))
    assert guesses
    assert all(guess in out for guess in guesses)


def free_columns(folder: Path, scales: dict[str, tuple[float, float, float]], turns=0.0) -> None:
    """Files with columns without a unit: metres, tilt and yaw times these."""
    time = np.arange(0.0, 30.0, 0.05)
    for name, (metres, tilt, yaw) in scales.items():
        place = metres * np.stack([0.8 * np.sin(0.7 * time), np.cos(0.5 * time), 0.1 * time])
        heading = 0.4 * np.sin(time) + 2.0 * np.pi * turns * time / 30.0
        angles = [0.1 * tilt * np.sin(time), 0.1 * tilt * np.cos(time), yaw * heading]
        rows = np.column_stack([time, *place, *angles])
        lines = (",".join(f"{v:.5f}" for v in row) for row in rows)
        write_lines(folder / name, ["t,x,y,z,roll,pitch,yaw", *lines])


def test_radians_that_count_their_turns_are_asked_for_in_a_folder_too(tmp_path, capsys):
    free_columns(tmp_path, {"a.csv": (1, 1, 1), "b.csv": (1, 1, 1)}, turns=2.5)
    said = refused(capsys, tmp_path)
    assert said.count("rad or degrees?") == 2
    assert not (tmp_path / "campaign.yaml").exists()


def test_a_unit_that_one_file_tells_holds_in_all(tmp_path, capsys):
    (tmp_path / "raw").mkdir()
    wide = (1.0, 50.0, 57.3)  # a roll of five degrees is no roll of five rad
    free_columns(tmp_path / "raw", {"a.csv": wide, "b.csv": (1.0, 10.0, 3.0)})
    main(["init", str(tmp_path / "raw")])
    out = unfolded(capsys.readouterr().out)
    assert "'yaw' is yaw in degrees, by its size" in out
    assert "'yaw' is yaw in degrees, as in a.csv" in out


def test_a_heading_in_degrees_beside_tilts_in_radians_is_asked_for(tmp_path, capsys):
    free_columns(tmp_path, {"a.csv": (1, 1, 57.3)}, turns=8)
    text = (tmp_path / "a.csv").read_text().replace("roll,pitch,yaw", "roll_rad,pitch_rad,yaw_rad")
    (tmp_path / "a.csv").write_text(text)
    assert "are all of them of one unit?" in refused(capsys, tmp_path)


@pytest.mark.parametrize(("scale", "asked"), [(100.0, True), (1000.0, False)])
def test_centimetres_are_no_millimetres(tmp_path, capsys, scale, asked):
    free_columns(tmp_path, {"a.csv": (scale, 1, 1), "b.csv": (scale, 1, 1)}, turns=0.4)
    if asked:
        assert refused(capsys, tmp_path).count("mm or cm?") == 2
        return
    main(["init", str(tmp_path)])
    assert "'x' is x in mm, by its size" in unfolded(capsys.readouterr().out)


def test_several_runs_in_one_file_are_refused(tmp_path, capsys):
    write_poses(tmp_path, "csv", Swim.ned(frames=600))
    head, *rows = (tmp_path / "poses.csv").read_text().splitlines()
    lines = [f"run,{head}", *(f"{run},{row}" for run in ("dive-1", "dive-2") for row in rows)]
    write_lines(tmp_path / "poses.csv", lines)
    said = refused(capsys, tmp_path)
    assert "2 runs in one file: its times begin anew where 'run' changes (dive-1, dive-2)" in said
    assert "Split it by 'run'" in said


def write_day(folder: Path, pauses: list[float], seconds: float = 12.0) -> None:
    """One file of poses and one log, of swims with these pauses between them."""
    poses, log, begin = [], [], 0.0
    for pause in [0.0, *pauses]:
        begin += pause
        head, *rows = pose_lines("csv", Swim.ned(frames=int(100 * seconds)))
        named, *pulses = command_lines(seconds)
        poses += [shifted(row, begin) for row in rows]
        log += [shifted(row, begin) for row in pulses]
        begin += seconds
    write_lines(folder / "day.csv", [head, *poses])
    write_lines(folder / "day_commands.csv", [named, *log])


def shifted(row: str, by: float) -> str:
    """A line of a csv, that much later."""
    time, _, rest = row.partition(",")
    return f"{float(time) + by:.4f},{rest}"


def test_long_pauses_part_the_runs_of_a_file(tmp_path):
    write_day(tmp_path, [100.0, 5.0, 60.0])
    main(["init", str(tmp_path), "-q"])
    runs = read_yaml(tmp_path / "campaign.yaml")["runs"]
    assert [run["id"] for run in runs] == ["day-1", "day-2", "day-3"]
    assert [run["split"] for run in runs] == ["train", "train", "test"]
    assert np.array([run["use"] for run in runs])[:, 0] == pytest.approx(
        np.array([[0.0, 11.99], [112.0, 140.99], [201.0, 212.99]]), abs=2e-3
    )
    assert "nothing was recorded for 60 s before it" in told(tmp_path)


@pytest.mark.parametrize("pauses", [[], [5.0]])
def test_a_run_with_short_pauses_stays_one(tmp_path, pauses):
    write_day(tmp_path, pauses)
    main(["init", str(tmp_path), "-q"])
    (run,) = read_yaml(tmp_path / "campaign.yaml")["runs"]
    assert run["id"] == "day"
    assert "use" not in run


def test_lines_that_share_a_time_are_counted(tmp_path):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    head, *rows = (tmp_path / "poses.csv").read_text().splitlines()
    cut = [f"{float(row.partition(',')[0]):.0f},{row.partition(',')[2]}" for row in rows]
    write_lines(tmp_path / "poses.csv", [head, *cut])
    main(["init", str(tmp_path), "-q"])
    assert re.search(
        r"CHECK: poses.csv: \d+ of 1200 lines have the time of another and are not used. They are "
        "whole seconds",
        told(tmp_path),
    )


@pytest.mark.parametrize("names", ["Fx,Mz", "wrench.force.x,wrench.torque.z", "surge [N],yaw_Nm"])
def test_forces_and_moments_by_their_names_are_a_wrench(tmp_path, names):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    write_lines(tmp_path / "poses_commands.csv", percent(names))
    main(["init", str(tmp_path), "-q"])
    content = YAML(typ="safe", pure=True).load((tmp_path / "campaign.yaml").read_text())
    assert content["commands"]["kind"] == "wrench"
    assert content["commands"]["columns"] == names.split(",")
    assert content["commands"]["axes"] == ["surge", "yaw"]
    assert "guess: forces and moments by their names" in told(tmp_path)


STICK = [f"{0.1 * k:.1f},{k % 7 * 90},{-k % 5 * 100},{400 + k % 9},{k % 3},0" for k in range(120)]


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (percent("T1_N,T2_N"), "forces in N by their names: add them up"),
        (percent("field.pose.position.x,field.pose.position.y"), "may be a pose: name them x_m"),
        (["time_s,x,y,z,r,s", *STICK], "may be MANUAL_CONTROL: write surge = x / 1000"),
    ],
)
def test_what_names_say_is_not_called_percent(tmp_path, lines, said):
    write_poses(tmp_path, "csv", Swim.ned(frames=1200))
    write_lines(tmp_path / "poses_commands.csv", lines)
    main(["init", str(tmp_path), "-q"])
    assert f"CHECK: not used as commands: {tmp_path}/poses_commands.csv" in told(tmp_path)
    assert said in told(tmp_path)
    assert "percent" not in told(tmp_path)


def test_a_magnetic_field_and_a_load_cell_beside_thrusters_are_no_wrench(tmp_path):
    field = write_lines(tmp_path / "a.csv", percent("mx,my"))
    with pytest.raises(RovsimError, match="no commands that rovsim knows"):
        look_into_csv(field, tmp_path / "copy")
    rows = [f"{0.1 * k:.1f},{1500 + k},{1500 - k},{k},{-k}" for k in range(90)]
    both = write_lines(tmp_path / "b.csv", ["time_s,t1,t2,Fx,Fy", *rows])
    assert look_into_csv(both, tmp_path / "copy").drives[0].columns == ("t1", "t2")
