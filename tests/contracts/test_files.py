"""Files appear whole or not at all; nothing read from disk is ever executed."""

import io
import os
import pickle
import resource
import zipfile

import numpy as np
import pytest
import yaml

from fuzz.hostile import TEXTS
from rovsim.application.settings import WritingSettings
from rovsim.apps.cli.main import main
from rovsim.apps.cli.output import choose_folder
from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.errors import BadInput
from rovsim.core.files import appearing, read_json, write_json
from rovsim.core.schema import checked
from rovsim.core.yaml_files import read_yaml, write_yaml
from rovsim.measurement.signals.chain import SignalSettings
from synthetic_study import several_effects


class Evil:
    def __reduce__(self):
        return (pytest.fail, ("a pickle was executed",))


def test_arrays_survive_and_their_bytes_depend_on_them_alone(tmp_path):
    arrays = {"a": np.arange(6.0).reshape(2, 3), "b": np.array(["x", "é"]), "c": np.array(True)}
    for name in ("one.npz", "two.npz"):
        write_arrays(tmp_path / name, **arrays)
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()
    again = read_arrays(tmp_path / "one.npz")
    assert all(np.array_equal(again[key], value) for key, value in arrays.items())


def test_yaml_of_both_versions_reads_what_was_written(tmp_path):
    words = ["no", "y", "1e5", "010", "1:30", "2025-05-27", "null", "", "a: b", "µ" * 120, "a\nb"]
    content = {"words": words, "numbers": [1e-5, 1e22, 0.1, -3, 1.0], "y": None, "none": {}}
    write_yaml(tmp_path / "x.yaml", content)
    assert read_yaml(tmp_path / "x.yaml") == content
    assert yaml.safe_load((tmp_path / "x.yaml").read_text(encoding="utf-8")) == content


def test_a_number_needs_no_point_and_a_key_comes_once(tmp_path):
    (tmp_path / "x.yaml").write_text("gain: 1e-3\non: y\n")
    assert read_yaml(tmp_path / "x.yaml") == {"gain": 1e-3, "on": "y"}
    (tmp_path / "x.yaml").write_text("a: 1\nb: {c: 1, c: 2}\n")
    with pytest.raises(BadInput, match=r'x\.yaml, line 2: .*duplicate key "c"'):
        read_yaml(tmp_path / "x.yaml")


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", pickle.dumps(Evil()), b"text"])
def test_damaged_arrays_and_pickles_are_refused(tmp_path, content):
    (tmp_path / "bad.npz").write_bytes(content)
    with pytest.raises(BadInput, match=r"bad\.npz"):
        read_arrays(tmp_path / "bad.npz")


def test_pickled_objects_inside_an_archive_are_refused(tmp_path):
    np.savez(tmp_path / "bad.npz", x=np.array([Evil()], dtype=object))
    with pytest.raises(BadInput, match="plain arrays"):
        read_arrays(tmp_path / "bad.npz")


def test_an_interrupted_write_leaves_the_old_file(tmp_path):
    path = tmp_path / "x.json"
    write_json(path, {"kept": 1})
    with pytest.raises(RuntimeError, match="power cut"):
        _cut_off(path)
    assert read_json(path) == {"kept": 1}
    assert [p.name for p in tmp_path.iterdir()] == ["x.json"]
    with pytest.raises(ValueError, match="JSON"):
        write_json(path, {"bad": float("nan")})
    assert read_json(path) == {"kept": 1}


def test_a_full_disk_is_said_and_leaves_the_old_file(tmp_path):
    write_json(tmp_path / "x.json", [1])
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))  # EFBIG, as a quota would
    try:
        with pytest.raises(BadInput, match=r"x\.json: cannot be written .* make room"):
            write_json(tmp_path / "x.json", list(range(10_000)))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert read_json(tmp_path / "x.json") == [1]
    assert list(tmp_path.iterdir()) == [tmp_path / "x.json"]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (TEXTS["bomb"], "aliases"),
        (TEXTS["cycle"], "aliases"),
        (TEXTS["deep"], "nested too deeply"),
        (TEXTS["digits"], "not YAML"),
        (TEXTS["line"], "characters"),
    ],
)
def test_a_bomb_is_one_message(text, found, tmp_path):
    (tmp_path / "x.yaml").write_text(text)
    with pytest.raises(BadInput, match=found) as refusal:
        read_yaml(tmp_path / "x.yaml")
    assert len(str(refusal.value)) < 2000


def test_an_alias_may_repeat(tmp_path):
    (tmp_path / "x.yaml").write_text("a: &a [1, 2]\nb: *a\nc: *a\n")
    assert read_yaml(tmp_path / "x.yaml") == {key: [1, 2] for key in "abc"}


