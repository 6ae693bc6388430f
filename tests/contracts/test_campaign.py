"""campaign.yaml: what is accepted, and what is refused with which words."""

import copy
from pathlib import Path

import numpy as np
import pytest

from recordings import campaign_content, write_campaign, write_run
from rovsim.application.provenance import digest_files
from rovsim.core.errors import BadInput
from rovsim.measurement.loading import load_campaign


def test_a_campaign_gives_absolute_paths_and_the_tank_in_ned(tmp_path, monkeypatch):
    write_run(tmp_path / "c")
    monkeypatch.chdir(tmp_path)
    campaign = load_campaign(Path("c"))
    run = campaign.run("one")
    assert campaign.mocap_paths(run) == [tmp_path / "c" / "poses.tsv"]
    assert campaign.commands_path(run).is_absolute()
    np.testing.assert_array_equal(campaign.tank_ned(), [[0, 10], [-5, 0], [-3, 0]])
    assert load_campaign(Path("c/campaign.yaml")) == campaign


def test_a_result_tells_which_recordings_it_is_of(tmp_path):
    folder = write_run(tmp_path)
    campaign = load_campaign(folder)
    before = digest_files(campaign)
    assert {"campaign.yaml", "poses.tsv"} <= set(before)
    (folder / "poses.tsv").write_bytes((folder / "poses.tsv").read_bytes() + b"\n")
    after = digest_files(campaign)
    assert [name for name in before if before[name] != after[name]] == ["poses.tsv"]
    assert all(len(one) == 16 for one in after.values())


def test_a_tank_may_be_absent_or_partial(tmp_path):
    folder = write_run(tmp_path)
    content = campaign_content()
    del content["tank"]
    assert np.isnan(load_campaign(write_campaign(folder, content)).tank_ned()).all()
    content["tank"] = {"z": [0, 3]}
    tank = load_campaign(write_campaign(folder, content)).tank_ned()
    np.testing.assert_array_equal(tank, [[np.nan] * 2, [np.nan] * 2, [-3, 0]])


def test_numbers_are_names(tmp_path):
    folder = write_run(tmp_path)
    content = campaign_content()
    content["runs"][0]["id"] = 115750
    content["name"] = 2025
    campaign = load_campaign(write_campaign(folder, content))
    assert campaign.run("115750").id == "115750"
    assert campaign.name == "2025"


def test_a_key_that_is_mistyped_is_answered_with_the_nearest(tmp_path):
    """It is unknown, and the one that was meant is missing: the first says more."""
    folder = write_run(tmp_path)
    content = campaign_content()
    content["mocap"]["world_axs"] = content["mocap"].pop("world_axes")
    with pytest.raises(BadInput, match=r"'mocap.world_axs'.*Did you mean 'world_axes'"):
        load_campaign(write_campaign(folder, content))


@pytest.mark.parametrize("name", ["mätning 3, a=b (ny)", "水槽", "with space"])
def test_unusual_paths_work(tmp_path, name):
    folder = write_run(tmp_path / name)
    content = campaign_content()
    content["name"] = content["runs"][0]["id"] = name
    assert load_campaign(write_campaign(folder, content)).run(name).id == name


def test_recordings_may_lie_elsewhere(tmp_path, monkeypatch):
    write_run(tmp_path / "raw data")
    content = campaign_content()
    monkeypatch.delenv("SOME_DATA", raising=False)
    content["folder"] = "${SOME_DATA:-../nowhere}/raw data"
    folder = write_campaign(tmp_path / "described", content)
    with pytest.raises(BadInput, match=r"run 'one' is missing: .*nowhere.*set 'folder'"):
        load_campaign(folder)
    monkeypatch.setenv("SOME_DATA", str(tmp_path))
    assert load_campaign(folder).folder == tmp_path / "raw data"
    content["folder"] = "$SOME_DATA/raw data"
    assert load_campaign(write_campaign(folder, content)).folder == tmp_path / "raw data"
    content["folder"] = "../raw data"
    assert load_campaign(write_campaign(folder, content)).folder == tmp_path / "raw data"


