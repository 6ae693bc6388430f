"""The ladder: the error on held-out runs falling, step by step."""

from typing import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rovsim.reporting.charts import chart_ladder
from rovsim.reporting.figures.legends import legend, note, nothing
from rovsim.reporting.figures.palette import FAMILIES
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import ERROR, LADDER, STEP, significant, title
from rovsim.results.ladder import NOISE_FLOOR, Ladder

SECTION = "ladder"
CAPTION = (
    "The 2 s error of each model on runs none of them was fitted to. Lower is better. Colours are "
    "those of kinds of models: nominal, effects, each kind of residual."
)
ROOM = 1.14  # for the values behind the bars
BASELINE = "zero_acceleration"
FAR = 2.0  # times the highest model: a baseline beyond is cut, so that the models can be told apart


@styled()
def draw(*, ladder: Ladder) -> Figure:
    """Draw `windows_2s` of `ladder.json` from the first step down, the noise floor as a line."""
    chart = chart_ladder(ladder)
    steps, floor = {bar.model: bar.value for bar in chart.bars}, chart.noise_floor
    figure = sheet(26 + 7.5 * max(len(steps), 3))
    axes = figure.subplots()
    top = _top(steps, floor)
    for row, bar in enumerate(chart.bars):
        y = len(steps) - 1 - row
        axes.barh(y, np.nan_to_num(bar.value), 0.66, **bar.look.bar())
        _value(axes, y, bar.value, top)
    axes.set_yticks(range(len(steps)), [bar.label for bar in reversed(chart.bars)])
    axes.set_ylim(-0.6, max(len(steps), 1) - 0.4)
    axes.set_xlim(0, top)
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    axes.set_xlabel(f"{ERROR} (velocity RMSE / standard deviation)")
    if not steps:
        nothing(axes, "no steps")
    if np.isfinite(floor):
        look = FAMILIES[NOISE_FLOOR]
        axes.axvline(floor, **look.line())
        label = f"noise floor, {significant(floor)}"
        legend(figure, [Line2D([], [], label=label, **look.line())])
    note(figure, _remarks(ladder, steps, top))
    return figure


def _top(steps: Mapping[str, float], floor: float) -> float:
    """Where the axis ends; a baseline that is far higher than all models is cut."""
    known = {n: v for n, v in {**steps, NOISE_FLOOR: floor}.items() if np.isfinite(v)}
    models = max((v for n, v in known.items() if n != BASELINE), default=0.0)
    cut = 0.0 < FAR * models < known.get(BASELINE, 0.0)
    return ROOM * (models if cut else max(known.values(), default=0.0)) or 1.0


def _value(axes: Axes, y: int, value: float, top: float) -> None:
    """The number of one step, behind its bar, or on it where the bar leaves the axes."""
    beyond = value > top
    text = significant(value) if np.isfinite(value) else "no value"
    place = (top, y) if beyond else (float(np.nan_to_num(value)), y)
    axes.annotate(f"{text} →" if beyond else text, place, xytext=(-4 if beyond else 3, 0),
                  va="center", ha="right" if beyond else "left", textcoords="offset points",
                  fontsize=8, bbox={"facecolor": "white", "pad": 1, "linewidth": 0})  # fmt: skip


def _remarks(ladder: Ladder, steps: Mapping[str, float], top: float) -> list[str]:
    splits = sorted({step.split for step in ladder.steps})
    beyond = [title(name) for name, value in steps.items() if value > top]
    return [
        f"Runs of the {' and '.join(splits)} split." if splits else "",
        LADDER if any(STEP.fullmatch(step.model) for step in ladder.steps) else "",
        f"The bar of {beyond[0]} is longer than the axis." if beyond else "",
    ]
