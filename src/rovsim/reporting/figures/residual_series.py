"""Draw the acceleration residual, measured minus simulated, over time on six axes."""

from typing import Mapping

from matplotlib.figure import Figure
from numpy import ndarray as Array

from rovsim.core.axes import ACCELERATION_UNITS
from rovsim.reporting.figures.legends import add_legend, lines, note
from rovsim.reporting.figures.palette import looks
from rovsim.reporting.figures.panels import plot_all, six_panels
from rovsim.reporting.figures.series import averaged, excerpt, masked
from rovsim.reporting.figures.style import styled
from rovsim.results.error_conditions import BLOCK_S

SECTION = "compare"
PLACE = 3
CAPTION = (
    "Acceleration residual, measured minus simulated, over time, one panel per axis; means over "
    "short times, which noise does not hide. A perfect model would leave only a little noise "
    "around zero."
)
AXIS_SYMBOLS = ("Δu̇", "Δv̇", "Δẇ", "Δṗ", "Δq̇", "Δṙ")


@styled()
def draw(
    *,
    time: Array,
    nu_dot: Array,
    predicted_nu_dot: Mapping[str, Array],
    usable: Array | None = None,
) -> Figure:
    """Draw the acceleration residual of each model; the first model sets the scale.

    Gaps and excerpt are as in `velocities`.

    Args:
        time: of the samples (n,), s.
        nu_dot: measured acceleration (n, 6), body axes, m/s2 and rad/s2.
        predicted_nu_dot: the same by model.
        usable: which samples (n,) may be used.
    """
    measured = masked(nu_dot, usable)
    part = excerpt(time, measured)
    curves = {
        name: averaged(time, measured - values, BLOCK_S)[part]
        for name, values in predicted_nu_dot.items()
    }
    style = looks(curves)
    figure, axes = six_panels(AXIS_SYMBOLS, ACCELERATION_UNITS)
    remarks = plot_all(axes, time[part], curves, style, True) if curves else ["No model was given."]
    remarks.append(f"Means over {BLOCK_S:g} s.")
    for axis in axes:
        axis.axhline(0.0, color="#444444", linewidth=0.6, zorder=1.5)
    if part.stop - part.start < len(time):
        remarks.append(f"Excerpt of a run of {time[-1] - time[0]:.0f} s.")
    add_legend(figure, lines(style))
    note(figure, remarks)
    return figure