# what is changed in a good file -> words the message must hold
REFUSED = {
    "unknown key": ({"vehicel": "x"}, ["vehicel", "Did you mean 'vehicle'"]),
    "unknown key in a run": ({"runs.0.splitt": "x"}, ["runs.0.splitt", "'split'"]),
    "unknown key in mocap": ({"mocap.world_axis": "ned"}, ["mocap.world_axis", "'world_axes'"]),
    "missing key": ({"vehicle": None}, ["'vehicle' is missing", "Add it"]),
    "missing key in a run": ({"runs.0.mocap": None}, ["'runs.0.mocap' is missing", "Add it"]),
    "world axes": ({"mocap.world_axes": "nwu"}, ["mocap.world_axes", "'nwu'", "'ned'"]),
    "kind": ({"commands.kind": "rpm"}, ["commands.kind", "'rpm'", "'demand'"]),
    "split": ({"runs.0.split": "validate"}, ["runs.0.split", "'train'"]),
    "control": ({"runs.0.control": "4dof"}, ["runs.0.control", "'6dof'"]),
    "tank": ({"tank.y": [5, 0]}, ["tank.y", "low below high", "Correct"]),
    "tank number": ({"tank.y": [0, "deep"]}, ["tank.y", "number"]),
    "no runs": ({"runs": []}, ["'runs'", "at least 1"]),
    "id with a slash": ({"runs.0.id": "a/b"}, ["runs.0.id", "'a/b'", "file name"]),
    "id on two lines": ({"runs.0.id": "a\u2028b"}, ["runs.0.id", "file name"]),
    "body on two lines": ({"mocap.body": "a\nb"}, ["mocap.body", "on one line"]),
    "id that leaves": ({"runs.0.id": ".."}, ["runs.0.id", "'..'", "file name"]),
    "empty id": ({"runs.0.id": ""}, ["runs.0.id", "file name"]),
    "name with a slash": ({"name": "../x"}, ["'name'", "file name"]),
    "no columns": ({"commands.columns": []}, ["commands.columns", "at least 1"]),
    "same column": ({"commands.columns": ["t1", "t1"]}, ["commands.columns", "once"]),
    "few axes": (
        {"commands.kind": "demand", "commands.columns": ["a", "b"]},
        ["commands.columns", "2 columns", "surge", "List all six"],
    ),
    "axes of thrusters": (
        {"commands.kind": "normalized", "commands.axes": ["surge"]},
        ["commands.axes", "per thruster", "Leave 'axes' out"],
    ),
    "further columns of a bag": (
        {"commands.format": "rosbag2", "commands.auxiliary": ["voltage"]},
        [
            "commands.auxiliary",
            "rosbag2",
            "further columns of a csv",
            "format: csv",
            "Leave it out",
        ],
    ),
    "capitals": ({"mocap.body_axes": "FLU"}, ["'FLU'", "Did you mean 'flu'?"]),
    "a longer word": ({"runs.0.split": "training"}, ["'training'", "Did you mean 'train'?"]),
    "text for a section": ({"tank": "big"}, ["'tank' is 'big'", "keys and values (x, y, z)"]),
    "no list": ({"commands.columns": "t1"}, ["commands.columns", "Expected a list"]),
    "a number for a name": ({"source": 3}, ["'source' is 3", "Expected text"]),
    "two coordinates": (
        {"mocap.sensors": {"velocity_at": [0.1, 0.2]}},
        ["'mocap.sensors.velocity_at' is [0.1, 0.2]", "3 values"],
    ),
    "one limit": ({"tank.y": [5]}, ["'tank.y' is [5]", "at least 2 values"]),
    "angles of no column": ({"commands.angles": ["ruder"]}, ["commands.angles", "'ruder'"]),
    "topics of no bag": (
        {"mocap.topics": {"imu": "/imu"}},
        ["mocap.topics", "qtm_tsv", "topics of a ROS 2 bag", "format: rosbag2", "Leave it out"],
    ),
    "topic of a csv": (
        {"commands.topic": "/out"},
        ["commands.topic", "format: csv", "format: rosbag2", "Leave it out"],
    ),
    "no such user": ({"folder": "~nobody_at_all/x"}, ["~nobody_at_all/x", "set 'folder'"]),
    "no such file": ({"runs.0.commands": "x.csv"}, ["run 'one'", "x.csv", "Put it there"]),
    "variable": ({"folder": "$NOT_SET_ANYWHERE"}, ["folder", "NOT_SET_ANYWHERE", "Set it"]),
}


def changed(content: dict, changes: dict) -> dict:
    content = copy.deepcopy(content)
    for place, value in changes.items():
        *parents, key = place.split(".")
        inner = content
        for parent in parents:
            inner = inner[int(parent)] if parent.isdigit() else inner[parent]
        if value is None:
            del inner[key]
        else:
            inner[key] = value
    return content


@pytest.mark.parametrize("what", REFUSED)
def test_a_bad_campaign_is_refused_in_words(tmp_path, what):
    changes, words = REFUSED[what]
    folder = write_campaign(write_run(tmp_path), changed(campaign_content(), changes))
    with pytest.raises(BadInput) as refusal:
        load_campaign(folder)
    for word in [str(folder / "campaign.yaml"), *words]:
        assert word in str(refusal.value)


@pytest.mark.parametrize("other", ["one", "ONE"])
def test_two_runs_cannot_share_an_id(tmp_path, other):
    folder = write_run(tmp_path)
    content = campaign_content()
    content["runs"].append({**content["runs"][0], "id": other})
    with pytest.raises(BadInput, match=r"runs\.1\.id.*'one'.*Rename"):
        load_campaign(write_campaign(folder, content))


@pytest.mark.parametrize("text", ["", "- a\n- b\n", "name: [\n"])
def test_a_file_that_is_no_campaign(tmp_path, text):
    (tmp_path / "campaign.yaml").write_text(text)
    with pytest.raises(BadInput, match=r"campaign\.yaml.*Expected"):
        load_campaign(tmp_path)


def test_a_folder_without_campaign_and_an_unknown_run(tmp_path):
    with pytest.raises(BadInput, match=r"no campaign\.yaml.*rovsim init"):
        load_campaign(tmp_path)
    with pytest.raises(BadInput, match=r"no such file or folder.*Check the path"):
        load_campaign(tmp_path / "nowhere")
    with pytest.raises(BadInput, match=r"no run 'ons'.*Did you mean 'one'"):
        load_campaign(write_run(tmp_path)).run("ons")
