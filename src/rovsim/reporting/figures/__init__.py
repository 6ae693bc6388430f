"""Figures of the study. A module here with a `draw` function is a figure; its name is its file's.

Every `draw` takes plain arrays and dictionaries by keyword and returns a Matplotlib `Figure`;
`rovsim.reporting.figures.style.save` writes it. `SECTION` says where the report shows it,
`CAPTION` what the reader sees, in one or two plain sentences (it is the alternative text as well).
"""

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Callable

from matplotlib.figure import Figure

from rovsim.core.errors import BadInput, nearest

SECTIONS = ("verdict", "where", "compare", "ladder", "published", "timing", "quality")


@dataclass(frozen=True)
class Kind:
    """A registered figure: `draw(...)`, the report's section and the caption."""

    name: str
    draw: Callable[..., Figure]
    section: str
    caption: str


def kinds() -> dict[str, Kind]:
    """Every figure found in this folder, by name."""
    found = {}
    for module in iter_modules([str(Path(__file__).parent)]):
        content = import_module(f"{__name__}.{module.name}")
        if hasattr(content, "draw"):
            kind = Kind(module.name, content.draw, content.SECTION, content.CAPTION)
            found[module.name] = kind
    return found


def kind(name: str) -> Kind:
    """Return the figure called `name`.

    Raises:
        BadInput: there is no such figure.
    """
    found = kinds()
    if name not in found:
        raise BadInput(
            f"there is no figure '{name}'",
            where="figures",
            expected=f"one of {', '.join(found)}",
            remedy=nearest(name, found),
        )
    return found[name]
