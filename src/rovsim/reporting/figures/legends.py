"""Place legends and notes so that they never cover what is plotted."""

import math
import textwrap
from typing import Any, Iterable, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter

from rovsim.reporting.figures.palette import Look
from rovsim.reporting.figures.style import FONT_SIZE_PT, MM, WIDTH_MM
from rovsim.reporting.wording import title

EM_INCHES = FONT_SIZE_PT / 72


def lines(looks: dict[str, Look]) -> list[Artist]:
    """Return legend entries for lines."""
    return [Line2D([], [], label=title(n), **look.line()) for n, look in looks.items()]


def patches(looks: dict[str, Look]) -> list[Artist]:
    """Return legend entries for bars."""
    return [Patch(label=title(n), **look.bar()) for n, look in looks.items()]


def areas(looks: dict[str, Look]) -> list[Artist]:
    """Return legend entries for areas behind lines."""
    return [Patch(label=name, **look.area()) for name, look in looks.items()]


def add_legend(figure: Figure, handles: Sequence[Any]) -> None:
    """Put a legend above all axes, in as few rows as fit the page."""
    if not handles:
        return
    lengths = [len(str(handle.get_label())) for handle in handles]
    rows = next(r for r in range(1, len(handles) + 1) if _width(lengths, r) < 0.96 * WIDTH_MM * MM)
    figure.legend(
        handles=list(handles),
        loc="outside upper center",
        ncols=math.ceil(len(handles) / rows),
        handlelength=2.6,
        columnspacing=1.4,
        borderaxespad=0.2,
    )


def _width(lengths: Sequence[int], rows: int) -> float:
    """Estimate the width in inches of a legend: a letter is half an em wide, a handle 4.8 em.

    Args:
        lengths: number of letters of each entry.
        rows: of the legend.
    """
    columns = math.ceil(len(lengths) / rows)
    # matplotlib fills column by column, the first ones one entry longer than the last
    full, longer = divmod(len(lengths), columns)
    ends = np.cumsum([full + (k < longer) for k in range(columns)])
    widest = [max(part) for part in np.split(np.asarray(lengths), ends[:-1])]
    return EM_INCHES * sum(0.5 * length + 4.8 for length in widest) if rows < len(lengths) else 0.0


def note(figure: Figure, remarks: Iterable[str]) -> None:
    """Write remarks under the figure, each a sentence of its own."""
    text = " ".join(r for r in remarks if r)
    if text:
        wrapped = "\n".join(textwrap.wrap(text, int(WIDTH_MM * MM / EM_INCHES / 0.47)))
        figure.supxlabel(wrapped, fontsize=FONT_SIZE_PT - 1, color="#444444")


def explain_empty(axes: Axes, text: str) -> None:
    """Say in an empty panel why it is empty."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color="#666666")


def set_log_scale(axes: Axes, names: str = "x") -> None:
    """Make axes (x, y or xy) logarithmic and label them with plain numbers: 0.1, 1, 10."""
    axes.set(**{f"{name}scale": "log" for name in names})
    for name in names:
        axis = axes.xaxis if name == "x" else axes.yaxis
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(FuncFormatter(lambda *_: ""))
