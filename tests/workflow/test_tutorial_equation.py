"""The tutorial of the equation, as it is written: unexplained, a law, an effect with a name."""

import shlex
import subprocess
from pathlib import Path

import pytest

from pages import fenced
from rovsim.apps.cli.main import main
from rovsim.core.files import read_json
from rovsim.core.yaml_files import read_yaml
from sketches import draw_few

TUTORIAL = Path(__file__).parents[2] / "docs" / "tutorial_equation.md"


def blocks(kind: str) -> list[str]:
    """Fenced blocks of the page of one kind."""
    return fenced(TUTORIAL.read_text(encoding="utf-8"), kind)


@pytest.fixture(scope="module")
def lived(tmp_path_factory):
    """What the page leaves behind: `secret`, `found`, `compared`, `named`, and models."""
    out = tmp_path_factory.mktemp("equation")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(out)
        draw_few(patch)
        for text in blocks("python"):
            Path(text.split("\n")[0].removeprefix("# ")).write_text(text, encoding="utf-8")
        for line in (line for block in blocks("sh") for line in block.splitlines()):
            if line.startswith("rovsim"):
                main([*shlex.split(line)[1:], "--quiet"])
            else:
                subprocess.run(line, shell=True, check=True, stdout=subprocess.DEVNULL)
    return out


def test_what_is_unexplained_gets_the_equation_that_was_hidden(lived):
    found = read_json(lived / "found" / "diagnosis.json")
    assert found["verdict"] == "unexplained"
    law = found["unexplained"]["proposal"]
    assert law["equation"] == r"N = c\,|v|\,r"
    (hidden,) = read_yaml(lived / "secret" / "truth.yaml")["effects"]
    own, true = law["parameters"]["yaw"], hidden["parameters"]["strength"]
    assert -own["value"] == pytest.approx(true, abs=4 * own["std"])
    assert own["unit"] in (lived / "found" / law["file"]).read_text(encoding="utf-8")


def test_the_error_falls_to_the_noise_floor(lived):
    found = read_json(lived / "found" / "diagnosis.json")
    error, steps = found["error"], found["ladder"]["steps"]
    (with_law,) = [s["windows_2s"] for s in steps if s["model"] == "+proposed_effect"]
    assert with_law < 1.1 * error["noise_floor"] < 0.6 * error["with_effects"]
    models = read_json(lived / "compared" / "comparison.json")["models"]
    yaw = {
        name: models[name]["runs"]["6dof-2"]["windows"]["2"]["velocity_rmse"]["yaw"]
        for name in ("nominal", "with_law")
    }
    assert yaw["with_law"] < 0.3 * yaw["nominal"]


def test_an_effect_of_ones_own_is_then_named(lived):
    named = read_json(lived / "named" / "diagnosis.json")
    assert named["verdict"] == "missing_effects"
    (own,) = named["selected"]
    assert own["effect"] == "side_plates"
    assert own["probability"] > 0.999
    assert "know=[side_plates.yaw]" in named["next_experiment"]  # the file does not say what helps
