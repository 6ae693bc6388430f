"""Draw measured and simulated paths in the tank, with up in the water upwards on paper."""

from typing import Any, Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.axes3d import Axes3D
from numpy import ndarray as Array

from rovsim.core.rotations import HALF_TURN_X
from rovsim.reporting.figures.legends import add_legend, lines, note
from rovsim.reporting.figures.palette import looks
from rovsim.reporting.figures.series import broken, masked
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import listed, title

SECTION = "compare"
PLACE = 4
CAPTION = (
    "Measured and simulated path of the vehicle in the tank, to scale and with up pointing up; "
    "a circle marks the start, a square the end. In open loop nothing corrects a model: small "
    "errors add up, and even a good model can end metres away."
)
ELEVATION, AZIMUTH = 25, 60  # degrees
FILL_HEIGHT, FILL_WIDTH = 0.75, 1.25  # found by eye: no label is cut at any shape of box
MARGIN_M = 0.5  # shown around the measured path where the tank is unknown
BOX_CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


@styled()
def draw(
    *,
    time: Array,
    position: Array,
    predicted_position: Mapping[str, Array],
    usable: Array | None = None,
    tank: Array | None = None,
) -> Figure:
    """Draw the measured and the simulated paths of a run.

    They are plotted north, west and up (NED turned half a turn about x, so nothing is mirrored),
    which are the axes of a z-up motion capture. What leaves the view is cut and named.

    Args:
        time: of the samples (n,), s.
        position: that was measured (n, 3), NED, m.
        predicted_position: the same by model.
        usable: which samples (n,) may be used.
        tank: lower and upper limits (3, 2), NED, m; None where unknown.
    """
    paths = {"measured": masked(position, usable)}
    paths |= {name: masked(values, usable) for name, values in predicted_position.items()}
    paths = {name: path * HALF_TURN_X for name, path in paths.items()}
    style = looks(paths)
    figure = sheet(90)
    axes: Any = figure.add_subplot(projection="3d")
    low, high = _view(paths["measured"], tank)
    leaving = []
    for name, path in paths.items():
        visible = _inside(path, low, high)
        if np.isfinite(visible).sum() < np.isfinite(path).sum():
            leaving.append(name)
        paths[name] = visible
        axes.plot(*broken(time, visible)[1].T, label=title(name), **style[name].line())
    for name in reversed(paths):  # the measured ends lie on top
        _draw_ends(axes, paths[name], style[name].color)
    if tank is not None and np.isfinite(tank).all():
        _draw_box(axes, low, high)
    _set_frame(axes, low, high)
    add_legend(figure, [*lines(style), *_end_entries()])
    note(figure, [f"Partly beyond the view: {listed(map(title, leaving))}." if leaving else ""])
    return figure


def _view(measured: Array, tank: Array | None) -> tuple[Array, Array]:
    walls = np.full((3, 2), np.nan) if tank is None else np.sort(tank * HALF_TURN_X[:, None])
    points = measured[np.isfinite(measured).all(axis=1)]
    if not len(points):
        points = np.array([[-1.0] * 3, [1.0] * 3])
    low = np.where(np.isfinite(walls[:, 0]), walls[:, 0], points.min(axis=0) - MARGIN_M)
    high = np.where(np.isfinite(walls[:, 1]), walls[:, 1], points.max(axis=0) + MARGIN_M)
    return np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))


def _inside(path: Array, low: Array, high: Array) -> Array:
    outside = np.logical_or(path < low, path > high).any(axis=1, keepdims=True)
    return np.where(outside, np.nan, path)


def _draw_ends(axes: Axes3D, path: Array, color: str) -> None:
    points = path[np.isfinite(path).all(axis=1)]
    for point, marker in ((points[:1], "o"), (points[-1:], "s")):
        axes.plot(
            *point.T,
            marker,
            color=color,
            markersize=4,
            markeredgecolor="white",
            markeredgewidth=0.5,
        )


def _draw_box(axes: Axes3D, low: Array, high: Array) -> None:
    corners = low + BOX_CORNERS * (high - low)
    for a in range(8):
        for b in range(a + 1, 8):
            if abs(BOX_CORNERS[a] - BOX_CORNERS[b]).sum() == 1:
                axes.plot(*corners[[a, b]].T, color="#999999", linewidth=0.6)


def _set_frame(axes: Any, low: Array, high: Array) -> None:
    long = (high - low) / (high - low).max()
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_zlim(low[2], high[2])
    axes.set_box_aspect(high - low, zoom=_zoom(high - low))
    axes.set_xlabel("north (m)", labelpad=8 * long[0])
    axes.set_ylabel("west (m)", labelpad=8 * long[1])
    axes.set_zlabel("up (m)", labelpad=2)
    for line in axes.lines:
        line.set_clip_on(False)  # the zoomed box is wider than the square that axes get
        line.set_in_layout(False)
    for name in "xyz":
        axes.locator_params(axis=name, nbins=5)
    axes.view_init(elev=ELEVATION, azim=-AZIMUTH)


def _zoom(size: Array) -> float:
    """Return the largest zoom at which the labels of a box of `size` (3,) still fit the sheet."""
    x, y, z = size / np.linalg.norm(size)
    elevation, azimuth = np.radians([ELEVATION, AZIMUTH])
    deep = x * np.cos(azimuth) + y * np.sin(azimuth)
    tall = z * np.cos(elevation) + deep * np.sin(elevation)
    wide = x * np.sin(azimuth) + y * np.cos(azimuth)
    return float(min(FILL_HEIGHT / tall, FILL_WIDTH / wide))


def _end_entries() -> list[Line2D]:
    return [
        Line2D([], [], linestyle="", marker=marker, color="#444444", markersize=4, label=label)
        for marker, label in (("o", "start"), ("s", "end"))
    ]
