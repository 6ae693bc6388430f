"""`rovsim init`: a campaign is stripped of its description, and the description demanded back."""

import re
import shutil
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
import yaml

from recordings import CLOCKS, Swim, motive_lines, write_lines, write_poses
from rovsim.apps.cli.main import main
from rovsim.core.rotations import matrix
from rovsim.dynamics.catalogue import built_in
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording.formats.qtm_tsv import read_qtm
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings
from said import unfolded

RUNS = ("3dof-1", "3dof-2", "6dof-1", "6dof-2")
QUARTER_X = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # z_up to y_up, and flu to fur


@dataclass(frozen=True, eq=False)
class Flown:
    """A tank campaign: its folder, its motions in NED and FRD, lines of its command logs."""

    folder: Path
    swims: dict[str, Swim]
    commands: dict[str, list[str]]


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tank") / "raw"
    main(["tank", "tank.duration=30", "tank.name=tank", f"out={folder}", "-q"])
    mocap = Mocap(format="qtm_tsv", body="vehicle", world_axes="z_up", body_axes="flu")
    swims, commands = {}, {}
    for run in RUNS:
        found = read_qtm(folder / f"{run}_6D.tsv", mocap)
        seen = found.tracked
        swim = Swim(found.time[seen], found.position[seen], matrix(found.attitude[seen]))
        swims[run] = swim.along("z_up", "flu")
        commands[run] = (folder / f"{run}_commands.csv").read_text().splitlines()
    return Flown(folder, swims, commands)


def init(folder: Path, *words: str) -> tuple[dict, str]:
    """Content and text of what init writes for a folder."""
    main(["init", str(folder), "-q", *words])
    text = (folder / "campaign.yaml").read_text()
    return yaml.safe_load(text), text


def logs(flown, folder, start=0.0, name="{}_commands.csv"):
    """The command logs, on clocks that begin at `start`."""
    for k, (run, lines) in enumerate(flown.commands.items()):
        rows = [line.split(",", 1) for line in lines[1:]]
        moved = [lines[0], *(f"{float(t) + start:.4f},{rest}" for t, rest in rows)]
        write_lines(folder / name.format(run, k=k), moved)


def unfolded_comments(text: str) -> str:
    """The text of campaign.yaml with each comment on one line."""
    return re.sub(r"\n\s*# (?!CHECK)", " ", text)


def axes_of(content) -> tuple[str, str]:
    return content["mocap"]["world_axes"], content["mocap"]["body_axes"]


def test_the_description_of_a_tank_comes_back_whole(flown, tmp_path):
    folder = tmp_path / "tank"
    shutil.copytree(flown.folder, folder)
    truth = yaml.safe_load((folder / "campaign.yaml").read_text())
    (folder / "campaign.yaml").unlink()
    content, text = init(folder)
    truth.pop("tank")  # walls cannot be seen in a motion
    assert content == truth
    assert "ANSWER" not in text
    assert "CHECK" not in text
    assert load_campaign(folder).name == "tank"


@pytest.mark.parametrize("world", ["z_up", "ned"])
@pytest.mark.parametrize("body", ["flu", "frd"])
def test_all_axes_of_a_csv_come_back(flown, tmp_path, world, body):
    for run, swim in flown.swims.items():
        path = write_poses(tmp_path, "csv", swim.along(world, body))
        path.rename(tmp_path / f"{run}.csv")
    logs(flown, tmp_path)
    content, text = init(tmp_path)
    assert axes_of(content) == (world, body)
    assert [run["commands"] for run in content["runs"]] == [f"{r}_commands.csv" for r in RUNS]
    assert "CHECK" not in text


def test_files_with_names_that_say_nothing_are_matched_by_what_they_hold(flown, tmp_path):
    order = [2, 0, 3, 1]
    for k, run in enumerate(RUNS):
        shutil.copy(flown.folder / f"{run}_6D.tsv", tmp_path / f"capture{k}.tsv")
        shutil.copy(flown.folder / f"{run}_commands.csv", tmp_path / f"stick{order[k]}.csv")
    content, _ = init(tmp_path)
    assert [run["commands"] for run in content["runs"]] == [f"stick{k}.csv" for k in order]
    assert [run["control"] for run in content["runs"]] == ["3dof", "3dof", "6dof", "6dof"]


