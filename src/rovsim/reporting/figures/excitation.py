"""Draw the quality of all runs: which axes were excited, and when the vehicle was seen."""

from typing import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rovsim.core.axes import AXES
from rovsim.reporting.figures.legends import add_legend, explain_empty, note
from rovsim.reporting.figures.palette import VERMILION, Style
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import short, significant
from rovsim.results.quality import Excitation, Quality

SECTION = "quality"
CAPTION = (
    "Per run: standard deviation of the body velocity on each axis (an axis that hardly moved "
    "cannot be judged), and the stretches in which the motion capture lost the vehicle. An empty "
    "stretch was left out of the campaign."
)
MAX_RUNS = 40  # what fits on a page
EXCITED_COLOR, STILL_COLOR, SEEN_COLOR, GAP_COLOR = "#A6CEE8", "#FFFFFF", "#CCCCCC", VERMILION


@styled()
def draw(*, quality: Mapping[str, Quality]) -> Figure:
    """Draw the quality reports, by run."""
    runs, remarks = _choose(quality), []
    figure = sheet(34 + 7 * max(len(runs), 2))
    cells, timeline = figure.subplots(1, 2, width_ratios=[3, 2])
    if len(runs) < len(quality):
        remarks.append(f"The {len(runs)} runs of {len(quality)} with most that was not seen.")
    for row, run in enumerate(runs):
        y = len(runs) - 1 - row
        _draw_excitation(cells, y, quality[run].excitation)
        _draw_seen(timeline, y, quality[run])
        if quality[run].unusable:
            remarks.append(f"{short(run)} is not used: {quality[run].unusable}.")
    for axes in (cells, timeline):
        axes.set_ylim(-0.5, max(len(runs), 1) - 0.5)
        axes.grid(False)
        axes.tick_params(length=0)
    cells.set_xlim(-0.5, 5.5)
    cells.set_xticks(range(6), AXES)
    cells.set_yticks(range(len(runs)), [short(run, 20) for run in reversed(runs)])
    cells.set_title("velocity std (m/s, rad/s)")
    timeline.set_yticks([])
    timeline.set_xlim(left=0)
    timeline.set_xlabel("time (s)")
    timeline.set_title("seen by the motion capture")
    if not runs:
        explain_empty(cells, "no runs")
    labels = (
        (EXCITED_COLOR, "excited"),
        (STILL_COLOR, "not excited"),
        (SEEN_COLOR, "seen"),
        (GAP_COLOR, "gap"),
    )
    edge: Style = {"edgecolor": "#888888", "linewidth": 0.5}
    add_legend(figure, [Patch(facecolor=color, label=label, **edge) for color, label in labels])
    note(figure, remarks)
    return figure


def _choose(quality: Mapping[str, Quality]) -> list[str]:
    """Choose the runs that fit on a page: all, or those with most missing frames."""
    runs = list(quality)
    lacking = [-q.not_found / q.frames - (q.unusable is not None) for q in quality.values()]
    return [runs[k] for k in sorted(np.argsort(lacking, kind="stable")[:MAX_RUNS].tolist())]


def _draw_excitation(axes: Axes, y: float, excitation: Mapping[str, Excitation]) -> None:
    """Draw a cell for each axis of a run, with a dash where nothing was measured."""
    for k, axis in enumerate(AXES):
        entry = excitation.get(axis)
        color = EXCITED_COLOR if entry and entry.excited else STILL_COLOR
        axes.bar(k, 0.84, 0.94, y - 0.42, facecolor=color, edgecolor="#BBBBBB", linewidth=0.5)
        text = significant(entry.std, 2) if entry else "–"
        axes.text(k, y, text, ha="center", va="center", fontsize=8)


def _draw_seen(axes: Axes, y: float, report: Quality) -> None:
    whole = ((0.0, report.duration_s),)
    used = [(begin, end - begin) for begin, end in report.used or whole]
    axes.barh(y, report.duration_s, 0.5, facecolor=STILL_COLOR, edgecolor=SEEN_COLOR, linewidth=0.5)
    axes.broken_barh(used, (y - 0.25, 0.5), facecolor=SEEN_COLOR)
    spans = [(gap.start_s, gap.duration_s) for gap in report.gaps]
    # a gap narrower than a hair would vanish on paper: the edge keeps it visible
    axes.broken_barh(
        spans, (y - 0.25, 0.5), facecolor=GAP_COLOR, edgecolor=GAP_COLOR, linewidth=0.4
    )
