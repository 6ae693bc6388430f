"""The tutorial's commands do what it says, on fewer and shorter runs."""

import re
import shlex
from pathlib import Path

import pytest

from pages import fenced
from rovsim.apps.cli.main import main
from rovsim.core.files import read_json
from rovsim.core.yaml_files import read_yaml

ROOT = Path(__file__).parents[2]
TUTORIAL = ROOT / "docs" / "tutorial.md"
SHORTER = (
    "tank.duration=12",
    "+tank.runs=[{id: a, control: 3dof, split: train}, {id: b, control: 6dof, split: train},"
    " {id: c, control: 6dof, split: test}]",
)
ELSEWHERE = ("cat", "rovsim ui")  # the workbench is tested in tests/browser


def commands() -> list[str]:
    """Lines of the shell blocks."""
    blocks = fenced(TUTORIAL.read_text(encoding="utf-8"), "sh")
    return [line for block in blocks for line in block.splitlines()]


@pytest.mark.usefixtures("few_figures")
def test_the_tutorial_ends_with_the_error_fallen(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for line in commands():
        if not line.startswith(ELSEWHERE):
            words = shlex.split(line)[1:]
            main([*words, *SHORTER] if words[0] == "tank" else words)
    truth, found = read_yaml(Path("practice/truth.yaml")), read_json(Path("found/diagnosis.json"))
    assert [one["effect"] for one in found["selected"]] == [truth["effects"][0]["effect"]]
    value = found["selected"][0]["parameters"]["time_constant"]
    true = truth["effects"][0]["parameters"]["time_constant"]
    assert value["value"] == pytest.approx(true, abs=4 * value["std"])
    assert found["error"]["with_effects"] < 0.3 * found["error"]["nominal"]
    compared = read_json(Path("compared/comparison.json"))["models"]
    assert set(compared) == {"nominal", "repaired"}
    assert all(Path(name, "report.html").exists() for name in ("found", "compared"))


def test_its_pictures_are_there():
    pictures = re.findall(r"\]\((images/[^)]+)\)", TUTORIAL.read_text(encoding="utf-8"))
    assert len(pictures) > 3
    for name in pictures:
        assert (TUTORIAL.parent / name).is_file(), name