def test_names_that_lie_are_not_believed(flown, tmp_path):
    for run, other in zip(RUNS, reversed(RUNS), strict=True):
        shutil.copy(flown.folder / f"{run}_6D.tsv", tmp_path)
        shutil.copy(flown.folder / f"{run}_commands.csv", tmp_path / f"{other}_commands.csv")
    content, text = init(tmp_path)
    assert {run["commands"] for run in content["runs"]} == {"ANSWER"}
    assert text.count("# ANSWER") == 4
    with pytest.raises(Exception, match=r"line \d+ \(runs.0.commands\), line \d+ \(runs.1"):
        load_campaign(tmp_path)


@pytest.mark.parametrize("late", [0.7, -0.7])
def test_a_shifted_clock_is_told(flown, tmp_path, late):
    for run in RUNS:
        shutil.copy(flown.folder / f"{run}_6D.tsv", tmp_path)
    logs(flown, tmp_path, start=-late)
    content, text = init(tmp_path)
    found = re.findall(r"all runs: .* add ([-+]\d\.\d) s to the times", unfolded_comments(text))
    assert [float(x) for x in found] == pytest.approx([late], abs=0.2)
    assert axes_of(content) == ("z_up", "flu")


def test_clocks_that_never_meet_are_matched_by_motion(flown, tmp_path):
    for run in RUNS:
        shutil.copy(flown.folder / f"{run}_6D.tsv", tmp_path)
    logs(flown, tmp_path, start=1.7e9)
    _, text = init(tmp_path)
    found = re.findall(r"comes (\d+\.\d+) s before its commands", unfolded_comments(text))
    assert [float(x) for x in found] == pytest.approx([1.7e9], abs=0.3)


def test_commands_since_1970_are_put_right_by_the_start_in_the_header(flown, tmp_path):
    for k, run in enumerate(RUNS):
        lines = (flown.folder / f"{run}_6D.tsv").read_text()
        stamp = f"TIME_STAMP\t2026-05-12, 1{k}:14:07.250\t1"
        (tmp_path / f"{run}.tsv").write_text(re.sub(r"TIME_STAMP.*", stamp, lines))
        lines = flown.commands[run]
        began = datetime(2026, 5, 12, 8 + k, 14, 7, 250_000, tzinfo=UTC).timestamp()
        rows = [line.split(",", 1) for line in lines[1:]]
        moved = [lines[0], *(f"{float(t) + began:.4f},{rest}" for t, rest in rows)]
        write_lines(tmp_path / f"{run}_commands.csv", moved)
    _, text = init(tmp_path)
    found = re.findall(r"add (-\d+\.\d+) s to the times", unfolded_comments(text))
    assert [float(x) for x in found] == [-(1778573647.25 + 3600.0 * k) for k in range(len(RUNS))]
    assert "less +2 h for its time zone" in unfolded_comments(text)


def test_foreign_columns_in_mm_and_degrees_get_a_copy_that_says_the_same(flown, tmp_path):
    head = "Time [s],X (mm),Y (mm),Z (mm),Roll (deg),Pitch (deg),Yaw (deg)"
    for run, swim in flown.swims.items():
        write_poses(tmp_path, "csv", swim.along("z_up", "flu"))
        rows = np.loadtxt(tmp_path / "poses.csv", delimiter=",", skiprows=1)
        rows = rows * [1, 1e3, 1e3, 1e3, *[180 / np.pi] * 3]
        lines = [head, *(",".join(f"{x:.6f}" for x in row) for row in rows)]
        write_lines(tmp_path / f"{run}_track.csv", lines)
    (tmp_path / "poses.csv").unlink()
    logs(flown, tmp_path)
    content, text = init(tmp_path)
    assert axes_of(content) == ("z_up", "flu")
    assert [run["mocap"] for run in content["runs"]] == [f"converted/{r}_track.csv" for r in RUNS]
    copy = np.loadtxt(tmp_path / "converted" / "6dof-2_track.csv", delimiter=",", skiprows=1)
    swim = flown.swims["6dof-2"].along("z_up", "flu")
    assert np.allclose(copy[:, 1:4], swim.position, atol=1e-6)
    assert "CHECK" not in text


