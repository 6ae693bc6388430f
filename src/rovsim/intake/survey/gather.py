"""Gather the files that the user named, and the files in named folders."""

from pathlib import Path
from typing import Sequence

from rovsim.core.errors import BadInput
from rovsim.intake.survey.sniff import sniff

BAG_SUFFIXES = (".db3", ".mcap")
# A reader takes so much into memory at once, several times over; bags are read bit by bit.
MAX_BYTES = 1 << 30
MAX_FILES = 500  # in a folder: more is no folder of recordings
# Names of what rovsim itself writes into such folders, or keeps beside recordings.
IGNORED_FILES = ("campaign.yaml", "truth.yaml", "metadata.yaml")


def gather(paths: Sequence[Path]) -> tuple[list[Path], list[Path]]:
    """Gather recordings.

    In a folder without recordings of its own, each folder inside is taken as one run.

    Returns:
        Files and bag folders that were named, and those that lie in named folders.

    Raises:
        BadInput: a path does not exist, is too large, or is no folder of recordings.
    """
    recordings: list[Path] = []
    inside: list[Path] = []
    for path in paths:
        if path.is_dir() and not is_bag(path):
            inside += _within(path)
        else:
            recordings.append(_checked(path))
    recordings = _once(recordings)
    return recordings, [
        path for path in _once(inside) if path.resolve() not in _resolved(recordings)
    ]


def is_bag(path: Path) -> bool:
    """Whether a folder is a ROS 2 bag: its files belong together."""
    storage = (
        any(file.suffix in BAG_SUFFIXES for file in path.iterdir()) if path.is_dir() else False
    )
    return storage and (path / "metadata.yaml").is_file()


def _within(folder: Path) -> list[Path]:
    direct = _directly_within(folder)
    if any(map(_is_recording, direct)):
        return direct
    inner = [p for p in sorted(folder.iterdir()) if p.is_dir() and not p.name.startswith(".")]
    deeper = [path for subfolder in inner for path in _directly_within(subfolder)]
    if not direct and not deeper:
        raise BadInput(
            "the folder holds no recordings",
            where=folder,
            expected="exported motions and command logs",
            remedy="Name the folder or the files of your recordings.",
        )
    return direct + deeper


def _is_recording(path: Path) -> bool:
    try:
        return bool(sniff(path))
    except (BadInput, OSError):
        return False


def _directly_within(folder: Path) -> list[Path]:
    entries = sorted(p for p in folder.iterdir() if not p.name.startswith("."))
    if len(entries) > MAX_FILES:
        raise BadInput(
            f"{len(entries)} files",
            where=folder,
            expected=f"a folder of recordings, at most {MAX_FILES} files",
            remedy="Name the recordings themselves, or put them into a folder of their own.",
        )
    bags = [p for p in entries if p.is_dir() and is_bag(p)]
    files = [p for p in entries if p.is_file() and p.name not in IGNORED_FILES and p.stat().st_size]
    return bags + [p for p in files if p.suffix in BAG_SUFFIXES or p.stat().st_size <= MAX_BYTES]


def _checked(path: Path) -> Path:
    if path.is_dir() or (path.is_file() and 0 < path.stat().st_size <= MAX_BYTES):
        return path
    if path.is_file() and path.suffix in BAG_SUFFIXES and path.stat().st_size:
        return path
    if not path.exists():
        problem, remedy = "no such file or folder", "Check the path."
    elif not path.is_file():
        problem, remedy = "neither a file nor a folder", "Name a recording."
    elif not path.stat().st_size:
        problem, remedy = "the file is empty", "Export the run again."
    else:
        problem = f"{path.stat().st_size / 2**30:.1f} GiB"
        remedy = "Cut it into runs of minutes, and export only what is needed."
    raise BadInput(problem, where=path, expected="a recording of at most 1 GiB", remedy=remedy)


def _once(paths: Sequence[Path]) -> list[Path]:
    return list({path.resolve(): path for path in reversed(paths)}.values())[::-1]


def _resolved(paths: Sequence[Path]) -> set[Path]:
    return {path.resolve() for path in paths}
