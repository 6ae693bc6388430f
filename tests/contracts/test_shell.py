"""Commands of README and docs hold in a fresh shell, zsh included; summaries fit a terminal."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from rovsim import __version__
from rovsim.apps.cli.main import main
from rovsim.dynamics.catalogue import built_in
from rovsim.reporting.words.terminal import tell_comparison, tell_diagnosis
from said import unfolded
from synthetic_study import study

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"")


def commands(page):
    """Lines of the shell blocks, and what stands between backticks and begins with a program."""
    text = page.read_text(encoding="utf-8")
    for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL):
        yield from (line.partition(" #")[0] for line in block.splitlines())
    yield from re.findall(r"`((?:rovsim|snakemake|mlflow) [^`]*)`", text)
    yield from re.findall(r"^    ((?:rovsim|snakemake) .*)$", text, re.MULTILINE)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_shell_takes_a_bracket_for_a_pattern(page):
    for command in commands(page):
        if "…" not in command:
            assert not set("[]{}*?") & set(QUOTED.sub("", command)), command


def test_no_command_of_the_readme_writes_over_another_ones_report():
    blocks = re.findall(r"```sh\n(.*?)```", PAGES[0].read_text(encoding="utf-8"), re.DOTALL)
    folders = re.findall(r"\bout=(\w+)", "\n".join(blocks))
    assert len(folders) == len(set(folders)) > 2


@pytest.mark.slow
def test_snakemake_without_cores_takes_those_of_the_profile():
    (shown,) = re.findall(r'`snakemake (--config overrides="tank=lag")`', PAGES[0].read_text())
    command = [sys.executable, "-m", "snakemake", "-n", "-q", *shown.replace('"', "").split()]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_summaries_fit_80_columns():
    content = study()
    found, where = content["diagnosis"], content["where"]
    said = tell_diagnosis(found, built_in()) + tell_comparison({"nominal": 0.3}, where, True)
    assert max(map(len, said.splitlines())) <= 80
    assert "± is the 95 % interval" in said


def test_the_doctor_looks_and_changes_nothing(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    main(["doctor", "--json"])
    found = {line["what"]: line for line in json.loads(capsys.readouterr().out)}
    assert {"rovsim", "python", "cores", "compiled", "browser", "slurm", "mlflow"} <= set(found)
    assert found["rovsim"]["told"].startswith(__version__)
    assert list(tmp_path.iterdir()) == []


def test_the_version_and_options_that_are_not_known(capsys):
    main(["--version"])
    assert capsys.readouterr().out == f"rovsim {__version__}\n"
    with pytest.raises(SystemExit) as ended:
        main(["compare", "--jsn"])
    assert ended.value.code == 2
    assert "Did you mean '--json'" in unfolded(capsys.readouterr().err)
    with pytest.raises(SystemExit):
        main(["comapre"])
    assert "rovsim: rovsim:" not in unfolded(capsys.readouterr().err)
