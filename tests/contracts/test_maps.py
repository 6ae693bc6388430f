"""Where the docstring of a package is a map of its modules, each is on it, and nothing else."""

import ast
import re
from pathlib import Path

import pytest

import rovsim

SOURCE = Path(rovsim.__file__).parent
LINE = re.compile(r"^ *([a-z_]+(?:, [a-z_]+)*) {2,}\S", re.MULTILINE)
FEWEST = 3  # lines: fewer are no map


def mapped(package: Path) -> list[str]:
    """Names on the map of a package; empty if it has none, or says that more is alike (…)."""
    text = ast.get_docstring(ast.parse(package.read_text(encoding="utf-8"))) or ""
    lines = LINE.findall(text)
    if len(lines) < FEWEST or "…" in text:
        return []
    return [name for line in lines for name in line.split(", ")]


MAPS = {path.parent: names for path in SOURCE.rglob("__init__.py") if (names := mapped(path))}


def test_there_are_maps():
    assert len(MAPS) > 5


@pytest.mark.parametrize("package", MAPS, ids=lambda path: str(path.relative_to(SOURCE)))
def test_a_map_shows_every_module(package):
    modules = {path.stem for path in package.glob("*.py")} - {"__init__"}
    folders = {path.parent.name for path in package.glob("*/__init__.py")}
    assert sorted(MAPS[package]) == sorted(modules | folders)
