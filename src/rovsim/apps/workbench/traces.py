"""A chart of measured and simulated values over time, and of their difference below."""

from dataclasses import replace
from types import MappingProxyType
from typing import Any, Callable, Mapping, Sequence

import numpy as np
from nicegui import ui
from numpy import ndarray as Array

from rovsim.apps.workbench.charts import (
    Panel,
    columns,
    cursor,
    height,
    series_data,
    styles,
    time_series,
)
from rovsim.apps.workbench.divergence import cut, find_divergence
from rovsim.apps.workbench.parts import Slider, chart
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import ACCELERATION_UNITS, AXES, FORCE_UNITS, VELOCITY_UNITS
from rovsim.core.rotations import short_way, to_euler
from rovsim.measurement.signals.measured import blank
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.figures.palette import Look
from rovsim.simulation.bands import Band
from rovsim.simulation.prediction import Prediction

Span = tuple[float | None, float | None]  # s, part of a run; None: from its start, to its end
POSE_UNITS = ("m",) * 3 + ("rad",) * 3
QUANTITIES = {
    "nu": ("velocity", VELOCITY_UNITS),
    "nu_dot": ("acceleration", ACCELERATION_UNITS),
    "eta": ("position and attitude", POSE_UNITS),
}
# Names of the components of a pose, which is in the tank's axes, by axis of the body.
POSE_TITLES = dict(zip(AXES, ("north", "east", "down", "roll", "pitch", "yaw"), strict=True))
BAND_FIELDS = {"nu": "nu", "eta": "place"}  # what a band calls these; others have none
NO_BANDS: Mapping[str, Band] = MappingProxyType({})
STEADY_CURVES = ("measured", "commanded")  # curves that no model changes
HORIZONS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, None)  # s; None: open loop


def horizon_text(horizon: float | None) -> str:
    """Say in words after how many seconds a model is restarted; None: open loop."""
    return "open loop: never restarted" if horizon is None else f"restarted every {horizon:g} s"


def horizon_slider(horizon: float | None, changed: Callable[[float | None], Any]) -> None:
    """Show a slider over `HORIZONS` with its value above; `changed` is called with each value."""

    def moved(event: Any) -> Any:
        label.text = f"Horizon, {horizon_text(HORIZONS[event.args])}"
        return changed(HORIZONS[event.args])

    with ui.column().classes("control horizon"):
        label = ui.label(f"Horizon, {horizon_text(horizon)}")
        slider = Slider(min=0, max=len(HORIZONS) - 1, step=1, value=HORIZONS.index(horizon))
        slider.props('markers snap aria-label="Horizon"')
        slider.on("update:model-value", moved, throttle=0.05)


def first_run(bench: Workbench) -> str:
    """Return the first train run: test runs stay closed until somebody chooses them."""
    return next(iter([*bench.data.runs.of("train"), *bench.data.motions]))


def excited(bench: Workbench, run: str) -> list[str]:
    """Return at most three axes that moved in a run, to be shown first."""
    quality = bench.data.quality[run]
    return list(quality.excited or quality.excitation or AXES)[:3]


def panels(
    motion: Motion,
    predicted: Mapping[str, Prediction],
    axes: Sequence[str],
    quantity: str = "nu",
    thrust: Array | None = None,
    bands: Mapping[str, Band] = NO_BANDS,
) -> list[Panel]:
    """Return a panel for each axis, with a panel of the difference (measured minus model) below.

    Args:
        motion: the run.
        predicted: replays of it, by model.
        axes: to be shown, in any order.
        quantity: one of `QUANTITIES`.
        thrust: wrench (n, 6) of the commands along the axes of the body, N and N m, for a third
            panel; None for none.
        bands: probability bands by model.
    """
    (quantity_name, units), run = QUANTITIES[quantity], motion.run.id
    measured = np.where(motion.usable[:, None], _measured(motion, quantity), np.nan)
    diverging = [n for n, p in predicted.items() if find_divergence(motion.time, p) is not None]
    all_panels = []
    for k, axis in enumerate(AXES):
        if axis not in axes:
            continue
        models = {name: _columns(p, quantity)[:, k] for name, p in predicted.items()}
        models |= {name: cut(models[name], measured[:, k]) for name in diverging}
        missed = {name: measured[:, k] - values for name, values in models.items()}
        ends = {name: getattr(band, BAND_FIELDS[quantity])[:, :, k] for name, band in bands.items()}
        title, description = axis, f"{run} {axis} {quantity_name}"
        if quantity == "eta":
            title, description = POSE_TITLES[axis], f"{run} {POSE_TITLES[axis]}"
            missed = {n: short_way(x) if k > 2 else x for n, x in missed.items()}
        missed_bands = {name: end - measured[:, k] + missed[name] for name, end in ends.items()}
        curves = {"measured": measured[:, k], **models}
        about = {name: f"{description}, {name}" for name in curves}
        all_panels.append(Panel(title, units[k], curves, bands=ends, about=about))
        about = {name: f"{description}, measured − {name}" for name in missed}
        title = f"{title}: measured − model"
        all_panels.append(
            Panel(title, units[k], missed, short=True, bands=missed_bands, about=about)
        )
        if thrust is not None:
            all_panels.append(_thrust_panel(axis, thrust[:, k], run))
    return all_panels


def _thrust_panel(axis: str, values: Array, run: str) -> Panel:
    """Return the panel of the thrust (n,) that the commands cause along an axis."""
    unit = FORCE_UNITS[AXES.index(axis)]
    about = {"commanded": f"{run} {axis} thrust, commanded"}
    title = f"{axis}: thrust by the commands"
    return Panel(title, unit, {"commanded": values}, short=True, about=about)


