"""Commands of README and docs hold in a fresh shell, zsh included; summaries fit a terminal."""

import json
import re
import shlex
import subprocess
import sys

import pytest

from commands import PAGES, ROOT, commands
from pages import fenced
from rovsim import __version__
from rovsim.application.settings import select
from rovsim.apps.cli import dispatch, sweep
from rovsim.apps.cli.main import main
from rovsim.core.collector import import_large
from rovsim.dynamics.catalogue import built_in
from rovsim.reporting.words.terminal import tell_comparison, tell_diagnosis
from said import unfolded
from synthetic_study import study

README = ROOT / "README.md"
QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"")


# Of `rovsim`: what is to be typed as it is, and has keys.
TYPED = [
    line
    for line in dict.fromkeys(line for page in PAGES for line in commands(page))
    if re.match(r"rovsim (?!completion)[a-z]+ .*=", line) and "…" not in line
]


def test_commands_in_indented_blocks_are_found_too():
    assert "gz sim vehicle.sdf" in commands("docs/export.md")
    assert "rovsim diagnose campaign=after out=surer" in commands("docs/next_flight.md")
    assert not any(line.startswith("source =") for line in commands("docs/your_own_effect.md"))


@pytest.mark.parametrize("line", TYPED)
def test_every_command_of_the_documents_is_understood(line, monkeypatch):
    """What it does, `make commands` runs."""
    understood = []

    def run(settings):
        command = import_large(f"rovsim.apps.cli.commands.{settings.command}")
        understood.append(select(settings, command.Settings))

    monkeypatch.setattr(dispatch, "run_command", run)
    monkeypatch.setattr(sweep, "run_sweep", lambda words, _: understood.append(words))
    main(shlex.split(line)[1:])
    assert understood


@pytest.mark.parametrize("page", PAGES)
def test_no_shell_takes_a_bracket_for_a_pattern(page):
    for command in commands(page):
        if "…" not in command:
            assert not set("[]{}*?") & set(QUOTED.sub("", command)), command


def test_no_command_of_the_readme_writes_over_another_ones_report():
    blocks = fenced(README.read_text(encoding="utf-8"), "sh")
    folders = re.findall(r"\bout=(\w+)", "\n".join(blocks))
    assert len(folders) == len(set(folders)) > 2


def test_snakemake_without_cores_takes_those_of_the_profile():
    (shown,) = re.findall(r'`snakemake (--config overrides="tank=lag")`', README.read_text())
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
