"""Draw what an effect looks like to a model that lacks it: a small picture for the catalogue.

Not a figure of the study, so there is no `draw` here.
"""

import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy import ndarray as Array
from PIL import Image

from rovsim.core.axes import ACCELERATION_UNITS, AXES
from rovsim.core.files import write_bytes
from rovsim.dynamics.effects.base import Signature
from rovsim.evaluation.error_conditions.bins import BinnedErrors
from rovsim.reporting.figures.palette import FAMILIES, Style
from rovsim.reporting.figures.style import MM, WIDTH_MM, styled

HEIGHT_MM = 56.0
WIDTH_PIXELS = 700
PNG_COLORS = 64  # in the file: black, orange and greys
EXCERPT_S = 20.0
MISSED_LABEL, EFFECT_LABEL = "what the model misses", "what the effect adds to the model"
BLACK, ORANGE = FAMILIES["measured"].color, FAMILIES["nominal"].color
EFFECT_LINE: Style = {"color": ORANGE, "linewidth": 1.8}


@dataclass(frozen=True, eq=False)
class Seen:
    """An axis' acceleration error over a condition and over time, in n blocks of half a second.

    Attributes:
        signature: axis and condition that show the effect best.
        missed: error of the nominal model, in bins of the condition.
        effect: acceleration that the true effect adds to the model, in the same bins.
        condition: its value in each block (n,).
        time: of the blocks (n,), s.
        error: of the nominal model in each block (n,), m/s2 or rad/s2.
        added: by the true effect in each block (n,), m/s2 or rad/s2.
    """

    signature: Signature
    missed: BinnedErrors
    effect: BinnedErrors
    condition: Array
    time: Array
    error: Array
    added: Array


@styled()
def draw_signature(seen: Seen) -> Figure:
    """Draw the error over the condition on the left, over time on the right."""
    figure = Figure(figsize=(WIDTH_MM * MM, HEIGHT_MM * MM), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(0.85, 1.0), sharey=not seen.signature.size)
    _draw_bins(left, seen)
    _draw_trace(right, seen)
    figure.legend(
        handles=[
            Line2D([], [], color=BLACK, marker="o", markersize=4, label=MISSED_LABEL),
            Line2D([], [], label=EFFECT_LABEL, **EFFECT_LINE),
        ],
        loc="outside upper center",
        ncols=2,
        borderaxespad=0.1,
    )
    return figure


def write(figure: Figure, path: Path) -> None:
    """Write a figure as a PNG of few colours; the same figure gives the same bytes."""
    buffer = io.BytesIO()
    with styled():
        figure.savefig(
            buffer, format="png", dpi=WIDTH_PIXELS / (WIDTH_MM * MM), metadata={"Software": None}
        )
    small = Image.open(buffer).convert("RGB").quantize(PNG_COLORS)
    compressed = io.BytesIO()
    small.save(compressed, format="PNG", optimize=True)
    write_bytes(path, compressed.getvalue())


def _draw_bins(axes: Axes, seen: Seen) -> None:
    """Draw the means (or RMS) of bins, with those of the effect; dots are single blocks."""
    size, binning = seen.signature.size, seen.missed.binning
    convert = np.degrees if binning.condition.unit == "rad" else np.asarray
    dots = np.abs(seen.error) if size else seen.error
    axes.axhline(0.0, color="#444444", linewidth=0.6)
    axes.plot(convert(seen.condition), dots, ".", color="#bbbbbb", markersize=3, zorder=1.5)
    x, filled = convert(binning.center), binning.count > 0
    y, added = _height(seen.missed, size), _height(seen.effect, size)
    error = None if size else 2 * seen.missed.error[filled]
    axes.errorbar(x[filled], y[filled], yerr=error, fmt="o", color=BLACK, markersize=4, zorder=3)
    axes.plot(x[filled], added[filled], zorder=2.5, **EFFECT_LINE)
    unit = "deg" if binning.condition.unit == "rad" else binning.condition.unit
    axes.set_xlabel(f"{binning.condition.name} ({unit})")
    axis = seen.signature.axis
    quantity = f"size of {axis} error" if size else f"{axis} error"
    axes.set_ylabel(f"{quantity} ({ACCELERATION_UNITS[AXES.index(axis)]})")


def _height(table: BinnedErrors, size: bool) -> Array:
    return table.rms if size else table.mean


def _draw_trace(axes: Axes, seen: Seen) -> None:
    """Draw error and effect over time: an excerpt with most motion, or the whole run.

    The whole run is drawn where time itself is the condition.
    """
    whole = seen.signature.condition == "time in the run"
    part = slice(None) if whole else liveliest(seen.time, seen.added, EXCERPT_S)
    axes.axhline(0.0, color="#444444", linewidth=0.6)
    axes.plot(seen.time[part], seen.added[part], zorder=2, **EFFECT_LINE)
    axes.plot(
        seen.time[part],
        seen.error[part],
        color=BLACK,
        linewidth=0.7,
        marker=".",
        markersize=3,
        zorder=3,
    )
    axes.set_xlabel("time in the run (s)")
    axes.margins(x=0.01)


def liveliest(time: Array, values: Array, length: float) -> slice:
    """Return the excerpt of `length` s with the largest absolute values; all of a shorter run."""
    count = int(np.searchsorted(time - time[0], length))
    if count >= len(time):
        return slice(None)
    spread = [np.sum(np.abs(values[k : k + count])) for k in range(len(time) - count + 1)]
    first = int(np.argmax(spread))
    return slice(first, first + count)
