"""Where compiled code is cached: one folder for each version of the sources.

Numba's cache checks the file of a function, but not those of the functions that it calls. So the
name of our folder is a digest of all sources that can be compiled into it: the engine, the kernels
of effects, laws, learned residuals and the estimation, and Numba's version. After any edit the next
run uses a new, empty folder, so that the cache is never stale. Each process marks its folder as
used when it starts, and removes folders that no process marked for 30 days.
"""

import hashlib
import os
import shutil
import time
from contextlib import suppress
from functools import cache
from pathlib import Path

import numba
from platformdirs import user_cache_path

DYNAMICS_FOLDER = Path(__file__).parents[1]
# Folders of all compiled functions, relative to that of `dynamics`.
COMPILED_FOLDERS = ("compilation", "engine", "effects", "laws", "learned", "../estimation/kernels")
# s, 30 days; our choice. A longer process loses nothing: Numba compiles again what is missing.
MAX_UNUSED_SECONDS = 30 * 86400.0


@cache
def cache_folder() -> Path:
    """Folder of the code compiled from these sources, in $ROVSIM_CACHE or the user's cache."""
    root = Path(os.environ.get("ROVSIM_CACHE") or user_cache_path("rovsim"))
    folder = root / "compiled" / _digest_sources()
    with suppress(OSError):  # where nothing can be written, Numba says so
        folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)
        prune(folder.parent)
    return folder


def prune(folders: Path) -> None:
    """Remove the folders in `folders` that no process marked as used for `MAX_UNUSED_SECONDS`."""
    oldest = time.time() - MAX_UNUSED_SECONDS
    for folder in folders.iterdir():
        with suppress(OSError):  # another process may have removed it
            if folder.stat().st_mtime < oldest:
                shutil.rmtree(folder)


def _digest_sources() -> str:
    files = sorted(
        file for name in COMPILED_FOLDERS for file in DYNAMICS_FOLDER.joinpath(name).rglob("*.py")
    )
    return digest(numba.__version__.encode(), *(file.read_bytes() for file in files))


def digest(*parts: bytes) -> str:
    """A short hexadecimal digest (SHA-256) of these bytes."""
    return hashlib.sha256(b"\n".join(parts)).hexdigest()[:16]
