"""The ladder: the error on held-out runs falling, step by step."""

from typing import Any, Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rovsim.figures.marks import legend, note, nothing, number, short, significant
from rovsim.figures.palette import FAMILIES, looks
from rovsim.figures.style import sheet, styled

SECTION = "ladder"
CAPTION = (
    "Error of every step on runs none of them was fitted to: the velocity error of 2 s windows "
    "in units of the measured velocity's spread, averaged over the excited axes. Lower is better."
)


@styled()
def draw(*, ladder: Mapping[str, Any]) -> Figure:
    """Draw `windows_2s` of `ladder.json` from the first step down, the noise floor as a line."""
    steps = {s["model"]: number(s.get("windows_2s")) for s in ladder.get("steps", [])}
    floor = steps.pop("noise_floor", float("nan"))
    style = looks(steps)
    figure = sheet(26 + 7.5 * max(len(steps), 3))
    axes = figure.subplots()
    for row, (name, value) in enumerate(steps.items()):
        y = len(steps) - 1 - row
        axes.barh(y, np.nan_to_num(value), 0.66, **style[name].bar())
        text = significant(value) if np.isfinite(value) else "no value"
        axes.annotate(text, (float(np.nan_to_num(value)), y), xytext=(3, 0), va="center",
                      textcoords="offset points", fontsize=8,
                      bbox={"facecolor": "white", "pad": 1, "linewidth": 0})  # fmt: skip
    axes.set_yticks(range(len(steps)), [short(n, 28) for n in reversed(steps)])
    axes.set_ylim(-0.6, max(len(steps), 1) - 0.4)
    top = float(np.nanmax([*steps.values(), floor, 0.0])) or 1.0
    axes.set_xlim(0, top * 1.14)
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    axes.set_xlabel("velocity RMSE of 2 s windows / spread of the measured velocity (–)")
    if not steps:
        nothing(axes, "no steps")
    if np.isfinite(floor):
        look = FAMILIES["noise_floor"]
        axes.axvline(floor, **look.line())
        label = f"noise floor, {significant(floor)}"
        legend(figure, [Line2D([], [], label=label, **look.line())])
    splits = sorted({s["split"] for s in ladder.get("steps", []) if s.get("split")})
    note(figure, [f"Runs of the {' and '.join(splits)} split." if splits else ""])
    return figure
