"""The notebooks run from top to bottom, and what a cell ends with shows itself."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model_file import write_model
from worlds import model

FOLDER = Path(__file__).parents[2] / "notebooks"
ORDER = ("tutorial", "own_effect", "thesis_chapter")  # the last goes on with the first one's tank
SHORTER = '"tank=tiny", "tank.duration=8"'


def cells(name):
    """Code of the cells, in order; runs of the tank are shorter."""
    text = (FOLDER / f"{name}.py").read_text(encoding="utf-8")
    parts = re.split(r"^# %%(.*)\n", text, flags=re.MULTILINE)[1:]
    pairs = zip(parts[::2], parts[1::2], strict=True)
    return [code.replace('"tank=tiny"', SHORTER) for kind, code in pairs if "markdown" not in kind]


def run(code, known):
    """Run a cell; returns what its last line is worth, as a notebook would show it."""
    tree = ast.parse(code)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), known)
    return (
        None if last is None else eval(compile(ast.Expression(last.value), "cell", "eval"), known)
    )


def shown(value):
    """What a notebook makes of it: HTML or a picture; plain values as they are."""
    page = value._repr_html_() if hasattr(value, "_repr_html_") else None
    if page is not None:
        assert "http" not in re.sub(r'src="data:[^"]*"', "", page)  # nothing from outside
        return page
    if hasattr(value, "_repr_png_"):
        return value._repr_png_().startswith(b"\x89PNG")
    return str(value)


@pytest.fixture(scope="module")
def notebooks(tmp_path_factory):
    """All of them, run in one folder: the names of each, and what its cells showed."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("notebooks"))
        found = {}
        for name in ORDER:
            known, pages = {}, []
            for code in cells(name):
                value = run(code, known)
                pages.append("" if value is None else shown(value))
            found[name] = known, pages
        yield found


def test_every_notebook_is_run():
    assert sorted(path.stem for path in FOLDER.glob("*.py")) == sorted(ORDER)


def test_the_tutorial_ends_with_the_error_fallen(notebooks):
    known, pages = notebooks["tutorial"]
    errors = known["after"].errors
    assert errors["repaired"] < 0.5 * errors["nominal"]
    assert known["found"].selected.index.tolist() == [("thruster_lag", "time_constant")]
    assert known["found"].verdict == "missing_effects"
    assert known["after"].table().columns[0] == "surge [m/s]"
    lag = known["repaired"].effects.loc[("thruster_lag", "time_constant")]
    assert lag["value"] == pytest.approx(0.18, abs=4 * lag["std"])
    assert "thruster_lag" in pages[-1]  # what Gazebo leaves out
    assert Path("vehicle.sdf").exists()


def test_an_effect_of_ones_own_explains_its_tank(notebooks):
    known, _ = notebooks["own_effect"]
    errors = known["compared"].errors
    assert errors["with_net"] < errors["nominal"]
    assert known["campaign"].catalogue.keys() - built_in().keys() == {"net_panel"}


def test_the_chapter_is_written_and_the_diagnosis_was_kept(notebooks):
    known, _ = notebooks["thesis_chapter"]
    assert known["found"].path == notebooks["tutorial"][0]["found"].path
    assert {path.suffix for path in known["written"]} == {".pdf", ".png", ".csv", ".tex"}
    assert all(path.stat().st_size > 100 for path in known["written"])
    assert list(known["compared"].errors.index) == ["nominal", "repaired", "learned"]


def test_a_comparison_is_made_once_and_a_model_that_changed_anew(notebooks):
    campaign = notebooks["own_effect"][0]["campaign"]
    first = campaign.compare("nominal", "with_net.yaml")
    assert campaign.compare("nominal", "with_net.yaml") is first
    write_model(model(), Path("with_net.yaml"))
    again = campaign.compare("nominal", "with_net.yaml")
    assert again.errors["with_net"] == again.errors["nominal"]


def test_mistakes_are_those_of_the_commands(notebooks):
    campaign = notebooks["tutorial"][0]["campaign"]
    with pytest.raises(BadInput, match="no such file"):
        campaign.compare("nowhere.yaml")
    with pytest.raises(BadInput, match="Did you mean 'velocities'"):
        notebooks["tutorial"][0]["before"].figure("velocitys")
    with pytest.raises(BadInput, match="Did you mean 'stonefish'"):
        campaign.export("nominal", "stonefis")


def test_importing_rovsim_loads_nothing_slow():
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-c", "import rovsim"], capture_output=True, text=True
    )
    assert not re.search(r"numpy|pandas|matplotlib|numba", done.stderr)
