"""Error of every model on every axis: velocity and acceleration, absolute and against nominal."""

from typing import Any, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy import ndarray as Array

from rovsim.reporting.figures.marks import (
    ACCELERATION_UNITS,
    AXES,
    VELOCITY_UNITS,
    legend,
    note,
    nothing,
    patches,
    significant,
)  # fmt: skip
from rovsim.reporting.figures.palette import Look, looks
from rovsim.reporting.figures.pooled import gaps, horizon_text, pooled, relative
from rovsim.reporting.figures.style import sheet, styled

SECTION = "compare"
CAPTION = (
    "Velocity and acceleration error per axis and model: in physical units above, "
    "divided by the nominal model's error below (1 = as good as nominal, lower is better)."
)
QUANTITIES = (
    ("velocity_rmse", "velocity RMSE", VELOCITY_UNITS),
    ("acceleration_rmse", "acceleration RMSE", ACCELERATION_UNITS),
)
TALLEST = 2.5  # times nominal; a higher bar is cut there and its value written above it


@styled()
def draw(*, comparison: Mapping[str, Any], horizon: str = "2", split: str = "test") -> Figure:
    """Draw `comparison.json` for one horizon ("2", "open_loop") and one split."""
    style = looks(comparison.get("models", {}))
    figure = sheet(205)
    rows = figure.subplots(4, 2, height_ratios=[1, 1, 1, 1])
    remarks = []
    for k, (quantity, label, units) in enumerate(QUANTITIES):
        errors = pooled(comparison, quantity, horizon, split)
        ratios = relative(errors)
        for half, axes in zip((slice(0, 3), slice(3, 6)), rows[2 * k], strict=True):
            _bars(axes, _part(errors, half), AXES[half], style)
            axes.set_ylabel(f"{label} ({units[half][0]})")
        for half, axes in zip((slice(0, 3), slice(3, 6)), rows[2 * k + 1], strict=True):
            _bars(axes, _part(ratios, half), AXES[half], style)
            _against_nominal(axes, _part(ratios, half))
        remarks.append(gaps(errors))
    figure.align_ylabels(list(rows[:, 0]))
    figure.align_ylabels(list(rows[:, 1]))
    legend(figure, patches(style))
    note(figure, [f"Runs of the {split} split, {horizon_text(horizon)}.", *dict.fromkeys(remarks)])
    return figure


def _part(errors: Mapping[str, Array], half: slice) -> dict[str, Array]:
    return {name: row[half] for name, row in errors.items()}


def _bars(
    axes: Axes, errors: Mapping[str, Array], names: Sequence[str], style: Mapping[str, Look]
) -> None:
    width = 0.8 / max(len(errors), 1)
    for k, (name, row) in enumerate(errors.items()):
        at = np.arange(len(names)) + (k + 0.5) * width - 0.4
        axes.bar(at, np.nan_to_num(row), width * 0.92, label=name, **style[name].bar())
        for x in at[~np.isfinite(row)]:
            axes.plot(x, 0.02, "x", color=style[name].color, markersize=3,
                      transform=axes.get_xaxis_transform())  # fmt: skip
    axes.set_xticks(np.arange(len(names)), names)
    axes.tick_params(axis="x", length=0)
    axes.grid(False, axis="x")
    axes.set_xlim(-0.5, len(names) - 0.5)
    axes.set_ylim(bottom=0)
    if not any(np.isfinite(row).any() for row in errors.values()):
        nothing(axes, "no values")
        axes.set_ylim(0, 1)


def _against_nominal(axes: Axes, ratios: Mapping[str, Array]) -> None:
    axes.set_ylabel("error / nominal (–)")
    axes.axhline(1.0, color="#444444", linewidth=0.8)
    shown = np.concatenate([[1.0], *ratios.values()])
    top = float(np.nanmax(shown))
    axes.set_ylim(0, min(top, TALLEST) * 1.12)
    width = 0.8 / max(len(ratios), 1)
    for k, row in enumerate(ratios.values()):
        for x in np.flatnonzero(row > TALLEST):
            place = (x + (k + 0.5) * width - 0.4, TALLEST * 1.12)
            box = {"facecolor": "white", "pad": 0.5, "lw": 0}
            text: dict[str, Any] = {
                "ha": "center",
                "va": "top",
                "fontsize": 7,
                "rotation": 90,
                "color": "black",
            }
            axes.annotate(significant(row[x]), place, bbox=box, **text)
