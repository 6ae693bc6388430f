"""Six panels over one time axis, one per body axis: the frame of every time series."""

from typing import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.reporting.figures.legends import nothing
from rovsim.reporting.figures.palette import Look
from rovsim.reporting.figures.series import broken, limits
from rovsim.reporting.figures.style import sheet
from rovsim.reporting.wording import listed, title


def six_panels(letters: Sequence[str], units: Sequence[str]) -> tuple[Figure, list[Axes]]:
    """Return an empty sheet with six labelled panels that share the time axis."""
    figure = sheet(180)
    axes = list(figure.subplots(6, 1, sharex=True))
    for axis, name, letter, unit in zip(axes, AXES, letters, units, strict=True):
        axis.set_ylabel(f"{name} {letter}\n({unit})")
        axis.locator_params(axis="y", nbins=4)
    figure.align_ylabels(axes)
    axes[-1].set_xlabel("time (s)")
    return figure, axes


def plot_all(
    axes: list[Axes], time: Array, curves: Mapping[str, Array], looks: Mapping[str, Look]
) -> list[str]:
    """Plot curves {name: (n, 6)}; the first, measured, sets the scale. Returns remarks."""
    leaving: set[str] = set()
    for k, axis in enumerate(axes):
        for order, (name, values) in enumerate(curves.items()):
            t, y = broken(time, values[:, k])
            axis.plot(t, y, label=name, zorder=2 + order, **looks[name].line())
        leaving |= _scale(axis, {name: values[:, k] for name, values in curves.items()})
    if len(time):
        axes[-1].set_xlim(float(time[0]), float(max(time[-1], time[0] + 1e-6)))
    empty = [name for name, values in curves.items() if not np.isfinite(values).any()]
    seen = np.isfinite(next(iter(curves.values()))).any(axis=0)
    silent = [axis for axis, yes in zip(AXES, seen, strict=True) if not yes] if seen.any() else []
    return [
        f"Nothing was measured of {listed(silent)}." if silent else "",
        f"Partly beyond the axes: {listed(map(title, sorted(leaving)))}." if leaving else "",
        f"No values: {listed(map(title, empty))}." if empty else "",
    ]


def shade(axes: list[Axes], time: Array, band: Array, look: Look) -> None:
    """Fill between the ends of a band (2, n, 6), within the axes as they are."""
    for k, axis in enumerate(axes):
        shown = axis.get_ylim()
        t, ends = broken(time, band[:, :, k].T)
        axis.fill_between(t, *ends.T, zorder=1, **look.area())
        axis.set_ylim(shown)


def _scale(axis: Axes, curves: dict[str, Array]) -> set[str]:
    first, *others = curves.values()
    low, high, clipped = limits(first, others)
    if not any(np.isfinite(values).any() for values in curves.values()):
        nothing(axis, "no values")
    axis.set_ylim(low, high)
    if not clipped:
        return set()
    return {n for n, v in curves.items() if ((v < low) | (v > high)).any()}