def test_metres_that_hold_millimetres_are_seen(flown, tmp_path):
    for run, swim in flown.swims.items():
        wrong = replace(swim, position=1e3 * swim.position)
        write_poses(tmp_path, "csv", wrong).rename(tmp_path / f"{run}.csv")
    logs(flown, tmp_path)
    content, _ = init(tmp_path)
    assert content["runs"][0]["mocap"].startswith("converted/")
    swim = flown.swims["3dof-1"]
    copy = np.loadtxt(tmp_path / "converted" / "3dof-1.csv", delimiter=",", skiprows=1)
    assert np.allclose(copy[:, 1:4], swim.position, atol=1e-6)


def test_a_mirrored_axis_is_told(flown, tmp_path):
    for run, swim in flown.swims.items():
        wrong = replace(swim, position=swim.position * [1.0, 1.0, -1.0])
        write_poses(tmp_path, "csv", wrong).rename(tmp_path / f"{run}.csv")
    logs(flown, tmp_path)
    _, text = init(tmp_path)
    assert "with x, y, −z in place of x, y, z" in re.sub(r"\n#\s*", " ", text)


def test_swapped_columns_are_told(flown, tmp_path):
    for run, swim in flown.swims.items():
        wrong = replace(swim, position=swim.position[:, [1, 0, 2]])
        write_poses(tmp_path, "csv", wrong).rename(tmp_path / f"{run}.csv")
    logs(flown, tmp_path)
    _, text = init(tmp_path)
    assert "with y, x, z in place of x, y, z" in re.sub(r"\n#\s*", " ", text)


def test_swapped_thrusters_are_told(flown, tmp_path):
    for run in RUNS:
        shutil.copy(flown.folder / f"{run}_6D.tsv", tmp_path)
        lines = flown.commands[run]
        write_lines(
            tmp_path / f"{run}_commands.csv", ["time_s,t1,t2,t5,t4,t3,t6,t7,t8", *lines[1:]]
        )
    _, text = init(tmp_path)
    assert "with t3 and t5 swapped" in re.sub(r"\n#\s*", " ", text)


def test_a_turned_rigid_body_is_asked_for(flown, tmp_path):
    turn = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])  # the vehicle's x is the body's y
    for run, swim in flown.swims.items():
        wrong = replace(swim, rotation=swim.rotation @ turn)
        write_poses(tmp_path, "csv", wrong).rename(tmp_path / f"{run}.csv")
    logs(flown, tmp_path)
    content, text = init(tmp_path)
    assert content["mocap"]["body_axes"] == "ANSWER"
    assert "surge shows along +y" in re.sub(r"\n\s*#\s*", " ", text)


def test_motive_exports_with_y_up_come_back(flown, tmp_path):
    for run, swim in flown.swims.items():
        up = swim.along("z_up", "flu")
        turned = replace(
            up, position=up.position @ QUARTER_X.T, rotation=QUARTER_X @ up.rotation @ QUARTER_X.T
        )
        write_lines(tmp_path / f"{run}_take.csv", motive_lines(turned))
    logs(flown, tmp_path)
    content, text = init(tmp_path)
    assert axes_of(content) == ("y_up", "fur")
    assert content["mocap"]["format"] == "motive_csv"
    assert "ANSWER" not in text


@pytest.mark.parametrize("name", ["rosbag2", "c3d"])
def test_other_formats_come_back(flown, tmp_path, name):
    for run, swim in flown.swims.items():
        path = write_poses(tmp_path, name, swim.along("z_up", "flu"))
        path.rename(tmp_path / f"{run}{path.suffix}")
    # a C3D file has no times: its frames count, and frames without the body would be missing
    logs(flown, tmp_path, start=CLOCKS.get(name, 0.0))
    content, text = init(tmp_path)
    assert content["mocap"]["format"] == name
    assert axes_of(content) == ("z_up", "flu")
    assert "ANSWER" not in text


