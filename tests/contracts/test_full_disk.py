"""A full disk, a folder that may not be written to: one message, whole files, what was there stays.

The limit on the size of a file stands for the disk (EFBIG for ENOSPC); as root, a disk of 256 kB.
"""

import os
import resource
import subprocess
from contextlib import contextmanager

import numpy as np
import pytest
from matplotlib.figure import Figure

from rovsim.application.pipeline import training
from rovsim.apps.cli.main import main
from rovsim.core.array_files import write_arrays
from rovsim.core.errors import BadInput
from rovsim.core.files import copy_file, folder_beside, write_bytes, write_json, write_text
from rovsim.dynamics.learned.residual import ARRAYS_FILE
from rovsim.reporting.figures import signature, style


@contextmanager
def largest(size):
    """No file that this process writes may become larger, in bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def _drawn():
    figure = Figure()
    figure.subplots().plot(np.random.default_rng(0).normal(size=5000))
    return figure


def _copied(path):
    source = path.with_name("source")
    source.symlink_to(np.__file__)
    copy_file(source, path)


WRITERS = {
    "x.json": lambda path: write_json(path, list(range(10_000))),
    "x.txt": lambda path: write_text(path, "x" * 10_000),
    "x.npz": lambda path: write_arrays(path, x=np.arange(10_000.0)),
    "x.copy": _copied,
    "x.pdf": lambda path: style.save(_drawn(), path.parent, "x"),
    "x.png": lambda path: signature.write(_drawn(), path),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_is_one_message_and_leaves_what_was_there(name, tmp_path):
    path = tmp_path / name
    write_bytes(path, b"whole")
    with largest(1000), pytest.raises(BadInput, match=rf"{name}: cannot be written .* make room"):
        WRITERS[name](path)
    assert path.read_bytes() == b"whole"
    assert {p.name for p in tmp_path.iterdir()} - {"source"} == {name}


@pytest.fixture
def small_disk(tmp_path):
    """A disk of 256 kB."""
    place = tmp_path / "disk"
    place.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", "size=256k", "none", str(place)]
    if os.geteuid() or subprocess.run(words, capture_output=True, check=False).returncode:
        pytest.skip("only root mounts a disk")
    yield place
    subprocess.run(["umount", str(place)], check=True)


@pytest.mark.usefixtures("few_figures")
def test_a_command_on_a_full_disk_says_which_file(small_disk, tmp_path, capsys):
    main(["tank", "tank=tiny", "tank.duration=8", f"out={tmp_path}/tank"])
    write_bytes(small_disk / "others", bytes(240 << 10))
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        main(["compare", f"campaign={tmp_path}/tank", f"out={small_disk}/out", "--quiet"])
    said = " ".join(capsys.readouterr().err.split())  # it is folded
    assert ended.value.code == 2
    assert said.startswith(f"rovsim: {small_disk}/out/")
    assert "cannot be written (No space left on device)" in said
    assert "Traceback" not in said
    assert not list((small_disk / "out").iterdir()), "a comparison is there whole or not at all"


def test_a_tank_on_a_full_disk_leaves_no_folder(tmp_path):
    words = ["tank", "tank=tiny", "tank.duration=8", f"out={tmp_path}/new"]
    with largest(1000), pytest.raises(SystemExit):
        main(words)
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("few_figures")
def test_a_model_is_never_beside_the_arrays_of_another_training(tmp_path, monkeypatch):
    def full(*_):
        raise BadInput("no room", where="x", expected="room", remedy="Make room.")

    monkeypatch.chdir(tmp_path)
    main(["tank", "tank=tiny", "tank.duration=8", "out=tank"])
    words = ["train", "campaign=tank", "residual=knn", "out=trained"]
    main(words)
    kept = {
        name: (tmp_path / "trained" / name).read_bytes() for name in ("model.yaml", ARRAYS_FILE)
    }
    monkeypatch.setattr(training, "write_model", full)
    with pytest.raises(SystemExit):
        main([*words, "residual.k=9", "residual.weights=uniform", "seed=3"])
    assert {name: (tmp_path / "trained" / name).read_bytes() for name in kept} == kept


def test_the_message_names_the_place_that_was_meant(tmp_path):
    def write():
        with folder_beside(tmp_path / "new") as folder:
            write_text(folder / "x.txt", "x" * 10_000)

    with largest(1000), pytest.raises(BadInput, match=rf"^{tmp_path}/new/x\.txt: cannot"):
        write()
