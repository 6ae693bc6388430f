"""A chart of the path in the tank in three dimensions, to be turned and played in time."""

import csv
from contextlib import suppress
from io import StringIO
from itertools import product
from typing import Callable, Mapping

import numpy as np
from nicegui import ui
from numpy import ndarray as Array

from rovsim.apps.workbench.chart_axes import SOFT
from rovsim.apps.workbench.charts import styles
from rovsim.apps.workbench.parts import Slider, saving, section, text
from rovsim.core.rotations import HALF_TURN_X
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.wording import title

PAPER_COLOR = "#ffffff"
TICK_S = 0.1  # s between two pictures of a playback
PLAYBACK_SPEED = 2  # times as fast as it was
NEXT_PICTURE = "new Promise(requestAnimationFrame)"  # kept when the browser draws its next picture
PATIENCE_S = 10.0  # s for one picture, before the next is sent: hidden tabs draw none
MAX_CURVES = 80  # bent tubes of a path: about one a second
MAX_FPS = 10  # a machine that draws without a graphics card must keep up
TUBE_RADIUS = 0.0012  # at width 1, over the size of the room
VEHICLE_RADIUS = 0.01  # over the size of the room
DIRECTIONS = ("north", "east", "down")
WALL_TOLERANCE_M = 0.05  # m beyond a wall that are no leaving: walls and places are known no better
EYE_DIRECTION = np.array([-0.25, -0.9, 0.5])  # direction from the middle to the eye
# degrees that the eye sees from below to above; width over height
EYE_ANGLE_DEG, ASPECT_RATIO = 40.0, 1.6
FILLED_SHARE = 0.86  # of the picture: names stand beside the room
# The page of the tank goes behind names too, so that no edge strikes them through.
NAME_STYLE = f"color: {SOFT}; background: {PAPER_COLOR}; padding: 0 4px; font-size: 13px"


class Path:
    """Measured and simulated paths on the page, with the vehicles at one moment.

    Args:
        motion: the run.
        predicted: eta (n, 6) of each model, open loop: NED, m.
        changed: called with the moment shown, s.
    """

    def __init__(
        self, motion: Motion, predicted: Mapping[str, Array], changed: Callable[[float], None]
    ) -> None:
        measured = np.where(motion.usable[:, None], motion.eta[:, :3], np.nan)
        paths = {"measured": measured, **{name: eta[:, :3] for name, eta in predicted.items()}}
        self.paths = {name: x * HALF_TURN_X for name, x in paths.items()}  # north, west, up
        self.time, self.changed = motion.time, changed
        section("Path in the tank")
        text(
            "Measured and open loop, from the same start, in metres north, east and down. Play, or "
            "drag the time; the mouse turns the tank, its wheel with Ctrl comes closer."
        )
        for remark in tell_leaving(motion.time, paths, motion.site.tank):
            text(remark, "warning")
        self._controls()
        self._draw(*room(measured * HALF_TURN_X, motion.site.tank))
        with ui.row().classes("keep"):
            saving("CSV", "Path in the tank").on_click(
                lambda: ui.download.content(
                    path_table(motion.run.id, motion.time, paths), "rovsim_path.csv", "text/csv"
                )
            )
        self.timer = ui.timer(TICK_S, self._tick, active=False)

    def _controls(self) -> None:
        start, end = float(self.time[0]), float(self.time[-1])
        with ui.row().classes("controls"):
            self.play = ui.button("Play", icon="play_arrow", on_click=self._toggle)
            self.play.props("unelevated no-caps")
            with ui.column().classes("control wide"):
                ui.label("Time (s)")
                self.clock = Slider(min=start, max=end, step=TICK_S, value=start)
                self.clock.props('label aria-label="Time in the run, seconds"')
                self.clock.on("update:model-value", lambda e: self._show(e.args), throttle=0.05)

    def _draw(self, low: Array, high: Array) -> None:
        middle, size = 0.5 * (low + high), float(np.linalg.norm(high - low))
        look = styles(list(self.paths))
        camera = ui.scene.perspective_camera(fov=EYE_ANGLE_DEG, near=0.01 * size, far=10 * size)
        scene = ui.scene(
            grid=False, background_color=PAPER_COLOR, camera=camera, click_events=[], fps=MAX_FPS
        )
        scene.classes("path").props('role="img" aria-label="Path in the tank"')
        with scene:
            wide, long, tall = (high - low).tolist()
            walls = scene.box(wide, long, tall, wireframe=True)
            walls.move(*middle.tolist()).material(SOFT)
            for name, spot in directions(low, high).items():
                scene.text(name, NAME_STYLE).move(*spot)
            for name, path in self.paths.items():
                radius = TUBE_RADIUS * size * look[name].width
                for start, bend, end in bends(path):
                    tube = scene.quadratic_bezier_tube(start, bend, end, 4, radius, 5)
                    tube.material(look[name].color)
            self.spots = {
                name: scene.sphere(VEHICLE_RADIUS * size).material(look[name].color).visible(False)
                for name in self.paths
            }
        eye = dict(zip("xyz", (middle + far_enough(low, high)).tolist(), strict=True))
        target = {f"look_at_{k}": x for k, x in zip("xyz", middle.tolist(), strict=True)}
        scene.move_camera(**eye, **target, duration=0)

    def _toggle(self) -> None:
        self.timer.active = not self.timer.active
        self.play.set_text("Pause" if self.timer.active else "Play")
        self.play.set_icon("pause" if self.timer.active else "play_arrow")

    async def _tick(self) -> None:
        """Advance the playback by one picture, no faster than the browser draws; then restart."""
        moment = self.clock.value + TICK_S * PLAYBACK_SPEED
        self.clock.value = round(moment if moment <= self.time[-1] else float(self.time[0]), 2)
        self._show(self.clock.value)
        with suppress(TimeoutError):
            await ui.run_javascript(NEXT_PICTURE, timeout=PATIENCE_S)

    def _show(self, moment: float) -> None:
        """Move the vehicles to where they are at one moment, s."""
        k = int(np.clip(np.searchsorted(self.time, moment), 0, len(self.time) - 1))
        for name, path in self.paths.items():
            visible = bool(np.isfinite(path[k]).all())
            self.spots[name].visible(visible)
            if visible:
                self.spots[name].move(*path[k].tolist())
        self.changed(moment)


