"""Files that appear whole or not at all. No pickle anywhere: JSON, safe YAML and plain arrays."""

import copy
import errno
import io
import json
import os
import tempfile
import zipfile
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any, Iterator, Mapping

import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from rovsim.core.errors import BadInput


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
    finally:
        temporary.unlink(missing_ok=True)


def _beside(path: Path) -> Path:
    """A new empty file in the folder of `path`, which is made if need be."""
    try:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, "a folder of that name is in the way")
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=".", suffix=path.suffix)
    except OSError as error:
        raise BadInput(
            f"cannot be written ({error.strerror})",
            where=path,
            expected="a place where a file can be written",
            remedy="Name another place, or make that one writable.",
        ) from None
    os.close(handle)
    return Path(name)


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text atomically."""
    with appearing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


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
        raise BadInput(
            f"not JSON ({error.msg})",
            where=f"{path}, line {error.lineno}",
            expected="a JSON file",
            remedy="Write the file again with the command that made it.",
        ) from None


def write_yaml(path: Path, content: Any) -> None:
    """Write plain YAML atomically, keys in the order given."""
    write_text(path, yaml_text(content))


def yaml_text(content: Any, rows: bool = False) -> str:
    """Plain YAML, keys in the order given; `rows`: what holds plain values alone is one line."""
    yaml, text = YAML(typ="safe", pure=True), io.StringIO()
    # with the quotes and numbers of YAML 1.1, readers of 1.1 and 1.2 agree on every value
    yaml.version, yaml.width, yaml.default_flow_style = (1, 1), 100, None if rows else False
    yaml.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    yaml.dump(content, text)
    return text.getvalue().removeprefix("%YAML 1.1\n---\n")


def read_yaml(path: Path) -> Any:
    """Read safe YAML 1.2 (no tags that build objects).

    Raises:
        BadInput: the file is missing or is not YAML, or gives a key twice.
    """
    try:
        return copy.deepcopy(_parse(read_text(path)))
    except YAMLError as error:
        raise BadInput(
            f"not YAML ({_problem(error)})",
            where=f"{path}{_line(error)}",
            expected="a plain YAML file",
            remedy="Check the indentation and the quotes there.",
        ) from None


@lru_cache(maxsize=32)
def _parse(text: str) -> Any:
    """Content of a YAML text, not to be changed: the parser takes 0.1 s for a vehicle file."""
    return YAML(typ="safe", pure=True).load(text)


def _problem(error: YAMLError) -> str:
    return getattr(error, "problem", None) or str(error)


def _line(error: YAMLError) -> str:
    mark = getattr(error, "problem_mark", None)
    return f", line {mark.line + 1}" if mark else ""


def read_text(path: Path) -> str:
    """Read UTF-8 text (a byte-order mark is dropped).

    Raises:
        BadInput: the file is missing, a folder or not UTF-8.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        found, remedy = "no such file", "Check the path."
    except IsADirectoryError:
        found, remedy = "a folder", "Name the file inside it."
    except UnicodeDecodeError as error:
        found, remedy = f"byte {error.start} is not UTF-8", "Save the file as UTF-8 text."
    except OSError as error:
        found, remedy = f"cannot be read ({error.strerror})", "Check its permissions."
    raise BadInput(found, where=path, expected="a readable text file", remedy=remedy)


def write_arrays(path: Path, **arrays: np.ndarray) -> None:
    """Write arrays as an `.npz` whose bytes depend on the arrays alone (no time stamps)."""
    with appearing(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.asarray(array), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), buffer.getvalue())


def read_arrays(path: Path) -> dict[str, np.ndarray]:
    """Read an `.npz` written by `write_arrays`; pickled content is refused.

    Raises:
        BadInput: the file is missing, damaged or holds objects.
    """
    try:
        with zipfile.ZipFile(path) as archive:  # np.load would also take bare arrays and pickles
            names = [name.removesuffix(".npy") for name in archive.namelist()]
        with np.load(path, allow_pickle=False) as content:
            return {name: content[name] for name in names}
    except FileNotFoundError:
        found = "no such file"
    except (ValueError, OSError, EOFError, KeyError, zipfile.BadZipFile) as error:
        found = f"cannot be read ({error})"
    raise BadInput(
        found,
        where=path,
        expected="plain arrays in an .npz file",
        remedy="Write it again with the command that made it.",
    )


def plain(value: Any) -> Any:
    """Turn arrays and NumPy scalars into lists and numbers, for JSON and YAML."""
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value
