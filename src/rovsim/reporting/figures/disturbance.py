"""Draw a disturbance that follows no law: on the path, over time and by frequency."""

from typing import Any, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy import ndarray as Array

from rovsim.core.axes import AXES, DENSITY_UNITS, FORCE_UNITS
from rovsim.reporting.figures.legends import explain_empty, note, set_log_scale
from rovsim.reporting.figures.palette import FAMILIES, looks
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import short
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Disturbance, ForceOfRun, StrongMoment

SECTION = "verdict"
PLACE = 2
CAPTION = (
    "What pushes and follows no law: the smooth force that is left, as colour on the path seen "
    "from above, and in time; a circle marks the strongest moments. Below, its power by frequency, "
    "without what pushes all the time: what swings or turns makes a peak. Above some 1 Hz it "
    "is stronger than shown, since the noise of the measurement hides it."
)
COLOR_MAP = "cividis"  # as bright in grey as in colour
# of the highest peak, below which a spectrum is not shown; N²/Hz
SPECTRUM_RANGE, MIN_POWER = 1e-5, 1e-12
MAX_LINE_GAP_S = 0.2  # lines of a force are as far apart


@styled()
def draw(*, disturbance: Disturbance | None) -> Figure:
    """Draw a row for each run: its path, and the force over time on the axis where most acts."""
    force = disturbance
    if force is None or not force.runs:
        figure = sheet(50)
        explain_empty(figure.subplots(), "no disturbance was found")
        return figure
    axis = max(force.axes, key=lambda name: or_nan(force.rms[name]))
    figure, panels, below = _lay_out(force)
    i = AXES.index(axis)
    most = max(float(np.max(np.abs(np.array(run.force)[:, i]))) for run in force.runs)
    scale = Normalize(-most, most)
    for (path, time), run in zip(panels, force.runs, strict=True):
        _draw_path(path, run, i, scale, force)
        _draw_time(time, run, i, most, force)
    panels[-1][1].set_xlabel("time (s)")
    figure.colorbar(
        ScalarMappable(scale, COLOR_MAP),
        ax=panels[:, 0],
        label=f"{axis} ({FORCE_UNITS[i]})",
        shrink=0.7,
    )
    low, high = force.band_hz
    for axes, family in zip(below, _list_families(force), strict=True):
        _draw_spectrum(axes, family, force)
    note(figure, [f"Train runs; four fifths of its power between {low:.2g} and {high:.2g} Hz."])
    return figure


def _lay_out(force: Disturbance) -> tuple[Figure, Array, list[Axes]]:
    """Lay out two panels (n, 2) for each of n runs, and below one for each family of spectra."""
    count, families = len(force.runs), _list_families(force)
    figure = sheet(20 + 42 * (count + bool(families)))
    grid = figure.add_gridspec(count + bool(families), 2, width_ratios=(1, 2))
    rows = [[figure.add_subplot(grid[k, i]) for i in range(2)] for k in range(count)]
    places = [grid[-1, :]] if len(families) == 1 else [grid[-1, 0], grid[-1, 1]]
    below = [figure.add_subplot(place) for _, place in zip(families, places, strict=False)]
    return figure, np.array(rows), below


def _list_families(force: Disturbance) -> list[list[int]]:
    """List the axes with a spectrum, forces and moments apart, since their units differ."""
    axes = [AXES.index(a) for a in force.axes] if force.spectrum else []
    families = [[i for i in axes if i < 3], [i for i in axes if i >= 3]]
    return [family for family in families if family]


def _draw_spectrum(axes: Axes, family: Sequence[int], force: Disturbance) -> None:
    """Draw the spectral densities of forces, or of moments, without the one at zero frequency."""
    if force.spectrum is None:
        return
    frequency, density = np.array(force.spectrum.frequency_hz), np.array(force.spectrum.density)
    styles = looks([f"effects-{AXES[i]}" for i in family])
    for i, look in zip(family, styles.values(), strict=True):
        axes.plot(frequency[1:], density[1:, i], label=AXES[i], **look.line())
    set_log_scale(axes, "xy")
    most = max(float(np.max(density[1:, family])), MIN_POWER)
    axes.set_ylim(SPECTRUM_RANGE * most, 3.0 * most)
    axes.legend(loc="lower left")
    axes.set_xlabel("frequency (Hz)")
    axes.set_ylabel(f"power ({DENSITY_UNITS[family[0]]})")


def _draw_path(axes: Any, run: ForceOfRun, i: int, scale: Normalize, force: Disturbance) -> None:
    x, y, _ = np.array(run.place_m).T
    axes.plot(x, y, color="#BBBBBB", linewidth=0.6, zorder=1)
    axes.scatter(x, y, c=np.array(run.force)[:, i], cmap=COLOR_MAP, norm=scale, s=8, zorder=2)
    _circle(axes, [p.place_m[:2] for p in _list_strong(run, force)])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x (m)")
    axes.set_ylabel(f"{short(run.run)}\ny (m)")


def _list_strong(run: ForceOfRun, force: Disturbance) -> list[StrongMoment]:
    """List the strongest moments within this part of a run; a long run may have several parts."""
    first, last = run.time_s[0] - MAX_LINE_GAP_S, run.time_s[-1] + MAX_LINE_GAP_S
    return [p for p in force.strongest if p.run == run.run and first <= p.time_s <= last]


def _draw_time(axes: Any, run: ForceOfRun, i: int, most: float, force: Disturbance) -> None:
    values = np.array(run.force)[:, i]
    axes.plot(run.time_s, values, **FAMILIES["measured"].line())
    strong = [p for p in _list_strong(run, force) if p.axis == AXES[i]]
    _circle(axes, [(p.time_s, p.force) for p in strong])
    axes.set_ylim(-1.1 * most, 1.1 * most)
    axes.set_ylabel(f"{AXES[i]} ({FORCE_UNITS[i]})")


def _circle(axes: Any, places: Sequence[Sequence[float]]) -> None:
    """Draw circles around points (x, y); no artist at all where there is no point.

    Matplotlib would reckon an unclipped line without points at the corner of the figure.
    """
    if places:
        x, y = zip(*places, strict=True)
        axes.plot(
            x,
            y,
            "o",
            fillstyle="none",
            color=FAMILIES["nominal"].color,
            markersize=8,
            zorder=3,
            clip_on=False,
        )
