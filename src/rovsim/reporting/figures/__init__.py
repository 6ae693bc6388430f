"""Figures of the study. A module here with a `draw` function is a figure; its name is its file's.

`draw` takes what it asks for by the names of its parameters, all by keyword: what `ReportData`
holds, for a figure of the study, or what `RunData` tells, for one of each run. It returns a
Matplotlib `Figure`; `rovsim.reporting.figures.style.save` writes it. Beside it stand, as plain
constants,

SECTION   where the report shows it
CAPTION   what the reader sees, in one or two plain sentences (it is the alternative text as well)
PLACE     within the section, from 1, which it is unless given; at one place, by name

These are read, not imported: Matplotlib takes a third of a second, which neither a list of rules
nor the workbench's first screen need wait for.
"""

import ast
from dataclasses import dataclass
from functools import cache, cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable

from rovsim.core.errors import unlisted

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SECTIONS = ("verdict", "where", "compare", "ladder", "published", "timing", "quality")


@dataclass(frozen=True)
class Kind:
    """A figure: what its module declares, and what its `draw` takes and cannot do without."""

    name: str
    section: str
    caption: str
    place: int
    takes: tuple[str, ...]
    needs: tuple[str, ...]

    @cached_property
    def draw(self) -> "Callable[..., Figure]":
        """The function that draws it; only its own module is imported."""
        return import_module(f"{__name__}.{self.name}").draw


@cache
def kinds() -> dict[str, Kind]:
    """Every figure found in this folder, by name, in the order of the report."""
    found = [kind for path in Path(__file__).parent.glob("*.py") if (kind := _read(path))]
    found.sort(key=lambda one: (SECTIONS.index(one.section), one.place, one.name))
    return {one.name: one for one in found}


def kind(name: str) -> Kind:
    """Return the figure called `name`.

    Raises:
        BadInput: there is no such figure.
    """
    known = kinds()
    if name not in known:
        raise unlisted(name, known, found=f"there is no figure '{name}'", where="figures")
    return known[name]


def _read(path: Path) -> Kind | None:
    """The figure of a module; None where it only helps others to draw."""
    draw, told = None, dict[str, Any](PLACE=1)
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        match node:
            case ast.FunctionDef(name="draw"):
                draw = node.args
            case ast.Assign(targets=[ast.Name(id="SECTION" | "CAPTION" | "PLACE" as name)]):
                told[name] = ast.literal_eval(node.value)
    if draw is None:
        return None
    takes = {one.arg: given for one, given in zip(draw.kwonlyargs, draw.kw_defaults, strict=True)}
    return Kind(
        path.stem,
        told["SECTION"],
        told["CAPTION"],
        told["PLACE"],
        tuple(takes),
        tuple(name for name, given in takes.items() if given is None),
    )
