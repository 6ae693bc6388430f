"""Draw time series in six panels over one time axis, one for each body axis."""

from typing import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.reporting.figures.legends import explain_empty
from rovsim.reporting.figures.palette import Look
from rovsim.reporting.figures.series import broken, limits
from rovsim.reporting.figures.style import sheet
from rovsim.reporting.wording import listed, title

SHARED_SCALE_NOTE = "Axes of one unit share their scale."


def six_panels(letters: Sequence[str], units: Sequence[str]) -> tuple[Figure, list[Axes]]:
    """Return an empty sheet with six labelled panels that share the time axis.

    Args:
        letters: symbol of the quantity on each axis.
        units: of the quantity on each axis.
    """
    figure = sheet(180)
    axes = list(figure.subplots(6, 1, sharex=True))
    for axis, name, letter, unit in zip(axes, AXES, letters, units, strict=True):
        axis.set_ylabel(f"{name} {letter}\n({unit})")
        axis.locator_params(axis="y", nbins=4)
    figure.align_ylabels(axes)
    axes[-1].set_xlabel("time (s)")
    return figure, axes


def plot_all(
    axes: list[Axes],
    time: Array,
    curves: Mapping[str, Array],
    looks: Mapping[str, Look],
    shared: bool = False,
) -> list[str]:
    """Plot curves in six panels; the first of them sets the scale.

    Args:
        axes: the six panels.
        time: of the samples (n,), s.
        curves: (n, 6) by name.
        looks: by name.
        shared: whether axes of one unit have one scale, so that noise on an axis at rest looks
            small.

    Returns:
        Remarks for a note below the figure; an empty one says nothing.
    """
    for k, axis in enumerate(axes):
        for order, (name, values) in enumerate(curves.items()):
            t, y = broken(time, values[:, k])
            axis.plot(t, y, label=name, zorder=2 + order, **looks[name].line())
        _scale(axis, [values[:, k] for values in curves.values()])
    if shared:
        share_scales(axes)
    leaving = {name for name, values in curves.items() if _leaves(axes, values)}
    if len(time):
        axes[-1].set_xlim(float(time[0]), float(max(time[-1], time[0] + 1e-6)))
    empty = [name for name, values in curves.items() if not np.isfinite(values).any()]
    valid = np.isfinite(next(iter(curves.values()))).any(axis=0)
    silent = [axis for axis, yes in zip(AXES, valid, strict=True) if not yes] if valid.any() else []
    return [
        f"Nothing was measured of {listed(silent)}." if silent else "",
        f"Partly beyond the axes: {listed(map(title, sorted(leaving)))}." if leaving else "",
        f"No values: {listed(map(title, empty))}." if empty else "",
        SHARED_SCALE_NOTE if shared else "",
    ]


def share_scales(axes: Sequence[Axes]) -> None:
    """Give all panels of one unit the same scale: the range of those that show something."""
    for group in (axes[:3], axes[3:]):
        ranges = [axis.get_ylim() for axis in group if _shows(axis)]
        for axis in group if ranges else ():
            axis.set_ylim(min(low for low, _ in ranges), max(high for _, high in ranges))


def _shows(axis: Axes) -> bool:
    return any(np.isfinite(np.asarray(line.get_ydata(), float)).any() for line in axis.lines)


def _leaves(axes: Sequence[Axes], values: Array) -> bool:
    """Whether a curve (n, 6) is partly beyond its panels."""
    low, high = np.array([axis.get_ylim() for axis in axes]).T
    return bool(((values < low) | (values > high)).any())


def shade(axes: list[Axes], time: Array, band: Array, look: Look) -> None:
    """Fill between the ends of a band (2, n, 6), within the axes as they are."""
    for k, axis in enumerate(axes):
        y_range = axis.get_ylim()
        t, ends = broken(time, band[:, :, k].T)
        axis.fill_between(t, *ends.T, zorder=1, **look.area())
        axis.set_ylim(y_range)


def _scale(axis: Axes, curves: Sequence[Array]) -> None:
    first, *others = curves
    if not any(np.isfinite(values).any() for values in curves):
        explain_empty(axis, "no values")
    axis.set_ylim(*limits(first, others))
