"""What the terminal shows fits 80 columns, folded between words, and says nothing twice."""

import pkgutil
import tomllib
from pathlib import Path

import pytest

from rovsim.apps.cli.complaint import complain
from rovsim.apps.cli.main import COMMANDS_FOLDER, main
from rovsim.core.columns import fold, fold_page
from rovsim.core.errors import BadInput, nearest
from rovsim.core.extras import EXTRA_PACKAGES

ALL = sorted(module.name for module in pkgutil.iter_modules([str(COMMANDS_FOLDER)]))
ROOT = Path(__file__).parents[2]


def failed(capsys, *words):
    with pytest.raises(SystemExit):
        main(list(words))
    return capsys.readouterr().err


@pytest.mark.parametrize("command", ["", "completion", *ALL])
def test_help_fits(command, capsys):
    main([*([command] if command else []), "--help"])
    said = capsys.readouterr().out
    assert said
    assert max(map(len, said.splitlines())) <= 80


def test_messages_fit_and_paths_stay_whole(capsys):
    path = "/nowhere/" + "a" * 90
    said = failed(capsys, "compare", f"campaign={path}")
    assert f"{path}:" in said
    assert all(len(line) <= 80 for line in said.splitlines() if path not in line)


def test_what_was_exported_fits(capsys, tmp_path):
    main(["export", "model=nominal", "to=gz", f"out={tmp_path / 'v.sdf'}"])
    lines = capsys.readouterr().out.splitlines()
    assert max(len(line) for line in lines[1:]) <= 80


def test_names_that_are_all_listed_are_not_listed_twice(capsys):
    assert failed(capsys, "-v").count("diagnose") == 1
    near = BadInput("x", where="y", expected="one of ab, cd", remedy=nearest("ac", ["ab", "cd"]))
    assert "Did you mean 'cd'" in str(near)


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("campain=x", "campain=x: there is no key 'campain'"),
        ("residual=kn", "residual=kn: there is no residual 'kn'. Expected one of gp, knn, svgp"),
        ("residual.kk=3", "Did you mean 'residual.k'"),
    ],
)
def test_an_unknown_key_is_said_in_plain_words(word, said, capsys):
    text = " ".join(failed(capsys, "train", word).split())
    assert said in text
    assert "override" not in text
    assert "In 'config'" not in text


def test_every_extra_is_known():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert set(EXTRA_PACKAGES) == set(project["optional-dependencies"]) - {"all", "dev"}


def test_usage_lines_stay_apart_and_paragraphs_are_filled():
    page = fold_page("Say it.\n\nrovsim say [a=1]\n           [b=2]\n\nword\n" + "word " * 30)
    assert "\nrovsim say [a=1]\n           [b=2]\n" in page
    assert all(len(line) <= 80 for line in page.splitlines())
    assert fold("a-b " * 30)[0].endswith("a-b")


def test_a_message_of_several_lines_keeps_them(capsys):
    with pytest.raises(SystemExit) as ended:
        complain("first\nsecond")
    assert ended.value.code == 2
    assert capsys.readouterr().err == "rovsim: first\nsecond\n"
