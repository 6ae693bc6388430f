"""Draw the ladder: the error on the test runs, step by step."""

from typing import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rovsim.core.model_names import NOISE_FLOOR
from rovsim.reporting.charts import LadderBar, chart_ladder, tell_beyond
from rovsim.reporting.figures.legends import add_legend, explain_empty, note
from rovsim.reporting.figures.palette import FAMILIES
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import ERROR_NAME, LADDER_NOTE, LADDER_STEP, significant
from rovsim.results.ladder import Ladder

SECTION = "ladder"
CAPTION = (
    "The 2 s error of each model on runs none of them was fitted to. Lower is better. Colours are "
    "those of kinds of models: nominal, effects, each kind of residual."
)


@styled()
def draw(*, ladder: Ladder) -> Figure:
    """Draw `windows_2s` of `ladder.json` from the first step down, the noise floor as a line."""
    chart = chart_ladder(ladder)
    bars, floor = chart.bars, chart.noise_floor
    figure = sheet(26 + 7.5 * max(len(bars), 3))
    axes = figure.subplots()
    for row, bar in enumerate(bars):
        y = len(bars) - 1 - row
        axes.barh(y, np.nan_to_num(bar.value), 0.66, **bar.look.bar())
        _write_value(axes, y, bar.value, chart.end)
    axes.set_yticks(range(len(bars)), [bar.label for bar in reversed(bars)])
    axes.set_ylim(-0.6, max(len(bars), 1) - 0.4)
    axes.set_xlim(0, chart.end)
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    axes.set_xlabel(f"{ERROR_NAME} (velocity RMSE / standard deviation)")
    if not bars:
        explain_empty(axes, "no steps")
    if np.isfinite(floor):
        look = FAMILIES[NOISE_FLOOR]
        axes.axvline(floor, **look.line())
        label = f"noise floor, {significant(floor)}"
        add_legend(figure, [Line2D([], [], label=label, **look.line())])
    note(figure, _remarks(ladder, chart.beyond))
    return figure


def _write_value(axes: Axes, y: int, value: float, top: float) -> None:
    """Write the number of one step behind its bar, or on a bar that is cut."""
    beyond = value > top
    text = significant(value) if np.isfinite(value) else "no value"
    place = (top, y) if beyond else (float(np.nan_to_num(value)), y)
    axes.annotate(
        f"{text} →" if beyond else text,
        place,
        xytext=(-4 if beyond else 3, 0),
        va="center",
        ha="right" if beyond else "left",
        textcoords="offset points",
        fontsize=8,
        bbox={"facecolor": "white", "pad": 1, "linewidth": 0},
    )


def _remarks(ladder: Ladder, beyond: Sequence[LadderBar]) -> list[str]:
    splits = sorted({step.split for step in ladder.steps})
    return [
        f"Runs of the {' and '.join(splits)} split." if splits else "",
        LADDER_NOTE if any(LADDER_STEP.fullmatch(step.model) for step in ladder.steps) else "",
        tell_beyond(beyond),
    ]
