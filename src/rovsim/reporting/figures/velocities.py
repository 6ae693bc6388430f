"""Draw measured and simulated body velocity over time on six axes."""

from types import MappingProxyType
from typing import Mapping

from matplotlib.figure import Figure
from numpy import ndarray as Array

from rovsim.core.axes import VELOCITY, VELOCITY_UNITS
from rovsim.reporting.figures.legends import add_legend, areas, lines, note
from rovsim.reporting.figures.palette import looks
from rovsim.reporting.figures.panels import plot_all, shade, six_panels
from rovsim.reporting.figures.series import excerpt, masked
from rovsim.reporting.figures.style import styled
from rovsim.reporting.wording import title
from rovsim.simulation.prediction import BAND_LEVEL

SECTION = "compare"
PLACE = 2
NO_BANDS: Mapping[str, Array] = MappingProxyType({})
CAPTION = (
    "Measured and simulated body velocity over time, one panel per axis. A shaded band holds 90 % "
    "of the measured velocity if the model and its noise are right. "
    "Where no line is drawn the motion capture did not see the vehicle."
)


@styled()
def draw(
    *,
    time: Array,
    nu: Array,
    predicted_nu: Mapping[str, Array],
    usable: Array | None = None,
    bands: Mapping[str, Array] = NO_BANDS,
) -> Figure:
    """Draw the measured velocity and that of each model.

    NaN, samples that are not usable and jumps of time stay gaps. A run longer than a minute is cut
    to the minute with most motion.

    Args:
        time: of the samples (n,), s.
        nu: measured velocity (n, 6), body axes, m/s and rad/s.
        predicted_nu: the same by model.
        usable: which samples (n,) may be used.
        bands: lower and upper end (2, n, 6) of the probability band, by model.
    """
    measured = masked(nu, usable)
    part = excerpt(time, measured)
    curves = {"measured": measured, **{n: masked(v, usable) for n, v in predicted_nu.items()}}
    style = looks(curves)
    figure, axes = six_panels(VELOCITY, VELOCITY_UNITS)
    remarks = plot_all(axes, time[part], {n: v[part] for n, v in curves.items()}, style)
    for name, band in bands.items():
        shade(axes, time[part], band[:, part], style[name])
    if part.stop - part.start < len(time):
        remarks.append(f"Excerpt of a run of {time[-1] - time[0]:.0f} s.")
    shades = {f"{BAND_LEVEL:.0%} band of {title(name)}": style[name] for name in bands}
    add_legend(figure, [*lines(style), *areas(shades)])
    note(figure, remarks)
    return figure
