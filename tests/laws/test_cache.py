"""Laws of what compiled code leaves on disk."""

import os
import shutil
import subprocess
import sys
import time

import pytest
from filelock import FileLock

from rovsim.dynamics.compilation.cache import MAX_UNUSED_SECONDS, cache_folder, prune
from rovsim.dynamics.compilation.compiled import lock_file
from rovsim.dynamics.engine.vectors import dot3

DAY = 86400.0


@pytest.fixture
def folders(tmp_path):
    """Folders of compiled code by their age in days, a file in each."""

    def make(*ages):
        for age in ages:
            folder = tmp_path / f"{age:g}"
            folder.mkdir()
            (folder / "engine.py").touch()
            os.utime(folder, (then := time.time() - age * DAY, then))
        return tmp_path

    return make


def test_only_folders_that_nobody_used_for_a_month_are_removed(folders):
    root = folders(0, 1, 29.9, 30.1, 400)
    prune(root)
    assert sorted(folder.name for folder in root.iterdir()) == ["0", "1", "29.9"]


def test_what_another_process_removes_first_is_no_error(folders, monkeypatch):
    def remove_twice(folder, rmtree=shutil.rmtree):
        rmtree(folder)
        rmtree(folder)

    monkeypatch.setattr("rovsim.dynamics.compilation.cache.shutil.rmtree", remove_twice)
    root = folders(1, 40, 50)
    prune(root)
    assert [folder.name for folder in root.iterdir()] == ["1"]


def test_a_process_marks_its_folder_as_used(folders, monkeypatch):
    monkeypatch.setenv("ROVSIM_CACHE", str(folders()))
    cache_folder.cache_clear()
    try:
        folder = cache_folder()
        os.utime(folder, (0.0, 0.0))
        cache_folder.cache_clear()
        assert cache_folder() == folder
        assert time.time() - folder.stat().st_mtime < MAX_UNUSED_SECONDS / 30
    finally:
        cache_folder.cache_clear()


ONE_OF_TWO = """
from rovsim.dynamics.engine.vectors import dot3
print("ready", flush=True)
dot3((1.0, 2.0, 3.0), (1.0, 2.0, 3.0))
print(sum(dot3.stats.cache_misses.values()))
"""


def test_of_two_processes_that_need_a_function_one_compiles_it(tmp_path, monkeypatch):
    monkeypatch.setenv("ROVSIM_CACHE", str(tmp_path))
    cache_folder.cache_clear()
    lock = FileLock(lock_file(dot3))
    cache_folder.cache_clear()
    command = [sys.executable, "-c", ONE_OF_TWO]
    with lock:  # until both have come to it
        two = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
        assert [one.stdout.readline() for one in two] == 2 * ["ready\n"]
        time.sleep(0.2)
        assert [one.poll() for one in two] == [None, None]
    compiled = [one.communicate(timeout=60)[0] for one in two]
    assert sorted(compiled) == ["0\n", "1\n"]


FORKED = """
import os
from rovsim.dynamics.engine.vectors import dot3
child = os.fork()
if not child:
    dot3((1.0, 2.0, 3.0), (1.0, 2.0, 3.0))
    os._exit(0)
raise SystemExit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


def test_a_forked_process_compiles(tmp_path, monkeypatch):
    monkeypatch.setenv("ROVSIM_CACHE", str(tmp_path))
    done = subprocess.run([sys.executable, "-c", FORKED], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
