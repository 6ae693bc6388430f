"""The Tab key: what it finds is what rovsim takes, at once, and an odd line is no error."""

import os
import shutil
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.application.configuration import compose
from rovsim.apps.cli.completion import SCRIPTS, commands, complete, effects, settings, suggest
from rovsim.apps.cli.main import main
from rovsim.core.mappings import flattened
from rovsim.core.shipped import conf_folders, conf_names
from rovsim.dynamics.catalogue import built_in
from said import unfolded

HEAVY = ("numpy", "pydantic", "hydra", "yaml", "omegaconf")


def found(line, shell="bash"):
    """What may stand at the end of a line."""
    return complete([shell, line]).splitlines()


def test_keys_are_those_of_the_configuration():
    known = flattened(compose([]).model_dump(mode="json"))
    groups = {path.name for path in conf_folders()[-1].iterdir() if path.is_dir()}
    assert settings().keys() - groups <= known.keys()
    written = ("search.", "replay.", "design.", "blind.", "bench.", "study.", "folds.")
    leaves = {key for key in known if not any(other.startswith(f"{key}.") for other in known)}
    assert {key for key in leaves if key.startswith(written)} <= settings().keys()
    assert {"seed", "control", "residual.k", "signals.filter.cutoff"} <= settings().keys()


def test_effects_are_those_of_the_catalogue():
    assert effects() == sorted(built_in())


@pytest.mark.parametrize(
    ("line", "one", "all_begin"),
    [
        ("rovsim dia", "diagnose ", "dia"),
        ("rovsim completion z", "zsh ", "z"),
        ("rovsim compare filter=sa", "savgol ", "sa"),
        ("rovsim train residual=", "knn ", ""),
        ("rovsim train control=3", "3dof ", "3"),
        ("rovsim ui open=", "false ", ""),
        ("rovsim ui open", "open=", "open"),
        ("rovsim diagnose search.", "search.false_alarm=", "search."),
        ("rovsim compare sea", "search.", "sea"),
        ("rovsim export to=", "stonefish ", ""),
        ("rovsim compare model=[nominal,zero", "[nominal,zero_acceleration", "[nominal,zero"),
        ("rovsim add 'effects=[lift,thruster_l", "effects=[lift,thruster_lag", "effects=[lift,"),
        ("rovsim design between=[input", "[input_delay", "[input"),
        ("rovsim train -", "--multirun ", "-"),
        ("rovsim blind blind.suite=st", "standard ", "st"),
    ],
)
def test_it_finds(line, one, all_begin):
    assert one in found(line)
    assert all(word.startswith(all_begin) for word in found(line))


def test_files_are_found_with_odd_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my tank (é)").mkdir()
    (tmp_path / "my tank (é)" / "new.yaml").touch()
    (tmp_path / "notes.txt").touch()
    (tmp_path / ".hidden").mkdir()
    assert found("rovsim compare campaign=") == [r"my\ tank\ \(é\)/"]
    assert found("rovsim compare 'campaign=my") == ["campaign=my tank (é)/"]
    assert r"my\ tank\ \(é\)/new.yaml " in found(r"rovsim compare model=my\ tank\ \(é\)/n")
    assert found("rovsim init n") == ["notes.txt "]
    assert found("rovsim compare model=./", "fish")[-1:] == [r"model=./my\ tank\ \(é\)/"]


def test_a_key_that_is_given_is_not_offered_again():
    assert "campaign=" in suggest(["compare"], "")
    assert "campaign=" not in suggest(["compare", "campaign=tank"], "")


@given(st.sampled_from(sorted(SCRIPTS)), st.text(max_size=40))
def test_an_odd_line_is_no_error(shell, line):
    assert isinstance(complete([shell, f"rovsim {line}"]), str)


@pytest.mark.parametrize("command", commands())
def test_every_command_has_keys_of_its_own(command):
    known = settings()
    for key in suggest([command], ""):
        if not os.path.exists(key):  # `init` takes files
            assert any(one.startswith(key.rstrip("=")) for one in known), key


def test_it_answers_without_importing_what_takes_time():
    code = (
        "import sys; from rovsim.apps.cli.main import main; "
        "main(['completion', 'bash', 'rovsim add effects=[']); "
        f"print([name for name in {HEAVY} if name in sys.modules])"
    )
    told = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.splitlines()
    assert told[-1] == "[]"
    assert len(told) == 1 + len(built_in())


def test_bash_puts_it_into_the_line(tmp_path):
    """Each as bash takes it: from the last = on, and in a quote the whole word."""
    (tmp_path / "rovsim").write_text(f'#!/bin/sh\nexec {sys.executable} -m rovsim "$@"\n')
    (tmp_path / "rovsim").chmod(0o755)
    script = (
        SCRIPTS["bash"]
        + """
COMP_WORDS=(rovsim); COMP_LINE='rovsim compare filter=b'; COMP_POINT=${#COMP_LINE}
_rovsim; printf '<%s>' "${COMPREPLY[@]}"; complete -p rovsim"""
    )
    path = f"{tmp_path}:{os.environ['PATH']}"
    told = subprocess.run(
        ["bash", "-c", script],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PATH": path},
    )
    assert told.stdout == "<butterworth >complete -o nospace -F _rovsim rovsim\n"


@pytest.mark.skipif(shutil.which("fish") is None, reason="fish is not installed")
def test_fish_understands_its_script():
    line = f"{SCRIPTS['fish']}\ncomplete -C 'rovsim compare filter=b'"
    told = subprocess.run(["fish", "-c", line], capture_output=True, text=True, check=True)
    assert told.stdout == "filter=butterworth\n"


def test_an_unknown_shell_is_explained(capsys):
    for words, told in (
        (["completion", "bsh"], "Did you mean 'bash'"),
        (["completion"], "no shell"),
    ):
        with pytest.raises(SystemExit) as ended:
            main(words)
        assert ended.value.code == 2
        assert told in unfolded(capsys.readouterr().err)


def test_each_shell_gets_its_script(capsys):
    for shell in SCRIPTS:
        main(["completion", shell])
        assert "completion" in capsys.readouterr().out
    assert {"butterworth", "savgol"} <= {*conf_names("filter")}
