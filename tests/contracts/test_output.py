"""What a command says when it is done, and who hears of its progress."""

import pytest

from rovsim.apps.cli.main import main
from rovsim.core.progress import counted, heard_by, reported, staged


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
        with staged("diagnosing", {"reading": 0.0, "scoring": 0.9}) as stage:
            stage("reading")
            stage("scoring")
    shares = [share for what, share in told if what == "counting"]
    assert shares == [None, 0.0, 0.25, 0.5, 0.75]
    assert ("reporting", 0.5) in told
    assert told[-1] == ("diagnosing: scoring", 0.9)
