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
from typing import TYPE_CHECKING, Any, Callable, Iterable, Mapping

from rovsim.core.errors import BadInput, unlisted
from rovsim.core.files import read_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

REMEDY = "The docstring of rovsim.reporting.figures says what a figure declares."
DRAW_SIGNATURE = "def draw(*, …)"
SECTIONS = ("verdict", "where", "compare", "ladder", "published", "timing", "quality")


@dataclass(frozen=True)
class FigureKind:
    """A figure, as its module declares it.

    Attributes:
        name: of the module.
        section: of the report that shows it.
        caption: in one or two sentences.
        place: within the section.
        takes: parameters of its `draw`.
        needs: those of them without a default.
    """

    name: str
    section: str
    caption: str
    place: int
    takes: tuple[str, ...]
    needs: tuple[str, ...]

    @cached_property
    def draw(self) -> "Callable[..., Figure]":
        """The function that draws the figure; only its own module is imported."""
        return import_module(f"{__name__}.{self.name}").draw


@cache
def list_figures() -> dict[str, FigureKind]:
    """Return every figure in this folder by name, in the order of the report.

    Raises:
        BadInput: one of them does not declare what a figure has to.
    """
    figures = [kind for path in Path(__file__).parent.glob("*.py") if (kind := read_kind(path))]
    figures.sort(key=lambda figure: (SECTIONS.index(figure.section), figure.place, figure.name))
    return {figure.name: figure for figure in figures}


def find_figure(name: str) -> FigureKind:
    """Return the figure called `name`.

    Raises:
        BadInput: there is no such figure.
    """
    figures = list_figures()
    if name not in figures:
        raise unlisted(name, figures, found=f"there is no figure '{name}'", where="figures")
    return figures[name]


def read_kind(path: Path) -> FigureKind | None:
    """Read the figure that a module declares; None where it only helps others to draw.

    Raises:
        BadInput: it does not declare what a figure has to.
    """
    draw, consts = None, dict[str, Any](PLACE=1)
    for node in _parse(path).body:
        match node:
            case ast.FunctionDef(name="draw"):
                draw = node.args
            case (
                ast.Assign(targets=[ast.Name(id="SECTION" | "CAPTION" | "PLACE" as name)])
                | ast.AnnAssign(target=ast.Name(id="SECTION" | "CAPTION" | "PLACE" as name))
            ):
                consts[name] = _constant(node.value, path, name)
    if draw is None and len(consts) > 1:
        raise _refused(
            path, f"{' and '.join(sorted({*consts} - {'PLACE'}))} without a 'draw'", DRAW_SIGNATURE
        )
    if draw is None:
        return None
    _check(path, consts, draw)
    takes = {a.arg: default for a, default in zip(draw.kwonlyargs, draw.kw_defaults, strict=True)}
    return FigureKind(
        path.stem,
        consts["SECTION"],
        consts["CAPTION"],
        consts["PLACE"],
        tuple(takes),
        tuple(name for name, default in takes.items() if default is None),
    )


def _parse(path: Path) -> ast.Module:
    try:
        return ast.parse(read_text(path))
    except SyntaxError as error:
        raise _refused(path, f"line {error.lineno}: {error.msg}", "valid Python") from None


def _constant(node: ast.expr | None, path: Path, name: str) -> Any:
    """Return the value of a declaration, without running the module."""
    try:
        return ast.literal_eval(node or "")
    except (ValueError, SyntaxError):
        raise _refused(path, f"{name} is no plain constant", "a text or number as it is") from None


def _check(path: Path, constants: Mapping[str, Any], takes: ast.arguments) -> None:
    """Refuse a figure that does not declare section, caption and parameters as it should."""
    if constants.get("SECTION") not in SECTIONS:
        problem = (
            f"SECTION is {constants['SECTION']!r}"
            if "SECTION" in constants
            else "there is no SECTION"
        )
        raise _refused(path, problem, f"one of {', '.join(SECTIONS)}")
    if not (isinstance(constants.get("CAPTION"), str) and constants["CAPTION"]):
        raise _refused(path, "there is no CAPTION", "one or two sentences")
    if not isinstance(constants["PLACE"], (int, float)):
        raise _refused(path, f"PLACE is {constants['PLACE']!r}", "a number")
    if takes.args or takes.posonlyargs:
        raise _refused(path, "'draw' takes what it asks for by place", DRAW_SIGNATURE)


def refuse_unknown(figure: FigureKind, known_names: Iterable[str]) -> None:
    """Refuse a figure that needs something other than `known_names`.

    Raises:
        BadInput: it does.
    """
    if unknown := [name for name in figure.needs if name not in (known_names := set(known_names))]:
        path = Path(__file__).with_name(f"{figure.name}.py")
        problem = f"'draw' asks for {', '.join(unknown)}"
        raise _refused(path, problem, f"some of {', '.join(sorted(known_names))}")


def _refused(path: Path, problem: str, expected: str) -> BadInput:
    return BadInput(problem, where=path, expected=expected, remedy=REMEDY)
