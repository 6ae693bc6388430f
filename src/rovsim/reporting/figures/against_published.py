"""Draw our error on each held-out run and axis, divided by the smallest published one."""

from typing import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rovsim.core.model_names import EFFECTS
from rovsim.evaluation.held_out.published_errors import JUDGED_METRICS, PUBLISHED_PREFIX
from rovsim.reporting.figures.legends import add_legend, explain_empty, note
from rovsim.reporting.figures.palette import Look, Style, looks
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import short, title
from rovsim.results.base import or_nan
from rovsim.results.published_errors import PublishedCell, PublishedErrors

SECTION = "published"
CAPTION = (
    "Error on each held-out run and axis divided by its mark, the smallest error that anybody "
    "published for it (1 = as good as the best of them, lower is better). In parentheses: axes "
    "whose demand never moved. Models of every fold, residuals on top of effects only; the table "
    "has all."
)
METRIC_LABELS = {"acceleration_rmse": "acceleration RMSE", "velocity_mae": "velocity MAE"}
MARKERS = "osD^vP*hX<>"
MIN_RATIO, MAX_RATIO = 0.25, 4.0  # a ratio beyond is drawn on the upper edge
RATIO_TICKS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0)


@styled()
def draw(*, published_errors: PublishedErrors) -> Figure:
    """Draw the ratios of `published_errors.json`, a panel for each metric."""
    names = _list_shown_models(published_errors)
    style = looks(names)
    figure = sheet(60 + 60 * len(JUDGED_METRICS))
    for axes, metric in zip(figure.subplots(len(JUDGED_METRICS), 1), JUDGED_METRICS, strict=True):
        cells = [cell for cell in published_errors.cells if cell.metric == metric]
        _draw_panel(axes, cells, style)
        axes.set_ylabel(f"{METRIC_LABELS[metric]} / mark (–)")
    add_legend(
        figure, [Line2D([], [], label=title(n), **_look(k, style[n])) for k, n in enumerate(names)]
    )
    beyond = any(_ratio(c, n) > MAX_RATIO for c in published_errors.cells for n in names)
    note(figure, [f"On the upper edge: {MAX_RATIO:g} or more, or no value." if beyond else ""])
    return figure


def _list_shown_models(published_errors: PublishedErrors) -> list[str]:
    """List our models that have a ratio in every cell.

    A residual on top of the nominal model is left out if there is one on top of effects.
    """
    own_models = [n for n in published_errors.models if not n.startswith(PUBLISHED_PREFIX)]
    complete = [n for n in own_models if all(n in cell.ratios for cell in published_errors.cells)]
    stacked = {n.partition("+")[2] for n in complete if n.startswith(f"{EFFECTS}+")}
    return [n for n in complete if n not in stacked]


def _draw_panel(axes: Axes, cells: Sequence[PublishedCell], style: Mapping[str, Look]) -> None:
    if not cells:
        explain_empty(axes, "nothing to compare with")
        return
    runs = list(dict.fromkeys(cell.run for cell in cells))
    places = np.array([k + runs.index(cell.run) for k, cell in enumerate(cells)])
    ratios = np.array([[_ratio(cell, name) for name in style] for cell in cells])
    for k, name in enumerate(style):
        axes.plot(places, np.minimum(ratios[:, k], MAX_RATIO), **_look(k, style[name]))
    axes.axhline(1.0, color="#444444", linewidth=0.8)
    _set_vertical(axes, float(np.nanmin(ratios, initial=MIN_RATIO)))
    axes.set_xticks(places, [_label(cell) for cell in cells], rotation=90)
    axes.tick_params(axis="x", length=0)
    for run in runs:
        middle = np.mean([x for x, c in zip(places, cells, strict=True) if c.run == run])
        axes.text(
            middle,
            1.01,
            f"run {short(run, 14)}",
            ha="center",
            va="bottom",
            fontsize=8,
            transform=axes.get_xaxis_transform(),
        )


def _set_vertical(axes: Axes, lowest: float) -> None:
    axes.set_yscale("log")
    axes.set_ylim(0.9 * max(lowest, 0.01), 1.1 * MAX_RATIO)
    axes.set_yticks(RATIO_TICKS, [f"{tick:g}" for tick in RATIO_TICKS])
    axes.set_yticks([], minor=True)
    axes.set_ylim(0.9 * max(lowest, 0.01), 1.1 * MAX_RATIO)


def _ratio(cell: PublishedCell, name: str) -> float:
    """Return a model's ratio; infinite where it has no value, NaN where the cell has no model."""
    if name not in cell.ratios:
        return float("nan")
    value = or_nan(cell.ratios[name])
    return value if np.isfinite(value) else float("inf")


def _label(cell: PublishedCell) -> str:
    return cell.axis if cell.demanded else f"({cell.axis})"


def _look(k: int, look: Look) -> Style:
    """Return the style of model number k, with a marker of its own."""
    return {
        "color": look.color,
        "marker": MARKERS[k % len(MARKERS)],
        "linestyle": "",
        "markersize": 3.6,
        "markeredgewidth": 0.3,
        "markeredgecolor": "white",
    }
