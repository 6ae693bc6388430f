"""The path in the tank, turned by hand: a parallel projection, so no WebGL is needed."""

from typing import Any, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.apps.workbench.charts import LINE, POINTS, SOFT, line_style
from rovsim.core.rotations import HALF_TURN_X
from rovsim.reporting.figures.palette import Look

WIDE = 1.6  # width over height of the picture (.path in style.css)
ROOM = 0.56  # half the picture, over what is in it
CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
EDGES = [(a, b) for a in range(8) for b in range(a, 8) if abs(CORNERS[a] - CORNERS[b]).sum() == 1]


def projected(points: Array, turn: float, tilt: float) -> Array:
    """Points (n, 3) north, west, up as seen (n, 2), turned about up and tilted, in degrees."""
    a, e = np.radians([turn, tilt])
    right = np.array([np.cos(a), np.sin(a), 0.0])
    up = np.array([-np.sin(e) * np.sin(a), np.sin(e) * np.cos(a), np.cos(e)])
    return points @ np.stack([right, up], axis=1)


def box(paths: Mapping[str, Array], tank: Array) -> Array:
    """Corners (8, 3) of the tank, or of the measured path where the tank is unknown; m."""
    known = np.sort(tank * HALF_TURN_X[:, None], axis=1)
    seen = next(iter(paths.values()))
    seen = seen[np.isfinite(seen).all(axis=1)]
    seen = seen if len(seen) else np.zeros((1, 3))
    low = np.where(np.isfinite(known[:, 0]), known[:, 0], seen.min(axis=0))
    high = np.where(np.isfinite(known[:, 1]), known[:, 1], seen.max(axis=0))
    return low + CORNERS * (high - low)


def view(
    paths: Mapping[str, Array], corners: Array, look: Mapping[str, Look], turn: float, tilt: float
) -> dict[str, Any]:
    """ECharts options of paths {name: (n, 3)} north, west, up in m, in a box; to scale."""
    flat = projected(corners, turn, tilt)
    middle, size = 0.5 * (flat.max(axis=0) + flat.min(axis=0)), np.ptp(flat, axis=0)
    tall = ROOM * max(size[1], size[0] / WIDE)  # half of what is seen, m
    half = np.array([WIDE * tall, tall])
    axis = {"type": "value", "show": False}
    return {
        "grid": {"left": 4, "right": 4, "top": 4, "bottom": 4},
        "xAxis": {**axis, "min": float(middle[0] - half[0]), "max": float(middle[0] + half[0])},
        "yAxis": {**axis, "min": float(middle[1] - half[1]), "max": float(middle[1] + half[1])},
        "series": [
            *(_line(f"edge{k}", flat[list(edge)]) for k, edge in enumerate(EDGES)),
            *(
                _line(name, projected(path[:: max(1, len(path) // POINTS)], turn, tilt))
                | {"lineStyle": line_style(look[name])}
                for name, path in paths.items()
            ),
            *(here(name, None, look[name]) for name in paths),
            _names(corners, turn, tilt),
        ],
    }  # fmt: skip


def _line(name: str, points: Array) -> dict[str, Any]:
    data = [[None, None] if p[0] != p[0] else np.round(p, 4).tolist() for p in points]
    return {
        "id": name, "type": "line", "showSymbol": False, "silent": True, "data": data,
        "lineStyle": {"color": LINE, "width": 1}, "clip": True,
    }  # fmt: skip


def here(name: str, point: Array | None, look: Look) -> dict[str, Any]:
    """Where a vehicle is at the moment shown; `point` (2,) as projected."""
    data = [] if point is None or point[0] != point[0] else [np.round(point, 4).tolist()]
    return {
        "id": f"here/{name}", "type": "scatter", "symbolSize": 13, "silent": True, "data": data,
        "z": 5, "itemStyle": {"color": look.color, "borderColor": "#ffffff", "borderWidth": 2},
    }  # fmt: skip


def _names(corners: Array, turn: float, tilt: float) -> dict[str, Any]:
    """North, west and up beside the edges that point there."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = 0.5 * (low + high)
    spots = {
        "north →": [middle[0], low[1], low[2]], "west ↗": [high[0], middle[1], low[2]],
        "up ↑": [low[0], low[1], middle[2]],
    }  # fmt: skip
    data = [
        {"value": projected(np.array([spot]), turn, tilt)[0].tolist(), "name": name}
        for name, spot in spots.items()
    ]
    return {
        "id": "names", "type": "scatter", "symbolSize": 1, "silent": True, "data": data,
        "label": {"show": True, "formatter": "{b}", "color": SOFT, "position": "bottom"},
    }  # fmt: skip
