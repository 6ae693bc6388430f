"""Draw the velocity and acceleration errors of all models by axis, also divided by nominal."""

from typing import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from pandas import DataFrame

from rovsim.core.axes import ACCELERATION_UNITS, AXES, VELOCITY_UNITS
from rovsim.core.horizons import STANDARD_HORIZON
from rovsim.reporting.figures.legends import add_legend, explain_empty, note, patches
from rovsim.reporting.figures.palette import Look, Style, looks
from rovsim.reporting.figures.pooled import (
    between_runs,
    name_gaps,
    name_horizon,
    pool,
    relate,
)
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import significant
from rovsim.results.comparison import Comparison

SECTION = "compare"
CAPTION = (
    "Velocity and acceleration error per axis and model, in physical units; where there are "
    "several models also, below, divided by the nominal model's error (1 = as good as nominal, "
    "lower is better). Thin lines reach from the lowest to the highest run."
)
PLOTTED_QUANTITIES = (
    ("velocity_rmse", "velocity RMSE", VELOCITY_UNITS),
    ("acceleration_rmse", "acceleration RMSE", ACCELERATION_UNITS),
)
AXIS_HALVES = (slice(0, 3), slice(3, 6))
HEADROOM_RATIO = 1.06  # above the highest whisker
MAX_BAR_RATIO = 2.5  # times nominal; a higher bar is cut there and its value written above it


@styled()
def draw(*, comparison: Comparison, horizon: str = STANDARD_HORIZON, split: str = "test") -> Figure:
    """Draw `comparison.json` for one horizon ("2", "open_loop") and one split."""
    style = looks(comparison.models)
    several = len(comparison.models) > 1  # one alone is always as good as itself
    step = 2 if several else 1
    figure = sheet(105 * step)
    rows = figure.subplots(2 * step, 2)
    remarks = []
    for k, (quantity, label, units) in enumerate(PLOTTED_QUANTITIES):
        errors = pool(comparison, quantity, horizon, split)
        ratios, ends = relate(errors), between_runs(comparison, quantity, horizon, split)
        for half, axes in zip(AXIS_HALVES, rows[step * k], strict=True):
            _draw_bars(axes, errors[list(AXES[half])], style)
            _draw_whiskers(axes, *(end[list(AXES[half])] for end in ends))
            axes.set_ylabel(f"{label} ({units[half][0]})")
        for half, axes in zip(AXIS_HALVES, rows[step * k + 1], strict=True) if several else ():
            _draw_bars(axes, ratios[list(AXES[half])], style)
            _compare_with_nominal(axes, ratios[list(AXES[half])])
        remarks.append(name_gaps(errors))
    figure.align_ylabels(list(rows[:, 0]))
    figure.align_ylabels(list(rows[:, 1]))
    add_legend(figure, patches(style))
    note(figure, [f"Runs of the {split} split, {name_horizon(horizon)}.", *dict.fromkeys(remarks)])
    return figure


def _draw_bars(axes: Axes, errors: DataFrame, style: Mapping[str, Look]) -> None:
    names = list(errors.columns)
    width = 0.8 / max(len(errors), 1)
    for k, (name, row) in enumerate(zip(errors.index, errors.to_numpy(), strict=True)):
        places = np.arange(len(names)) + (k + 0.5) * width - 0.4
        axes.bar(places, np.nan_to_num(row), width * 0.92, label=name, **style[name].bar())
        for x in places[~np.isfinite(row)]:
            axes.plot(
                x,
                0.02,
                "x",
                color=style[name].color,
                markersize=3,
                transform=axes.get_xaxis_transform(),
            )
    axes.set_xticks(np.arange(len(names)), names)
    axes.tick_params(axis="x", length=0)
    axes.grid(False, axis="x")
    axes.set_xlim(-0.5, len(names) - 0.5)
    axes.set_ylim(bottom=0)  # as high as the bars
    if errors.isna().all(axis=None):
        explain_empty(axes, "no values")
        axes.set_ylim(0, 1)


def _draw_whiskers(axes: Axes, low: DataFrame, high: DataFrame) -> None:
    """Draw lines from the lowest to the highest run over the bars."""
    width = 0.8 / max(len(low), 1)
    for k, (least, most) in enumerate(zip(low.to_numpy(), high.to_numpy(), strict=True)):
        places = np.arange(len(least)) + (k + 0.5) * width - 0.4
        axes.vlines(places, least, most, color="#222222", linewidth=0.8)
    highest = float(np.nan_to_num(high.to_numpy()).max(initial=0.0))
    axes.set_ylim(0, max(axes.get_ylim()[1], HEADROOM_RATIO * highest))


def _compare_with_nominal(axes: Axes, ratios: DataFrame) -> None:
    axes.set_ylabel("error / nominal (–)")
    axes.axhline(1.0, color="#444444", linewidth=0.8)
    top = float(np.nanmax(ratios.to_numpy(), initial=1.0))
    axes.set_ylim(0, min(top, MAX_BAR_RATIO) * 1.12)
    width = 0.8 / max(len(ratios), 1)
    for k, row in enumerate(ratios.to_numpy()):
        for x in np.flatnonzero(row > MAX_BAR_RATIO):
            place = (x + (k + 0.5) * width - 0.4, MAX_BAR_RATIO * 1.12)
            box = {"facecolor": "white", "pad": 0.5, "lw": 0}
            text: Style = {
                "ha": "center",
                "va": "top",
                "fontsize": 7,
                "rotation": 90,
                "color": "black",
            }
            axes.annotate(significant(row[x]), place, bbox=box, **text)
