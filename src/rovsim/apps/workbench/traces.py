"""Measured and simulated over time, the difference under it: a chart that several screens use."""

from typing import Any, Mapping, Sequence

import numpy as np
from nicegui import ui
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.apps.workbench.charts import Panel, cursor, height, series_data, styles, time_series
from rovsim.apps.workbench.parts import chart
from rovsim.apps.workbench.workbench import Workbench
from rovsim.measurement.signals.measured import blank
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.units import ACCELERATION_UNITS, VELOCITY_UNITS
from rovsim.simulation.prediction import Prediction

QUANTITIES = {"nu": ("velocity", VELOCITY_UNITS), "nu_dot": ("acceleration", ACCELERATION_UNITS)}
HORIZONS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, None)  # s; None: open loop


def horizon_text(horizon: float | None) -> str:
    """A horizon in words."""
    return "open loop: never corrected" if horizon is None else f"corrected every {horizon:g} s"


def excited(bench: Workbench, run: str) -> list[str]:
    """Axes that moved in a run, at most three to begin with."""
    known = bench.data.quality[run]
    return list(known.excited or known.excitation or AXES)[:3]


def panels(
    motion: Motion, predicted: Mapping[str, Prediction], axes: Sequence[str], quantity: str = "nu"
) -> list[Panel]:
    """A panel per axis, and under it what each model missed (measured minus model)."""
    _, units = QUANTITIES[quantity]
    moved = blank(motion.measured, getattr(motion, quantity), np.nan)
    measured = np.where(motion.usable[:, None], moved, np.nan)
    found = []
    for axis in axes:
        k = AXES.index(axis)
        models = {name: getattr(p, quantity)[:, k] for name, p in predicted.items()}
        missed = {name: measured[:, k] - values for name, values in models.items()}
        found.append(Panel(axis, units[k], {"measured": measured[:, k], **models}))
        found.append(Panel(f"{axis}: measured − model", units[k], missed, short=True))
    return found


# Quasar says "0|12" where the standard wants one number; each end can be reached with the keyboard.
NOT_ONE_VALUE = "role=group " + " ".join(
    f":aria-{name}=null" for name in ("valuenow", "valuemin", "valuemax", "orientation")
)


class Traces:
    """The chart on the page, with a range slider that zooms all its panels."""

    def __init__(self, time: Array, shown: Sequence[Panel], about: str) -> None:
        self.time, self.shown = time, list(shown)
        names = list(dict.fromkeys(n for panel in shown for n in panel.curves))
        self.chart = chart(time_series(time, shown, styles(names)), about, height(shown))
        first, last = float(time[0]), float(time[-1])
        with ui.row().classes("control wide"):
            ui.label("Part of the run shown")
            self.range = ui.range(
                min=first, max=last, step=0.1, value={"min": first, "max": last}
            ).props(f'label aria-label="Part of the run shown, seconds" {NOT_ONE_VALUE}')
            self.range.on("update:model-value", self._zoom, throttle=0.05)
            ui.button("whole run", on_click=self._whole).props("flat dense no-caps")
        self.chart.on("chart:datazoom", self._zoomed, js_handler=WINDOW)

    def _zoom(self) -> None:
        at = self.range.value
        self.chart.run_chart_method(
            "dispatchAction",
            {"type": "dataZoom", "startValue": at["min"], "endValue": at["max"]},
        )

    def _whole(self) -> None:
        self.range.value = {"min": float(self.time[0]), "max": float(self.time[-1])}
        self._zoom()

    def _zoomed(self, event: Any) -> None:
        """The user zoomed in the chart: the slider follows."""
        first, span = float(self.time[0]), float(self.time[-1] - self.time[0])
        if event.args:
            start, end = event.args
            self.range.value = {
                "min": round(first + span * start / 100, 1),
                "max": round(first + span * end / 100, 1),
            }

    def redraw(self, shown: Sequence[Panel]) -> None:
        """New values of the same curves: only these travel to the browser."""
        self.shown = list(shown)
        self.chart.run_chart_method(
            "setOption", {"series": series_data(self.time, shown, "measured")}
        )

    def mark(self, time: float | None) -> None:
        """Mark an instant in every panel."""
        marks = [cursor(k, time) for k in range(len(self.shown))]
        self.chart.run_chart_method("setOption", {"series": marks})


# The zoom that a user made in the chart itself, in percent; one made by the slider has no batch.
WINDOW = "(e) => e.batch && emit([e.batch[0].start, e.batch[0].end])"
