"""Where something pushed that follows no law: its force on the path, and in time."""

from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from rovsim import AXES
from rovsim.reporting.figures.legends import note, nothing
from rovsim.reporting.figures.palette import FAMILIES
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.units import FORCE_UNITS
from rovsim.reporting.wording import short
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Disturbance, ForceOfRun, Push

SECTION = "verdict"
PLACE = 2
CAPTION = (
    "What pushes and follows no law: the smooth force that is left, as colour on the path seen "
    "from above, and in time; a circle marks the strongest moments."
)
COLORS = "cividis"  # as bright in grey as in colour
BETWEEN = 0.2  # s: lines of a force are as far apart


@styled()
def draw(*, disturbance: Disturbance | None) -> Figure:
    """Draw a force, a row a run: its path, and the axis where most of it acts."""
    force = disturbance
    if force is None or not force.runs:
        figure = sheet(50)
        nothing(figure.subplots(), "no disturbance was found")
        return figure
    axis = max(force.axes, key=lambda name: or_nan(force.rms[name]))
    figure = sheet(20 + 42 * len(force.runs))
    panels = figure.subplots(len(force.runs), 2, squeeze=False, width_ratios=(1, 2))
    i = AXES.index(axis)
    most = max(float(np.max(np.abs(np.array(run.force)[:, i]))) for run in force.runs)
    scale = Normalize(-most, most)
    for (path, time), run in zip(panels, force.runs, strict=True):
        _draw_path(path, run, i, scale, force)
        _draw_time(time, run, i, most, force)
    panels[-1][1].set_xlabel("time (s)")
    figure.colorbar(
        ScalarMappable(scale, COLORS),
        ax=panels[:, 0],
        label=f"{axis} ({FORCE_UNITS[i]})",
        shrink=0.7,
    )
    low, high = force.band_hz
    note(figure, [f"Train runs; four fifths of its power between {low:.2g} and {high:.2g} Hz."])
    return figure


def _draw_path(axes: Any, run: ForceOfRun, i: int, scale: Normalize, force: Disturbance) -> None:
    x, y, _ = np.array(run.place_m).T
    axes.plot(x, y, color="#BBBBBB", linewidth=0.6, zorder=1)
    axes.scatter(x, y, c=np.array(run.force)[:, i], cmap=COLORS, norm=scale, s=8, zorder=2)
    strong = _list_strong(run, force)
    axes.plot(
        [p.place_m[0] for p in strong], [p.place_m[1] for p in strong], "o", fillstyle="none",
        color=FAMILIES["nominal"].color, markersize=8, zorder=3,
    )  # fmt: skip
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x (m)")
    axes.set_ylabel(f"{short(run.run)}\ny (m)")


def _list_strong(run: ForceOfRun, force: Disturbance) -> list[Push]:
    """Its strongest moments; of a long run there may be several parts."""
    first, last = run.time_s[0] - BETWEEN, run.time_s[-1] + BETWEEN
    return [p for p in force.strongest if p.run == run.run and first <= p.time_s <= last]


def _draw_time(axes: Any, run: ForceOfRun, i: int, most: float, force: Disturbance) -> None:
    values = np.array(run.force)[:, i]
    axes.plot(run.time_s, values, **FAMILIES["measured"].line())
    strong = [p for p in _list_strong(run, force) if p.axis == AXES[i]]
    axes.plot(
        [p.time_s for p in strong], [p.force for p in strong], "o", fillstyle="none",
        color=FAMILIES["nominal"].color, markersize=8,
    )  # fmt: skip
    axes.set_ylim(-1.1 * most, 1.1 * most)
    axes.set_ylabel(f"{AXES[i]} ({FORCE_UNITS[i]})")
