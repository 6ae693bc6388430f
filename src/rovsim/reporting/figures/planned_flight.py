"""Draw a planned flight: its path in the tank, and its commands. No figure of the study."""

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from numpy import ndarray as Array

from rovsim.core.rotations import HALF_TURN_X
from rovsim.reporting.figures.legends import add_legend
from rovsim.reporting.figures.palette import (
    BLACK,
    BLUE,
    BROWN,
    GREEN,
    GREY,
    OLIVE,
    PURPLE,
    VERMILION,
    Dash,
    Style,
)
from rovsim.reporting.figures.style import sheet, styled

PATH_COLOR, CHANCE_COLOR = VERMILION, GREY
START_MARKER: Style = {
    "marker": "o",
    "color": PATH_COLOR,
    "markersize": 4,
    "markeredgecolor": "white",
}
COMMAND_COLORS = (BLUE, BROWN, GREEN, PURPLE, BLACK, OLIVE, GREY)  # then dashed
COMMAND_DASHES: tuple[Dash, ...] = ("-", (0, (4, 1.5)), (0, (1, 1.2)))
MARGIN_M = 0.3  # shown around the paths where no wall is known


@dataclass(frozen=True, eq=False)
class PlannedFlight:
    """A planned flight: possible paths and commands.

    Attributes:
        paths: s sampled paths (s, k, 3), the likeliest first; NED, m.
        tank: limits (3, 2), NaN where unknown; NED, m.
        time: of the commands (m,), s.
        values: commands (m, c) at these times.
        names: of the c columns of commands.
        unit: of the commands.
    """

    paths: Array
    tank: Array
    time: Array
    values: Array
    names: tuple[str, ...]
    unit: str


@styled()
def draw_flight(planned_flight: PlannedFlight) -> Figure:
    """Draw a flight from above and from the side, where else it may lead, and its commands."""
    figure = sheet(120)
    grid: Any = figure.add_gridspec(2, 2, height_ratios=(1.0, 1.1))
    paths, tank = planned_flight.paths * HALF_TURN_X, planned_flight.tank * HALF_TURN_X[:, None]
    _draw_view(figure.add_subplot(grid[0, 0]), paths, tank, (0, 1), ("north (m)", "west (m)"))
    _draw_view(figure.add_subplot(grid[0, 1]), paths, tank, (0, 2), ("north (m)", "up (m)"))
    axes = figure.add_subplot(grid[1, :])
    steps = max(1, len(planned_flight.time) // 2000)  # more points than the paper shows
    looks = list(product(COMMAND_DASHES, COMMAND_COLORS))
    for k, (name, column) in enumerate(
        zip(planned_flight.names, planned_flight.values.T, strict=True)
    ):
        dash, color = looks[k % len(looks)]
        axes.plot(
            planned_flight.time[::steps],
            column[::steps],
            label=name,
            linewidth=0.7,
            color=color,
            linestyle=dash,
        )
    axes.set_xlabel("time (s)")
    axes.set_ylabel(f"command ({planned_flight.unit})")
    axes.margins(x=0.0)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.0)
    add_legend(
        figure,
        [
            Line2D([], [], color=PATH_COLOR, label="likeliest path"),
            Line2D([], [], color=CHANCE_COLOR, label="where else it may lead"),
            Line2D([], [], linestyle="none", label="start", **START_MARKER),
        ],
    )
    return figure


def _draw_view(
    axes: Axes, paths: Array, tank: Array, seen: tuple[int, int], labels: tuple[str, str]
) -> None:
    a, b = seen
    for path in paths[:0:-1]:
        axes.plot(path[:, a], path[:, b], color=CHANCE_COLOR, linewidth=0.3, alpha=0.5)
    axes.plot(paths[0, :, a], paths[0, :, b], color=PATH_COLOR, linewidth=0.9)
    axes.plot(*paths[0, :1, [a, b]], linestyle="none", **START_MARKER)
    low, high = np.sort(tank[[a, b]], axis=1).T
    if np.isfinite([low, high]).all():
        axes.add_patch(Rectangle(low, *(high - low), fill=False, edgecolor="#444444"))
    reached = paths[:, :, [a, b]].reshape(-1, 2)
    least, most = reached.min(axis=0) - MARGIN_M, reached.max(axis=0) + MARGIN_M
    least, most = np.fmin(low, least), np.fmax(high, most)
    axes.set(xlim=(least[0], most[0]), ylim=(least[1], most[1]), aspect="equal")
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
