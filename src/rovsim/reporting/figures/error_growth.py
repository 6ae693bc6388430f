"""Draw how the velocity error grows with the time since the model was set to the measurement."""

import numpy as np
from matplotlib.figure import Figure

from rovsim.core.axes import AXES, VELOCITY_UNITS
from rovsim.reporting.figures.legends import add_legend, explain_empty, lines, note
from rovsim.reporting.figures.palette import looks
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import listed, title
from rovsim.results.base import or_nan
from rovsim.results.growth import Growth

SECTION = "compare"
CAPTION = (
    "Velocity error against the time since the model was started from the measured state, "
    "one panel per axis, on the test runs."
)


@styled()
def draw(*, growth: Growth) -> Figure:
    """Draw `growth.json`: the velocity RMSE of each model over the horizon, axis by axis."""
    style = looks(growth.models)
    figure = sheet(110)
    panels = figure.subplots(2, 3, sharex=True)
    plotted: set[str] = set()
    for axes, axis, unit in zip(panels.flat, AXES, VELOCITY_UNITS, strict=True):
        for name, curve in growth.models.items():
            values = list(map(or_nan, curve.velocity_rmse[axis]))
            if np.isfinite(values).any():
                plotted.add(name)
                axes.plot(curve.horizon_s, values, label=title(name), **style[name].line())
        axes.set_title(axis)
        axes.set_ylim(bottom=0)
        axes.set_xlim(left=0)
        if not axes.lines:
            explain_empty(axes, "no values")
        if axis in ("surge", "roll"):
            axes.set_ylabel(f"velocity RMSE ({unit})")
    for axes in panels[1]:
        axes.set_xlabel("time since start (s)")
    missing = [title(name) for name in growth.models if name not in plotted]
    add_legend(figure, lines(style))
    note(figure, [f"No values: {listed(missing)}." if missing else ""])
    return figure