def test_an_archive_that_unpacks_to_a_memory_is_refused(tmp_path):
    head = io.BytesIO()
    described = {"descr": "<f8", "fortran_order": False, "shape": (10**10,)}
    np.lib.format.write_array_header_1_0(head, described)
    for filling in (b"", bytes(10**8)):
        with zipfile.ZipFile(tmp_path / "x.npz", "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("a.npy", head.getvalue() + filling)
        with pytest.raises(BadInput, match=r"unpack|in \d+ bytes"):
            read_arrays(tmp_path / "x.npz")


def test_a_pipe_is_refused_and_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "x.yaml")
    with pytest.raises(BadInput, match="a device or a pipe"):
        read_yaml(tmp_path / "x.yaml")


def test_a_place_that_cannot_be_written_is_said(tmp_path):
    (tmp_path / "file").write_text("x")
    (tmp_path / "folder").mkdir()
    for path in (tmp_path / "file" / "x.json", tmp_path / "folder"):
        with pytest.raises(BadInput, match="cannot be written"):
            write_json(path, {})
    with pytest.raises(BadInput, match=r"file: is not a folder"):
        choose_folder(WritingSettings(out=str(tmp_path / "file" / "deeper" / "out")), "")
    new = WritingSettings(out=str(tmp_path / "not" / "yet"))
    assert choose_folder(new, "") == tmp_path / "not" / "yet"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "folder"]


def _cut_off(path):
    with appearing(path) as temporary:
        temporary.write_text("half")
        raise RuntimeError("power cut")


def test_yaml_builds_nothing(tmp_path):
    (tmp_path / "bad.yaml").write_text("!!python/object/apply:os.getcwd []")
    with pytest.raises(BadInput, match="not YAML"):
        read_yaml(tmp_path / "bad.yaml")


def test_a_typo_in_one_of_several_kinds_names_that_kinds_key():
    content = {"filter": {"kind": "savgol", "windw": 0.3}}
    with pytest.raises(BadInput, match="Did you mean 'window'"):
        checked(SignalSettings, content, "conf")


@pytest.mark.parametrize("result", ["add", "export"])
def test_a_result_replaces_an_older_one_and_no_other_file(tmp_path, monkeypatch, capsys, result):
    monkeypatch.chdir(tmp_path)
    several_effects().write(tmp_path / "diagnosis.json")
    words = {"add": ["diagnosis=diagnosis.json", "model={}"], "export": ["to=gz", "out={}"]}
    own, recording = tmp_path / "own.yaml", tmp_path / "campaign.yaml"
    recording.write_text("name: mine\n")

    def write(path):
        main([result, *(word.format(path.name) for word in words[result]), "--quiet"])

    write(own)
    first = own.read_text()
    write(own)
    assert own.read_text() == first
    with pytest.raises(SystemExit, match="2"):
        write(recording)
    assert recording.read_text() == "name: mine\n"
    assert "which rovsim did not write" in " ".join(capsys.readouterr().err.split())


def test_a_model_that_was_changed_by_hand_is_kept(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    several_effects().write(tmp_path / "diagnosis.json")
    words = ["add", "diagnosis=diagnosis.json", "model=new.yaml"]
    (tmp_path / "new.yaml").touch()  # nothing to lose
    main(words)
    first = (tmp_path / "new.yaml").read_text()
    main(words)  # the same bytes
    assert {p.name for p in tmp_path.iterdir()} == {"diagnosis.json", "new.yaml"}
    assert "is kept" not in capsys.readouterr().out
    for name, note in (
        ("new.earlier.yaml", "lag of 3 May"),
        ("new.earlier-2.yaml", "and of 4 May"),
    ):
        (tmp_path / "new.yaml").write_text(f"{first}# {note}\n")
        main(words)
        assert note in (tmp_path / name).read_text()
        assert (tmp_path / "new.yaml").read_text() == first
        assert f"It is kept as {name}" in " ".join(capsys.readouterr().out.split())


def test_nothing_is_added_to_what_keeps_its_velocity(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    several_effects().write(tmp_path / "diagnosis.json")
    with pytest.raises(SystemExit, match="2"):
        main(["add", "diagnosis=diagnosis.json", "model=new.yaml", "to=zero_acceleration"])
    assert "keeps its velocity whatever acts on it" in " ".join(capsys.readouterr().err.split())
    assert not (tmp_path / "new.yaml").exists()


def test_a_model_does_not_replace_another_diagnosis(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = several_effects()
    for name in ("diagnosis.json", "other.json"):
        found.write(tmp_path / name)
    assert "rovsim.model/" in (tmp_path / "other.json").read_text()  # of the base
    with pytest.raises(SystemExit, match="2"):
        main(["add", "diagnosis=diagnosis.json", "model=other.json", "--quiet"])
    assert (tmp_path / "other.json").read_bytes() == (tmp_path / "diagnosis.json").read_bytes()