def _columns(of: Motion | Prediction, quantity: str) -> Array:
    """Return a quantity as (n, 6); of a pose the position, m, and Euler angles, rad."""
    values = getattr(of, quantity)
    if quantity != "eta":
        return values
    turned = np.where(np.isinf(values[:, 3:]), np.nan, values[:, 3:])  # where a replay diverged
    return np.hstack([values[:, :3], to_euler(turned)])


def _measured(motion: Motion, quantity: str) -> Array:
    """Return the measured quantity (n, 6) as `_columns`, NaN on axes that were not measured."""
    values, measured = _columns(motion, quantity), motion.measured
    if measured is None or quantity != "eta":
        return blank(measured, values, np.nan)
    return np.where([*measured.coordinates, *measured.axes[3:5], *measured.heading], values, np.nan)


def beside(
    first: tuple[Motion, list[Panel]], others: Sequence[tuple[Motion, list[Panel]]]
) -> list[Panel]:
    """Add the curves of other runs to the panels of a run, all from the start of their run."""
    motion, base_panels = first
    time = motion.time - motion.time[0]
    curves = [dict(panel.curves) for panel in base_panels]
    about = [dict(panel.about) for panel in base_panels]
    for other, other_panels in others:
        other_time = other.time - other.time[0]
        for k, panel in enumerate(other_panels):
            for name, values in panel.curves.items():
                label = f"{name}, {other.run.id}"
                curves[k][label] = np.interp(time, other_time, values, right=np.nan)
                about[k][label] = panel.about[name]
    return [
        replace(p, curves=c, about=a) for p, c, a in zip(base_panels, curves, about, strict=True)
    ]


# Quasar says "0|12" where the standard wants one number; each end can be reached with the keyboard.
NOT_ONE_VALUE = "role=group " + " ".join(
    f":aria-{name}=null" for name in ("valuenow", "valuemin", "valuemax", "orientation")
)


class Traces:
    """The chart on the page, with a remark above and a range slider for zooming below.

    Args:
        time: of the samples (n,), s.
        shown: the panels.
        about: what the chart shows, for screen readers.
        span: start and end of the part that is shown first, s.
        zoomed: called with the part that is shown after a change; (None, None): the whole run.
        look: by name of a curve; chosen by name unless given.
        remark: for instance on replays that diverge.
    """

    def __init__(
        self,
        time: Array,
        shown: Sequence[Panel],
        about: str,
        span: Span = (None, None),
        zoomed: Callable[[Span], None] = lambda span: None,
        look: Mapping[str, Look] | None = None,
        remark: str = "",
    ) -> None:
        self.time, self.shown, self.zoomed = time, list(shown), zoomed
        names = list(dict.fromkeys(n for panel in shown for n in panel.curves))
        self.remark = ui.label().classes("text warning").props('role="status"')
        self._remark(remark)
        options = time_series(time, shown, look or styles(names))
        self.chart = chart(options, about, height(shown), columns=columns(shown))
        first, last = float(time[0]), float(time[-1])
        with ui.row().classes("control wide"):
            ui.label("Part of the run shown")
            self.range = ui.range(
                min=first, max=last, step=0.1, value={"min": first, "max": last}
            ).props(f'label aria-label="Part of the run shown, seconds" {NOT_ONE_VALUE}')
            self.range.on("update:model-value", self._zoom, throttle=0.05)
            ui.button("whole run", on_click=self._whole).props("flat dense no-caps")
        self.chart.on("chart:datazoom", self._zoomed, js_handler=ZOOM_HANDLER)
        low = first if span[0] is None else max(span[0], first)
        high = last if span[1] is None else min(span[1], last)
        if (first, last) != (low, high) and low < high:
            self.range.value = {"min": low, "max": high}
            self.chart.options["dataZoom"][0] |= {"startValue": low, "endValue": high}

    def _zoom(self) -> None:
        part = self.range.value
        self.chart.run_chart_method(
            "dispatchAction",
            {"type": "dataZoom", "startValue": part["min"], "endValue": part["max"]},
        )
        self._tell()

    def _tell(self) -> None:
        """Report which part of the run is shown."""
        part = (float(self.range.value["min"]), float(self.range.value["max"]))
        whole = part == (float(self.time[0]), float(self.time[-1]))
        self.zoomed((None, None) if whole else part)

    def _whole(self) -> None:
        self.range.value = {"min": float(self.time[0]), "max": float(self.time[-1])}
        self._zoom()

    def _zoomed(self, event: Any) -> None:
        """Move the slider after the user has zoomed in the chart itself."""
        first, span = float(self.time[0]), float(self.time[-1] - self.time[0])
        if event.args:
            start, end = event.args
            self.range.value = {
                "min": round(first + span * start / 100, 1),
                "max": round(first + span * end / 100, 1),
            }
            self._tell()

    def _remark(self, words: str) -> None:
        self.remark.text, self.remark.visible = words, bool(words)

    def redraw(self, shown: Sequence[Panel], remark: str = "") -> None:
        """Show new values of the same curves; only these are sent to the browser."""
        self.shown = list(shown)
        self._remark(remark)
        self.chart.run_chart_method(
            "setOption", {"series": series_data(self.time, shown, STEADY_CURVES)}
        )

    def mark(self, time: float | None) -> None:
        """Mark an instant (s) in every panel; None removes the mark."""
        marks = [cursor(k, time) for k in range(len(self.shown))]
        self.chart.run_chart_method("setOption", {"series": marks})


# The zoom that a user made in the chart itself, in percent; one made by the slider has no batch.
ZOOM_HANDLER = "(e) => e.batch && emit([e.batch[0].start, e.batch[0].end])"
