"""Write files that appear whole or not at all, and read them. Nothing read is ever executed."""

import errno
import glob
import hashlib
import json
import os
import shutil
import tempfile
from contextlib import contextmanager
from itertools import chain, count
from pathlib import Path
from socket import gethostname
from typing import Any, Iterator, Mapping, TextIO

import numpy as np

from rovsim.core.errors import BadInput

MARK_BYTES = 1 << 16  # at the start of a result, in which its mark must be
NO_ROOM_ERRORS = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # while writing


@contextmanager
def appearing(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`; on success it becomes `path` in one step.

    Raises:
        BadInput: no file can be written there.
    """
    temporary = _beside(path)
    try:
        yield temporary
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError as error:
        if error.errno not in NO_ROOM_ERRORS:
            raise
        raise unwritable(path, error) from None
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def folder_beside(path: Path, named: Path | None = None) -> Iterator[Path]:
    """Yield a new temporary folder beside `path`, for files that are then moved; delete it after.

    Args:
        path: the place to which the files will be moved.
        named: what errors name instead of the temporary folder, which the user does not know; by
            default `path`.

    Raises:
        BadInput: the folder cannot be made, or a file in it cannot be written.
    """
    folder = _beside(path, a_folder=True)
    try:
        yield folder
    except BadInput as error:
        if str(folder) not in error.where:
            raise
        where = error.where.replace(str(folder), str(named or path), 1)
        raise BadInput(
            error.found, where=where, expected=error.expected, remedy=error.remedy
        ) from None
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def appearing_together(folder: Path, last: str) -> Iterator[Path]:
    """Yield a temporary folder; on success all its files move into `folder` and replace old ones.

    Files in inner folders move, too. All files are complete before the first moves, so a full disk
    leaves the old ones intact. The file `last` is moved last: if it is new, all files are.

    Raises:
        BadInput: no file can be written there.
    """
    with folder_beside(folder / last, named=folder) as temporary:
        yield temporary
        files = [path.relative_to(temporary) for path in temporary.rglob("*") if path.is_file()]
        files.sort(key=lambda path: (path == Path(last), path))
        for target in {folder / path.parent for path in files}:
            make_folder(target)  # before the first file moves, so that errors leave the old files
        for path in files:
            os.replace(temporary / path, folder / path)


def _beside(path: Path, a_folder: bool = False) -> Path:
    """Make a new empty file (or folder) in the folder of `path`, which is made if it is missing.

    Its name contains a hash of the final name, the machine and the process, so that what a killed
    process left behind is recognised and removed here.
    """
    file = hashlib.sha256(os.fsencode(path.name)).hexdigest()[:12]
    prefix = f".{file}-{gethostname()[:40]}-"
    try:
        if path.is_dir() and not a_folder:
            raise IsADirectoryError(errno.EISDIR, "a folder of that name is in the way")
        path.parent.mkdir(parents=True, exist_ok=True)
        for leftover in path.parent.glob(f"{glob.escape(prefix)}*"):
            if not _lives(leftover.name.removeprefix(prefix).partition("-")[0]):
                _remove(leftover)
        own_prefix = f"{prefix}{os.getpid()}-"
        if a_folder:
            return Path(tempfile.mkdtemp(dir=path.parent, prefix=own_prefix))
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=own_prefix, suffix=path.suffix)
    except OSError as error:
        raise unwritable(path, error) from None
    os.close(handle)
    return Path(name)


def make_folder(folder: Path) -> None:
    """Make a folder, if it is not there.

    Raises:
        BadInput: it cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(folder, error) from None


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _lives(process: str) -> bool:
    """Whether the process of this machine with that number still runs; True if it is unknown."""
    try:
        os.kill(int(process), 0)
    except ProcessLookupError:
        return False
    except (ValueError, OSError):  # not a number, or a process of another user
        pass
    return True


def unwritable(path: Path, error: OSError) -> BadInput:
    """Make the error for a place where no file can be written."""
    return BadInput(
        f"cannot be written ({error.strerror})",
        where=path,
        expected="a place where a file can be written",
        remedy="Name another place, or make room there and let files be written.",
    )


@contextmanager
def text_appearing(path: Path) -> Iterator[TextIO]:
    """Yield a UTF-8 text file to write to; on success it becomes `path` in one step."""
    with appearing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        yield file


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file atomically."""
    with appearing(path) as temporary:
        temporary.write_bytes(content)


def copy_file(source: Path, path: Path) -> None:
    """Copy a file atomically."""
    with source.open("rb") as content, appearing(path) as temporary, temporary.open("wb") as copy:
        shutil.copyfileobj(content, copy)


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text atomically."""
    write_bytes(path, text.encode("utf-8"))


def sha256_of(path: Path) -> str:
    """The SHA-256 of a file, in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def find_free(path: Path, joint: str) -> Path:
    """This path, or the first one with a number behind its stem, at which nothing stands yet.

    Args:
        path: that is wanted.
        joint: stands before the number, which begins with 2.
    """
    numbered = (path.with_stem(f"{path.stem}{joint}{k}") for k in count(2))
    return next(p for p in chain([path], numbered) if not p.exists())


def write_beside(path: Path, text: str) -> Path | None:
    """Write UTF-8 text atomically; what stood there and says something else is kept beside it.

    Returns:
        The name under which that is kept: the first that is free of NAME.earlier.yaml,
        NAME.earlier-2.yaml, … None where nothing else stood there.
    """
    kept, content = None, text.encode("utf-8")
    if path.is_file() and path.read_bytes() not in (b"", content):
        kept = find_free(path.with_stem(f"{path.stem}.earlier"), "-")
        copy_file(path, kept)
    write_bytes(path, content)
    return kept


def write_json(path: Path, content: Any) -> None:
    """Write JSON atomically; NaN is refused (it is not JSON)."""
    write_text(path, json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False) + "\n")


def read_json(path: Path) -> Any:
    """Read JSON.

    Raises:
        BadInput: the file is missing or is not JSON.
    """
    try:
        return json.loads(read_text(path))
    except json.JSONDecodeError as error:
        fault, where = error.msg, f"{path}, line {error.lineno}"
    except (ValueError, RecursionError) as error:  # a number too long, or nested too deeply
        fault, where = str(error), f"{path}"
    raise BadInput(
        f"not JSON ({fault})",
        where=where,
        expected="a JSON file",
        remedy="Write the file again with the command that made it.",
    )


def require_replaceable(path: Path, mark: str) -> None:
    """Refuse to replace a file at `path` that is not an older result of the same kind.

    Args:
        path: where a result will be written.
        mark: text near the start of every result of this kind.

    Raises:
        BadInput: there is a file without that mark.
    """
    if not path.is_file():
        return
    with path.open("rb") as file:
        start = file.read(MARK_BYTES)
    if start and mark.encode() not in start:
        raise BadInput(
            "another file is there, which rovsim did not write",
            where=path,
            expected="a name that is free, or an older result of the same kind",
            remedy="Give another name, or move that file away.",
        )


def read_text(path: Path) -> str:
    """Read UTF-8 text (a byte-order mark is dropped).

    Raises:
        BadInput: the file is missing, a folder, a device or not UTF-8.
    """
    try:
        if path.is_file() or not path.exists() or path.is_dir():
            return path.read_text(encoding="utf-8-sig")
        fault, remedy = "no file but a device or a pipe", "Copy its content into a file."
    except FileNotFoundError:
        fault, remedy = "no such file", "Check the path."
    except IsADirectoryError:
        fault, remedy = "a folder", "Name the file inside it."
    except UnicodeDecodeError as error:
        fault, remedy = f"byte {error.start} is not UTF-8", "Save the file as UTF-8 text."
    except OSError as error:
        fault, remedy = f"cannot be read ({error.strerror})", "Check its permissions."
    raise BadInput(fault, where=path, expected="a readable text file", remedy=remedy)


def plain(value: Any) -> Any:
    """Turn arrays and NumPy scalars into lists and numbers, for JSON and YAML."""
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value