def bends(path: Array) -> list[tuple[list[float], list[float], list[float]]]:
    """Return start, control point and end (3,) of quadratic Bezier curves along a path (n, 3).

    Each curve passes through three points of the path, which is thinned to about `MAX_CURVES` of
    them; those with a gap (NaN) are left out.
    """
    k = np.unique(np.linspace(0, len(path) - 1, 2 * MAX_CURVES + 1).astype(int))
    k = k[: len(k) - (len(k) + 1) % 2]  # pieces share their ends: an odd number of points
    start, middle, end = path[k[:-2:2]], path[k[1:-1:2]], path[k[2::2]]
    curves = np.stack([start, 2.0 * middle - 0.5 * (start + end), end], axis=1)
    return [tuple(curve) for curve in curves[np.isfinite(curves).all(axis=(1, 2))].tolist()]


def room(measured: Array, tank: Array) -> tuple[Array, Array]:
    """Return lowest and highest corner (3,) of the tank, or of the path where walls are unknown.

    Args:
        measured: path (n, 3) north, west, up; m.
        tank: limits (3, 2) in NED, NaN where unknown; m.
    """
    walls = np.sort(tank * HALF_TURN_X[:, None], axis=1)
    points = measured[np.isfinite(measured).all(axis=1)]
    points = points if len(points) else np.zeros((1, 3))
    low = np.where(np.isfinite(walls[:, 0]), walls[:, 0], points.min(axis=0))
    high = np.where(np.isfinite(walls[:, 1]), walls[:, 1], points.max(axis=0))
    return low, np.maximum(high, low + 0.1)  # a box has a size, whatever moved


def far_enough(low: Array, high: Array) -> Array:
    """Return the vector (3,) from the middle of a room to an eye that sees all of it, m.

    Args:
        low: lowest corner (3,), north, west, up; m.
        high: highest corner (3,), likewise.
    """
    ahead = EYE_DIRECTION / np.linalg.norm(EYE_DIRECTION)
    right = np.cross([0.0, 0.0, 1.0], ahead)
    right /= np.linalg.norm(right)
    above = np.cross(ahead, right)
    corners = 0.5 * (high - low) * np.array(list(product((-1.0, 1.0), repeat=3)))
    slope = FILLED_SHARE * np.tan(np.radians(0.5 * EYE_ANGLE_DEG))
    aside = np.maximum(np.abs(corners @ above), np.abs(corners @ right) / ASPECT_RATIO)
    return ahead * float(np.max(corners @ ahead + aside / slope))


def directions(low: Array, high: Array) -> dict[str, list[float]]:
    """Return labels of three edges of the room (direction and range), and where each stands (3,).

    Args:
        low: lowest corner (3,), north, west, up; m.
        high: highest corner (3,), likewise.
    """
    # North along one edge, east along the next, and down from its end: no two names meet.
    ends = (high[0], high[1], high[2]), (low[0], low[1], high[2]), (low[0], low[1], low[2])
    labels = {}
    for k, (name, end) in enumerate(zip(DIRECTIONS, ends, strict=True)):
        a, b = sorted((HALF_TURN_X[k] * low[k], HALF_TURN_X[k] * high[k]))
        label = f"{name} {round(a, 2) + 0.0:g} to {round(b, 2) + 0.0:g} m"
        labels[label.replace("-", "−")] = [float(x) for x in end]
    return labels


def tell_leaving(time: Array, paths: Mapping[str, Array], tank: Array) -> list[str]:
    """Say which simulated paths (n, 3) leave the tank, and when.

    Args:
        time: of the samples (n,), s.
        paths: NED by name, `measured` among them; m.
        tank: limits (3, 2) in NED, NaN where unknown; m.
    """
    low, high = np.sort(tank, axis=1).T
    sentences = []
    for name, path in paths.items():
        outside = ((path < low - WALL_TOLERANCE_M) | (path > high + WALL_TOLERANCE_M)).any(axis=1)
        if name != "measured" and outside.any():
            seconds = time[np.argmax(outside)] - time[0]
            sentences.append(f"The replay of {title(name)} leaves the tank after {seconds:.1f} s.")
    return sentences


def path_table(run: str, time: Array, paths: Mapping[str, Array]) -> str:
    """Return paths (n, 3), NED, m, as the text of a CSV; a cell is empty where nothing is known."""
    heads = [f"{run} {name}, {way} (m)" for name in paths for way in DIRECTIONS]
    values = np.hstack([time[:, None], *paths.values()])
    text = StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["time (s)", *heads])
    table.writerows([[f"{x:.6g}" if np.isfinite(x) else "" for x in row] for row in values])
    return text.getvalue()
