"""The docstring of a package is a map of its modules: each is on it once, and nothing else."""

import ast
import re
import runpy
import tomllib
from pathlib import Path

import pytest

import rovsim

SOURCE = Path(rovsim.__file__).parent
LINE = re.compile(r"^ *([a-z0-9_]+(?:, [a-z0-9_]+)*) {2,}\S", re.MULTILINE)
FEW = 4  # modules: who sees fewer needs no map
ALIKE = (  # found by looking into the folder: each says itself what it is
    "dynamics/effects",
    "reporting/figures",
    "apps/cli/commands",
    "application/export/targets",
    "learning/learners",
    "measurement/recording/formats",
)


def mapped(package: Path) -> list[str]:
    """Names on the map of a package."""
    source = (package / "__init__.py").read_text(encoding="utf-8")
    lines = LINE.findall(ast.get_docstring(ast.parse(source)) or "")
    return [name for line in lines for name in line.split(", ")]


def modules(package: Path) -> set[str]:
    """Modules and packages in a package."""
    files = {path.stem for path in package.glob("*.py")} - {"__init__", "__main__"}
    return files | {path.parent.name for path in package.glob("*/__init__.py")}


PACKAGES = {str(p.parent.relative_to(SOURCE)): p.parent for p in SOURCE.rglob("__init__.py")}
MAPS = {
    name: package
    for name, package in PACKAGES.items()
    if name not in ALIKE and (mapped(package) or len(modules(package)) >= FEW)
}


@pytest.mark.parametrize("package", MAPS.values(), ids=MAPS)
def test_a_map_shows_every_module(package):
    assert sorted(mapped(package)) == sorted(modules(package))


def test_the_rooms_stand_in_the_order_of_their_imports():
    settings = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))
    layers = settings["tool"]["importlinter"]["contracts"][0]["layers"]
    floors = {room: k for k, floor in enumerate(reversed(layers)) for room in floor.split(" | ")}
    heights = [floors[room] for room in mapped(SOURCE)]
    assert heights == sorted(heights)


def test_the_steps_of_a_diagnosis_are_where_its_docstring_says():
    source = (SOURCE / "diagnosis" / "train_diagnosis.py").read_text(encoding="utf-8")
    told = ast.get_docstring(ast.parse(source)) or ""
    places = re.findall(r"^[a-z ]+? {2,}([a-z_/]+) {2,}\S", told, re.MULTILINE)[1:]
    assert len(places) > 10
    assert not [place for place in places if not (SOURCE / f"{place}.py").is_file()]


def test_files_that_docs_and_docstrings_name_are_there():
    root = Path(__file__).parents[2]
    told = [*root.glob("docs/*.md"), *root.glob("*.md"), *SOURCE.rglob("*.py")]
    files = [path for top in ("src", "tests", "workflow") for path in (root / top).rglob("*.py")]
    there = [f"/{path.relative_to(root).as_posix()}" for path in files]
    named = {
        (path.relative_to(root).as_posix(), name)
        for path in told
        if path.name != "CHANGELOG.md"
        for name in re.findall(r"`([a-z_]+(?:/[a-z_]+)+\.py)`", path.read_text(encoding="utf-8"))
    }
    assert len(named) > 30
    assert not [one for one in named if not any(file.endswith(f"/{one[1]}") for file in there)]


def test_every_number_that_decides_says_what_it_is():
    page = runpy.run_path(str(Path(__file__).parents[2] / "docs" / "site" / "limits.py"))
    limits = page["find_limits"]()
    assert len(limits) > 200
    assert not [f"{one.module}: {one.name}" for one in limits if not one.meaning]
