"""Figures of the study. A module here with a `draw` function is a figure; its name is its file's.

Every `draw` takes plain arrays and dictionaries by keyword and returns a Matplotlib `Figure`;
`rovsim.reporting.figures.style.save` writes it. `SECTION` says where the report shows it,
`CAPTION` what the reader sees, in one or two plain sentences (it is the alternative text as well).
"""

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Callable

from rovsim.core.errors import BadInput, nearest

if TYPE_CHECKING:  # a third of a second, which the workbench's first screen need not wait for
    from matplotlib.figure import Figure

SECTIONS = ("verdict", "where", "compare", "ladder", "published", "timing", "quality")


@dataclass(frozen=True)
class Kind:
    """A registered figure: `draw(...)`, the report's section and the caption."""

    name: str
    draw: "Callable[..., Figure]"
    section: str
    caption: str


def kinds() -> dict[str, Kind]:
    """Every figure found in this folder, by name."""
    found = {name: _import(name) for name in _modules()}
    return {name: kind for name, kind in found.items() if kind}


def kind(name: str) -> Kind:
    """Return the figure called `name`; no other is imported, which may take longer than to draw.

    Raises:
        BadInput: there is no such figure.
    """
    found = _import(name) if name in _modules() else None
    if found is None:
        known = kinds()
        raise BadInput(
            f"there is no figure '{name}'",
            where="figures",
            expected=f"one of {', '.join(known)}",
            remedy=nearest(name, known),
        )
    return found


def _modules() -> list[str]:
    return [module.name for module in iter_modules([str(Path(__file__).parent)])]


def _import(name: str) -> Kind | None:
    """The figure of a module; None where it only helps others to draw."""
    content = import_module(f"{__name__}.{name}")
    if not hasattr(content, "draw"):
        return None
    return Kind(name, content.draw, content.SECTION, content.CAPTION)
