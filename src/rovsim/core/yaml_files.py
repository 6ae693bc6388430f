"""Read and write safe YAML 1.2: no tags that build objects, no aliases that expand without end."""

import copy
import io
from functools import lru_cache
from itertools import accumulate
from math import inf
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from rovsim.core.errors import BadInput
from rovsim.core.files import read_text, write_text

MAX_CHARACTERS = 1 << 18  # a campaign of a thousand runs has half, and is read in seconds
MAX_DEPTH = 100  # of brackets inside each other; the parser's time grows with the square
MAX_NODES = 1_000_000  # with everything written out that aliases repeat


def write_yaml(path: Path, content: Any, rows: bool = False) -> None:
    """Write plain YAML atomically, with keys in the given order; for `rows` see `yaml_text`."""
    write_text(path, yaml_text(content, rows))


def yaml_text(content: Any, rows: bool = False) -> str:
    """Write content as plain YAML, with keys in the given order.

    Args:
        content: plain values, lists and mappings.
        rows: whether lists and mappings that hold only plain values are written on one line.
    """
    yaml, text = YAML(typ="safe", pure=True), io.StringIO()
    # with the quotes and numbers of YAML 1.1, readers of 1.1 and 1.2 agree on every value
    yaml.version, yaml.width, yaml.default_flow_style = (1, 1), 100, None if rows else False
    yaml.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    yaml.dump(content, text)
    return text.getvalue().removeprefix("%YAML 1.1\n---\n")


def read_yaml(path: Path) -> Any:
    """Read safe YAML 1.2 (no tags that build objects).

    Raises:
        BadInput: the file is missing or is not YAML, gives a key twice, or is far too large.
    """
    text = read_text(path)
    if len(text) > MAX_CHARACTERS:
        raise BadInput(
            f"{len(text)} characters, and no file of this kind is that long",
            where=path,
            expected=f"a plain YAML file of at most {MAX_CHARACTERS} characters",
            remedy="Is it a recording, or another file than was meant?",
        )
    if _depth(text) > MAX_DEPTH:
        raise _refused(path, "nested too deeply")
    try:
        content = _parse(text)
    except YAMLError as error:
        raise _refused(f"{path}{_line(error)}", f"not YAML ({_problem(error)})") from None
    except RecursionError:
        raise _refused(path, "nested too deeply") from None
    except ValueError as error:  # of a number or a date
        raise _refused(path, f"not YAML ({error})") from None
    if _count(content, {}) > MAX_NODES:
        raise _refused(path, "aliases that repeat each other without end")
    return copy.deepcopy(content)


def _depth(text: str) -> int:
    """Largest number of nested brackets; those in texts and comments count, too."""
    steps = (1 if c in "[{" else -1 for c in text if c in "[]{}")
    return max(accumulate(steps), default=0)


def _refused(where: object, found: str) -> BadInput:
    remedy = "Check the indentation and the quotes there."
    return BadInput(found, where=where, expected="a plain YAML file", remedy=remedy)


@lru_cache(maxsize=32)
def _parse(text: str) -> Any:
    """Parse a YAML text; the result is cached (a vehicle takes 0.1 s) and must not be changed."""
    return YAML(typ="safe", pure=True).load(text)


def _count(node: Any, counts: dict[int, float]) -> float:
    """Number of values in a tree with its aliases expanded; infinite where it contains itself.

    Args:
        node: the tree.
        counts: numbers of inner lists and mappings by `id`, filled in here.
    """
    if not isinstance(node, (dict, list)):
        return 1
    if id(node) not in counts:
        counts[id(node)] = inf  # until it is counted: if it is met before, it contains itself
        children = node.values() if isinstance(node, dict) else node
        counts[id(node)] = 1 + sum(_count(child, counts) for child in children)
    return counts[id(node)]


def _problem(error: YAMLError) -> str:
    return getattr(error, "problem", None) or str(error)


def _line(error: YAMLError) -> str:
    mark = getattr(error, "problem_mark", None)
    return f", line {mark.line + 1}" if mark else ""
