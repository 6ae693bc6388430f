"""What a command says when it is done, and who hears of its progress."""

import pytest

from rovsim.apps.cli.main import main
from rovsim.core.columns import fold
from rovsim.core.progress import begin_stage, counted, heard_by, reported, staged, step


@pytest.mark.parametrize("flag", ["--quiet", "-q", "output=quiet"])
def test_quiet_says_nothing_and_tells_no_progress(tmp_path, capsys, flag):
    told = []
    with heard_by(lambda what, share: told.append(what)):
        main(["tank", "tank=tiny", "tank.duration=4", f"out={tmp_path / 'raw'}", flag])
    found = capsys.readouterr()
    assert (found.out, found.err, told) == ("", "", [])
    assert (tmp_path / "raw" / "campaign.yaml").exists()


def test_an_unknown_output_is_explained(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["tank", "output=loud"])
    assert ended.value.code == 2
    assert "output" in capsys.readouterr().err


def test_progress_reaches_a_listener_and_never_goes_back():
    told = []
    with heard_by(lambda what, share: told.append((what, share))):
        assert list(counted("abcd", "counting")) == list("abcd")
        with reported("reporting") as progress:
            progress(1, 2)
        with staged("diagnosing", {"reading": 0.0, "scoring": 0.9}):
            begin_stage("reading")
            begin_stage("scoring")
    shares = [share for what, share in told if what == "counting"]
    assert shares == [None, 0.0, 0.25, 0.5, 0.75]
    assert ("reporting", 0.5) in told
    assert told[-1] == ("diagnosing: scoring", 0.9)


def test_a_stage_goes_on_with_its_steps_and_never_back():
    told = []
    with (
        heard_by(lambda what, share: told.append((what, share))),
        staged("diagnosing", {"observing": 0.1, "searching": 0.5, "checking": 0.9}),
    ):
        for name in ("observing", "searching", "checking", "observing"):  # it may begin again
            begin_stage(name)
            for _ in range(50):
                step()
        begin_stage("checking")  # of whatever bar there is
    assert told[-1][0] == "diagnosing: checking"
    shares = [share for _, share in told if share is not None]
    assert shares == sorted(shares)
    assert len(shares) > 60
    assert 0.3 < max(s for what, s in told if s and what.endswith("observing") and s < 0.5) < 0.5
    assert shares[-1] < 1.0
    begin_stage("observing")  # nobody looks
    step()


def test_a_diagnosis_tells_of_its_steps_and_of_every_figure(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("rovsim.core.second_process.usable_cores", lambda: 1)
    main(["tank", "tank=tiny", "tank.duration=20", "out=raw", "--quiet"])
    told = []
    with heard_by(lambda what, share: told.append((what, share))):
        main(["diagnose", "campaign=raw", "out=found", "--json"])
    assert len({share for what, share in told if what == "diagnosing: observing"}) > 20
    assert len({share for what, share in told if what == "drawing"}) > 3


def test_what_is_typed_is_not_folded():
    message = f"{'word ' * 14}Install it: pip install 'rovsim[learn]'."
    assert any("pip install 'rovsim[learn]'" in line for line in fold(message))
    assert max(map(len, fold(message))) <= 80