def test_a_question_that_is_left_is_one_message_with_its_lines(flown, tmp_path, capsys):
    for run in RUNS:
        shutil.copy(flown.folder / f"{run}_6D.tsv", tmp_path)
    content, text = init(tmp_path)
    assert [run["commands"] for run in content["runs"]] == ["none"] * len(RUNS)
    assert {content["vehicle"], *axes_of(content)} == {"ANSWER"}
    lines = [n for n, line in enumerate(text.split("\n"), 1) if re.match(r"^[^#]*ANSWER", line)]
    with pytest.raises(SystemExit) as ended:
        main(["compare", f"campaign={tmp_path}"])
    said = unfolded(capsys.readouterr().err)
    assert ended.value.code == 2
    assert said.count("rovsim: ") == 1
    for n, key in zip(lines, ("vehicle", "mocap.world_axes", "mocap.body_axes"), strict=True):
        assert f"line {n} ({key})" in said


@pytest.mark.parametrize(
    "name", ["bluerov2", "bluerov2_heavy_t200", "cybership2", "otter", "remus100"]
)
def test_another_vehicle_comes_back_or_is_asked_for(tmp_path, name):
    wide = {axis: (0.0, 120.0) for axis in "xy"} | {"z": (0.0, 20.0)}
    space = {} if name.startswith("bluerov2") else {"tank": wide}
    settings = TankSettings(name=name, seed=3, vehicle=name, duration=30.0, **space)
    make_campaign(settings, tmp_path / name, built_in())
    truth = yaml.safe_load((tmp_path / name / "campaign.yaml").read_text())
    (tmp_path / name / "campaign.yaml").unlink()
    content, text = init(tmp_path / name)
    truth.pop("tank")
    wrong = {
        place: (found, flat(truth)[place])
        for place, found in flat(content).items()
        if found not in (flat(truth).get(place), "ANSWER")
    }
    # what is proposed for want of anything better is marked as that
    assert all("control" in place or "split" in place for place in wrong)
    assert content["commands"]["columns"] == truth["commands"]["columns"]
    assert len(re.findall("# ANSWER", text)) <= 3


def flat(content, place="") -> dict:
    """Values by place."""
    pairs = content.items() if isinstance(content, dict) else enumerate(content)
    found = {}
    for key, value in pairs:
        here = f"{place}.{key}"
        found |= flat(value, here) if isinstance(value, dict | list) else {here: value}
    return found


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("dropped", [["x_m", "y_m", "z_m"], ["z_m"]])
def test_axes_that_nobody_measured_raise_no_alarm(flown, tmp_path, dropped):
    for run, swim in flown.swims.items():
        lines = write_poses(tmp_path, "csv", swim).read_text().splitlines()
        kept = [k for k, name in enumerate(lines[0].split(",")) if name not in dropped]
        rows = (line.split(",") for line in lines)
        write_lines(tmp_path / f"{run}.csv", [",".join(row[k] for k in kept) for row in rows])
    (tmp_path / "poses.csv").unlink()
    logs(flown, tmp_path)
    _, text = init(tmp_path)
    assert "correlation nan" not in text
    assert "hardly follows" not in text
    assert "CHECK" not in text


@pytest.mark.parametrize("name", ["t{}", "/mavros/rc/out/channels[{}]"])
def test_poses_and_commands_on_lines_of_their_own_in_one_file(flown, tmp_path, name):
    for run, swim in flown.swims.items():
        poses = write_poses(tmp_path, "csv", swim.along("z_up", "flu")).read_text().splitlines()
        head = ",".join([poses[0], *(name.format(k) for k in range(1, 9))])
        rows = [line.split(",", 1) for line in flown.commands[run][1:]]
        lines = [f"{line}{8 * ','}" for line in poses[1:]]
        lines += [f"{time}{7 * ','}{rest}" for time, rest in rows]
        lines.sort(key=lambda line: float(line.partition(",")[0]))
        write_lines(tmp_path / f"{run}.csv", [head, *lines])
    (tmp_path / "poses.csv").unlink()
    content, text = init(tmp_path)
    assert content["commands"]["columns"] == [name.format(k) for k in range(1, 9)]
    assert content["vehicle"].startswith("bluerov2_heavy")
    assert axes_of(content) == ("z_up", "flu")
    assert all(run["commands"] == run["mocap"] for run in content["runs"])
    assert "CHECK" not in text
