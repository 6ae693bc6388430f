"""A sweep that was interrupted goes on where it stopped, and never keeps what is no longer true."""

import json
import logging
from pathlib import Path

import pytest

from rovsim.apps.cli.main import main
from rovsim.core.yaml_files import read_yaml, write_yaml
from rovsim.dynamics.model_file import write_model
from said import unfolded
from worlds import model

SWEEP = ["compare", "-m", "campaign=raw", "model=nominal,mine.yaml", "out=out"]


# Hydra opens a log for each run, and leaves it to the end of the process
pytestmark = [
    pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
    pytest.mark.usefixtures("logging_as_before"),
]


@pytest.fixture
def logging_as_before():
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    yield
    root.handlers[:] = handlers
    root.setLevel(level)


@pytest.fixture
def ran(tmp_path, monkeypatch):
    """Folders of the runs that were begun; a run writes a file into its own."""
    monkeypatch.chdir(tmp_path)
    main(["tank", "tank=tiny", "tank.duration=3", "out=raw", "-q"])
    write_model(model(), Path("mine.yaml"))
    begun = []

    def run(settings):
        begun.append(settings.out)
        out = Path(settings.out)
        out.mkdir(parents=True, exist_ok=True)
        (out / "result.json").write_text("{}")

    monkeypatch.setattr("rovsim.apps.cli.unfinished.run_command", run)
    return begun


def change_during_runs(monkeypatch, ran, change):
    """From now on, runs do something else before they end."""

    def run(settings):
        ran.append(settings.out)
        change()

    monkeypatch.setattr("rovsim.apps.cli.unfinished.run_command", run)


def test_finished_runs_are_kept_and_it_is_said(ran, capsys):
    main(SWEEP)
    assert ran == ["out/0", "out/1"]
    capsys.readouterr()
    Path("out/1/finished.json").unlink()
    main(SWEEP)
    assert ran[2:] == ["out/1"]
    said = unfolded(capsys.readouterr().out)
    assert "out/0: finished before, and nothing that it depends on has changed since" in said
    assert "out/1" not in said.partition("#1")[0]
    main([*SWEEP, "--quiet"])
    assert ran[3:] == []


def edit_recording():
    file = next(path for path in sorted(Path("raw").glob("*.csv")))
    file.write_text(file.read_text() + "\n")


def edit_vehicle():
    content = read_yaml(Path("mine.yaml"))
    content["effects"] = [{"effect": "lift", "parameters": {"coefficient": 3.0}}]
    write_yaml(Path("mine.yaml"), content)


def break_mark():
    mark = json.loads(Path("out/1/finished.json").read_text())
    Path("out/1/finished.json").write_text(json.dumps({**mark, "schema": "another/1"}))


OTHER = {
    "a setting": ([*SWEEP, "filter=savgol"], lambda: None, ["out/0", "out/1"]),
    "a recording": (SWEEP, edit_recording, ["out/0", "out/1"]),
    "the code": (SWEEP, None, ["out/0", "out/1"]),
    "a model": (SWEEP, edit_vehicle, ["out/1"]),
    "a result": (SWEEP, lambda: Path("out/1/result.json").write_text("[]"), ["out/1"]),
    "no result": (SWEEP, lambda: Path("out/1/result.json").unlink(), ["out/1"]),
    "the mark": (SWEEP, break_mark, ["out/1"]),
}


@pytest.mark.parametrize("what", OTHER)
def test_what_is_another_is_run_again(what, ran, monkeypatch):
    words, change, again = OTHER[what]
    main(SWEEP)
    ran.clear()
    if change is None:
        monkeypatch.setattr("rovsim.application.provenance.own_digest", lambda *_: "edited")
    else:
        change()
    main(words)
    assert ran == again
    main(words)
    assert ran == again


def test_an_interrupted_sweep_says_how_it_goes_on(ran, monkeypatch, capsys):
    def interrupt():
        raise KeyboardInterrupt

    words = [word for word in SWEEP if not word.startswith("out=")]
    with monkeypatch.context() as patch:
        change_during_runs(patch, ran, interrupt)
        with pytest.raises(SystemExit, match="130"):
            main([*words, "hydra.sweep.dir=there"])
    assert "the same sweep with hydra.sweep.dir=there goes on" in unfolded(capsys.readouterr().err)
    main([*words, "hydra.sweep.dir=there"])
    assert [Path(folder).name for folder in ran] == ["0", "0", "1"]


def test_a_run_whose_recordings_are_changed_while_it_runs_is_not_kept(ran, monkeypatch):
    with monkeypatch.context() as patch:
        change_during_runs(patch, ran, edit_recording)
        main(SWEEP)
    main(SWEEP)
    assert ran == ["out/0", "out/1"] * 2
