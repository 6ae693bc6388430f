"""The screen Compare: replays beside the measurement, their errors, and the path in the tank."""

from typing import Any, Sequence

from nicegui import ui

from rovsim.apps.workbench.charts import Panel
from rovsim.apps.workbench.choices import Choices
from rovsim.apps.workbench.divergence import tell_divergence
from rovsim.apps.workbench.parts import (
    about_axes,
    cell,
    computed,
    heading,
    onward,
    table,
    text,
    titled,
)
from rovsim.apps.workbench.path import Path
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.traces import (
    BAND_FIELDS,
    HORIZONS,
    QUANTITIES,
    Traces,
    beside,
    excited,
    first_run,
    horizon_slider,
    horizon_text,
    panels,
)
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import AXES, VELOCITY_UNITS
from rovsim.core.horizons import STANDARD_WINDOW
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.wording import title
from rovsim.simulation.bands import BAND_LEVEL, Band, why_without_bands
from rovsim.simulation.prediction import Prediction

Predicted = dict[str, dict[str, Prediction]]  # by run and model
Drawn = tuple[Motion, list[Panel]]
POSE_ERRORS = ("position_rmse_m", "attitude_rmse_rad")
TITLE, QUESTION = "Compare", "How far is the model from the measurement?"


class Compare:
    """The screen Compare on one page, and the choices made on it."""

    def __init__(self, bench: Workbench, place: Place) -> None:
        self.bench = bench
        runs = list(bench.data.motions)
        run = first_run(bench)
        first = {
            "run": run,
            "beside": [],
            "models": [bench.base.name],
            "axes": excited(bench, run),
            "quantity": "nu",
            "horizon": STANDARD_WINDOW,
            "bands": False,
        }
        possible: dict[str, Sequence[Any]] = {
            "run": runs,
            "beside": runs,
            "models": list(bench.models),
            "axes": AXES,
            "quantity": list(QUANTITIES),
            "horizon": HORIZONS,
            "bands": (False, True),
        }
        self.chosen = Choices(place, first, possible, self.draw, zooms=True)
        self.traces: Traces | None = None

    @property
    def motion(self):
        """Motion of the run that is shown."""
        return self.bench.data.motions[self.chosen["run"]]

    async def show(self) -> None:
        """Build the screen."""
        heading(TITLE, QUESTION)
        about_axes("; positions are north, east and down in the tank")
        self._controls()
        self.area = ui.column().classes("area")
        await self.draw()

    def _controls(self) -> None:
        runs = {
            r: f"{r} ({q.split}, {q.duration_s:.0f} s)"
            for r, q in self.bench.data.quality.items()
            if r in self.bench.data.motions
        }
        with ui.row().classes("controls"):
            bind = self.chosen.bind
            bind("run", ui.select(runs, label="Run"))
            bind("beside", ui.select(runs, label="Other runs", multiple=True), optional=True)
            models = titled(self.bench.models)
            bind("models", ui.select(models, label="Models", multiple=True))
            bind("axes", ui.select(list(AXES), label="Axes", multiple=True))
            names = {key: name for key, (name, _) in QUANTITIES.items()}
            bind("quantity", ui.select(names, label="Quantity"))
            if any(m.uncertainty is not None for m in self.bench.models.values()):
                bind("bands", ui.switch(f"{BAND_LEVEL:.0%} bands"), optional=True)
            horizon_slider(self.chosen["horizon"], self._horizon)

    async def _horizon(self, horizon: float | None) -> None:
        self.chosen.put("horizon", horizon)
        all_panels, predicted = await self._predicted()
        if self.chosen["horizon"] != horizon:  # moved on meanwhile
            return
        if self.traces:
            self.traces.redraw(all_panels, self._remark(predicted))
        self._numbers(predicted)

    @property
    def runs(self) -> list[str]:
        """Names of the run that is shown and of those beside it."""
        return list(dict.fromkeys([self.chosen["run"], *self.chosen["beside"]]))

    async def _predicted(self) -> tuple[list[Panel], Predicted]:
        """Replay the chosen models; returns the panels, and the predictions by run and model."""
        choices = self.chosen
        predictions: Predicted = {run: {} for run in self.runs}
        for run, predicted in predictions.items():
            for name in choices["models"]:
                predicted[name] = await computed(
                    self.bench.replays.prediction, self.bench.models[name], run, choices["horizon"]
                )
        first, *others = [await self._panels(run, p) for run, p in predictions.items()]
        return beside(first, others), predictions

    async def _panels(self, run: str, predicted: dict[str, Prediction]) -> Drawn:
        """Return a run and its panels; only the run that is shown has probability bands."""
        motion = self.bench.data.motions[run]
        axes, quantity = self.chosen["axes"], self.chosen["quantity"]
        thrust = await computed(self.bench.replays.thrust, self.bench.base, run)
        bands: dict[str, Band] = {}
        if self.chosen["bands"] and run == self.chosen["run"] and quantity in BAND_FIELDS:
            for name in predicted:
                model, horizon = self.bench.models[name], self.chosen["horizon"]
                band = await computed(self.bench.replays.band, model, run, horizon)
                bands |= {name: band} if band else {}
        return motion, panels(motion, predicted, axes, quantity, thrust, bands)

    def _remark(self, predicted: Predicted) -> str:
        """Say which replays diverge; empty where none does."""
        remarks = []
        for run, models in predicted.items():
            several = len(predicted) > 1
            by_title = {
                f"{title(n)}, {run}," if several else title(n): p for n, p in models.items()
            }
            remarks.append(tell_divergence(self.bench.data.motions[run].time, by_title))
        return " ".join(filter(None, remarks))

    def _tell_missing_bands(self) -> None:
        """Show which of the chosen models have no probability bands, and why."""
        if not self.chosen["bands"]:
            return
        if self.chosen["quantity"] not in BAND_FIELDS:
            text("Accelerations have no bands.", "soft")
            return
        for name in self.chosen["models"]:
            why = why_without_bands(self.bench.models[name], self.motion)
            if why:
                text(f"No band for {title(name)}: {why}.", "soft")

    async def draw(self) -> None:
        """Draw everything below the controls."""
        all_panels, predicted = await self._predicted()
        self.chosen.tell()
        self.area.clear()
        with self.area:
            about = f"Measured and simulated, run {', '.join(self.runs)}"
            self._tell_missing_bands()
            remark = self._remark(predicted)
            span, zoom = self.chosen.span, self.chosen.zoom
            self.traces = Traces(self.motion.time, all_panels, about, span, zoom, remark=remark)
            self.numbers = ui.column().classes("area")
            self._numbers(predicted)
            await self._path(self.traces)
            onward("Where does it fail?", "/where")

    def _numbers(self, predicted: Predicted) -> None:
        """Show a table of the errors at this horizon, with the numbers of comparison.json."""
        self.numbers.clear()
        horizon = self.chosen["horizon"]
        with self.numbers:
            rows = []
            for run, name in ((run, name) for run, models in predicted.items() for name in models):
                errors = self.bench.replays.metrics(self.bench.models[name], run, horizon)
                key = "" if run == self.chosen["run"] else f"{run}/"
                cells = [cell(errors.velocity_rmse[a], f"{key}velocity_rmse/{a}") for a in AXES]
                cells += [cell(getattr(errors, k), f"{key}{k}") for k in POSE_ERRORS]
                label = title(name)
                rows.append((f"{label}, {run}" if len(predicted) > 1 else label, cells))
            units = [f"{a} ({u})" for a, u in zip(AXES, VELOCITY_UNITS, strict=True)]
            table(
                f"Velocity error (root mean square) on run {', '.join(predicted)}, "
                f"{horizon_text(horizon)}",
                ["model", *units, "position (m)", "attitude (rad)"],
                rows,
            )

    async def _path(self, traces: Traces) -> None:
        """Show the open-loop paths in the tank; their moment is marked in the curves."""
        predicted = {
            name: (
                await computed(
                    self.bench.replays.prediction, self.bench.models[name], self.chosen["run"], None
                )
            ).eta
            for name in self.chosen["models"]
        }
        self.path = Path(self.motion, predicted, traces.mark)


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    await Compare(bench, place).show()
