"""A second process does the same as this one, and never outlives it."""

import os
import signal
import subprocess
import sys
import time
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from pathlib import Path

import pytest

from rovsim.core import second_process as second
from rovsim.core.errors import BadInput, RovsimError
from rovsim.core.second_process import call, second_process
from rovsim.core.termination import Terminated, heeding_termination

UNKNOWN = "tabnanny"  # a module of Python that nothing else imports
FAILS = "rovsim.application.configuration:compose", ["no_such_key=1"]
PARENT = """
from rovsim.core.second_process import call, second_process
if __name__ == "__main__":
    with second_process("tabnanny") as other:
        print(other.submit(call, "os:getpid").result(), flush=True)
        other.submit(call, "time:sleep", 20).result()
"""


@pytest.fixture(params=[1, 2])
def cores(request, monkeypatch):
    """Without and with a core to spare."""
    monkeypatch.setattr(second, "usable_cores", lambda: request.param)
    return request.param


def test_it_is_another_process_where_a_core_is_to_spare(cores):
    with second_process(UNKNOWN) as other:
        assert (other.submit(call, "os:getpid").result() == os.getpid()) == (cores == 1)
    assert UNKNOWN not in sys.modules


def test_it_is_this_process_where_everything_is_imported(monkeypatch):
    monkeypatch.setattr(second, "usable_cores", lambda: 2)
    with second_process("os", "sys") as other:
        assert other.submit(call, "os:getpid").result() == os.getpid()


def test_its_errors_are_those_of_this_process(cores):
    with pytest.raises(BadInput) as here:
        call(*FAILS)
    with pytest.raises(BadInput) as there, second_process(UNKNOWN) as other:
        other.submit(call, *FAILS).result()
    assert str(there.value) == str(here.value)


def test_one_that_is_killed_is_a_message(monkeypatch):
    monkeypatch.setattr(second, "usable_cores", lambda: 2)
    with pytest.raises(RovsimError, match="start the command again"), second_process(UNKNOWN) as o:
        o.submit(call, "os:_exit", 1).result()


def test_where_it_was_killed_this_process_goes_on(monkeypatch):
    monkeypatch.setattr(second, "usable_cores", lambda: 2)
    with second_process(UNKNOWN) as other:
        with pytest.raises(BrokenProcessPool):
            other.submit(call, "os:_exit", 1).result()
        assert other.submit(call, "os:getpid").result() == os.getpid()


def test_an_error_does_not_wait_for_it(monkeypatch):
    monkeypatch.setattr(second, "usable_cores", lambda: 2)
    begun = time.monotonic()
    with pytest.raises(BadInput), second_process(UNKNOWN) as other:
        _fail_beside(other)
    assert time.monotonic() - begun < 50


def test_an_error_while_it_starts_prints_nothing_of_it(monkeypatch, tmp_path, capfd):
    monkeypatch.setattr(second, "usable_cores", lambda: 2)
    monkeypatch.setattr(second, "_obey_the_first", partial(_obey_slowly, tmp_path / "begun"))
    with pytest.raises(BadInput), second_process(UNKNOWN):
        _fail_once_there_is(tmp_path / "begun")
    assert capfd.readouterr().err == ""


def test_what_it_was_writing_goes_with_it(monkeypatch, tmp_path):
    monkeypatch.setattr(second, "usable_cores", lambda: 2)
    source, out = tmp_path / "pipe", tmp_path / "out"
    os.mkfifo(source)
    out.mkdir()
    pipe = os.open(source, os.O_RDWR)  # kept open: who copies from it waits for more
    begun = time.monotonic()
    with pytest.raises(Terminated), heeding_termination(), second_process(UNKNOWN) as other:
        _be_told_to_end_amid_a_copy(other, source, out)
    os.close(pipe)
    assert time.monotonic() - begun < 50
    assert not list(out.iterdir())


def test_it_ends_when_this_process_is_killed(tmp_path):
    if second.usable_cores() < 2:
        pytest.skip("one core: there is no second process")
    script = tmp_path / "parent.py"
    script.write_text(PARENT)
    with subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        other = int(parent.stdout.readline())
        assert other != parent.pid
        assert _runs(other)
        parent.send_signal(signal.SIGKILL)
        until = time.monotonic() + 30
        while _runs(other) and time.monotonic() < until:
            time.sleep(0.05)
    assert not _runs(other)


OBEY = second._obey_the_first


def _obey_slowly(begun):
    """Begin as the second process does, and be at it for as long as the test may need."""
    OBEY()
    begun.touch()
    time.sleep(60)


def _fail_beside(other):
    """An error while the other process is at work."""
    other.submit(call, "os:getpid").result()
    other.submit(call, "time:sleep", 60)
    call(*FAILS)


def _fail_once_there_is(begun):
    while not begun.exists():
        time.sleep(0.05)
    call(*FAILS)


def _be_told_to_end_amid_a_copy(other, source, out):
    other.submit(call, "rovsim.core.files:copy_file", source, out / "copy")
    other.submit(call, "time:sleep", 60)  # waits for its turn, which must not come
    while not list(out.iterdir()):
        time.sleep(0.05)
    os.kill(os.getpid(), signal.SIGTERM)


def _runs(process: int) -> bool:
    """Whether a process is there; one that ended and was not asked about yet is not."""
    try:
        return "State:\tZ" not in Path(f"/proc/{process}/status").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False
