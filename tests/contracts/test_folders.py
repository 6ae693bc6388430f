"""What the workbench offers to open: folders as they are, and campaigns that were opened before."""

import os
from pathlib import Path

import pytest

from rovsim.apps.workbench import folders
from rovsim.apps.workbench.folders import look, remember, shown, tell_unopenable


@pytest.fixture(autouse=True)
def state(tmp_path, monkeypatch):
    """A user who has opened nothing yet."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "state" / "rovsim" / "recent.json"


def campaign(folder):
    """A folder that says it is one."""
    folder.mkdir(parents=True)
    (folder / "campaign.yaml").write_text("name: x\n")
    return folder


def test_a_folder_is_listed_by_name_and_campaigns_are_known(tmp_path):
    place = tmp_path / "lab"
    campaign(place / "may")
    (place / "april").mkdir()
    (place / ".hidden").mkdir()
    (place / "run.tsv").write_text("x")
    found = look(place)
    assert [(one.path.name, one.campaign) for one in found.inside] == [
        ("april", False),
        ("may", True),
    ]
    assert (found.files, found.more, found.campaign, found.problem) == (1, 0, False, "")
    assert found.parents[-1] == tmp_path
    assert look(place / "may").campaign


def test_a_folder_that_is_not_there_shows_the_nearest_above_it(tmp_path):
    assert look(tmp_path / "no" / "such").folder == tmp_path


def test_circles_secrets_odd_names_and_crowds_are_no_trouble(tmp_path, monkeypatch):
    (tmp_path / "circle").symlink_to("circle")
    os.mkdir(os.fsencode(tmp_path) + b"/odd\xff\nname")
    shut = tmp_path / "shut"
    shut.mkdir(mode=0o000)
    found = look(tmp_path)
    assert {"shut"} < {one.path.name for one in found.inside}
    assert not any(one.campaign for one in found.inside)
    assert all(shown(one.path).encode() for one in found.inside)
    if os.getuid():  # root may look into everything
        assert look(shut).problem
    shut.chmod(0o700)
    monkeypatch.setattr(folders, "MAX_FOLDERS", 1)
    assert (len(look(tmp_path).inside), look(tmp_path).more) == (1, len(found.inside) - 1)
    assert [one.path.name for one in look(tmp_path, "HUT").inside] == ["shut"]
    assert look(tmp_path, "HUT").more == 0


def test_campaigns_are_remembered_the_last_first_while_they_are_there(tmp_path):
    made = [campaign(tmp_path / f"c{k}") for k in range(folders.MAX_KEPT_CAMPAIGNS + 2)]
    for one in (*made, made[-2]):
        remember(one)
    expected = [made[-2], made[-1], *reversed(made[:-2])][: folders.MAX_KEPT_CAMPAIGNS]
    assert folders.list_recent() == expected
    (made[-2] / "campaign.yaml").unlink()
    assert folders.list_recent() == expected[1:]


@pytest.mark.parametrize("content", ["", "[]", '{"campaigns": 3}', '{"campaigns": [3, null]}'])
def test_a_damaged_list_is_an_empty_one(content, state, tmp_path):
    state.parent.mkdir(parents=True)
    state.write_text(content)
    assert folders.list_recent() == []
    remember(campaign(tmp_path / "c"))
    assert folders.list_recent() == [tmp_path / "c"]


def test_where_nothing_can_be_kept_nothing_is(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "file"))
    remember(campaign(tmp_path / "c"))
    assert folders.list_recent() == []


def test_what_cannot_be_opened_is_told_with_its_whole_path_and_what_to_do(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    described = campaign(tmp_path / "may") / "campaign.yaml"
    (tmp_path / "run.tsv").write_text("x")
    for place in (tmp_path, described, described.parent):
        assert tell_unopenable(place) == ""
    nowhere = tell_unopenable(Path("lab/june"))
    assert nowhere.startswith(
        f"{tmp_path}/lab/june: no such file or folder. Expected the folder of"
    )
    a_file = tell_unopenable(Path("run.tsv"))
    assert "run.tsv: this is a file." in a_file
    assert a_file.endswith(f"Open {tmp_path}.")
    assert "Expected the folder" in tell_unopenable(Path("a\0b"))
