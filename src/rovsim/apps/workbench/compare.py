"""Compare: measured and simulated, the difference, the path, and how far a model carries."""

from typing import Any

from nicegui import ui

from rovsim import AXES
from rovsim.apps.workbench.parts import (
    Slider,
    cell,
    computed,
    heading,
    onward,
    table,
)
from rovsim.apps.workbench.path import Path
from rovsim.apps.workbench.traces import HORIZONS, QUANTITIES, Traces, excited, horizon_text, panels
from rovsim.apps.workbench.workbench import Workbench
from rovsim.reporting.units import VELOCITY_UNITS

TITLE, QUESTION = "Compare", "How far is the model from the measurement?"


class Compare:
    """The screen, with what was chosen on it."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        first = next((r for r, m in bench.data.motions.items() if m.run.split == "test"), None)
        run = first or next(iter(bench.data.motions))
        self.chosen: dict[str, Any] = bench.choices.setdefault(
            "compare",
            {"run": run, "axes": excited(bench, run), "models": [bench.base.name],
             "quantity": "nu", "horizon": 2.0},
        )  # fmt: skip
        self.traces: Traces | None = None

    @property
    def motion(self):
        """The run shown."""
        return self.bench.data.motions[self.chosen["run"]]

    async def show(self) -> None:
        """Build the screen."""
        heading(TITLE, QUESTION)
        self._controls()
        self.area = ui.column().classes("area")
        await self.draw()

    def _controls(self) -> None:
        runs = {
            r: f"{r} ({m.run.split}, {m.time[-1] - m.time[0]:.0f} s)"
            for r, m in self.bench.data.motions.items()
        }
        with ui.row().classes("controls"):
            self._choice("run", ui.select(runs, label="Run"))
            self._choice(
                "models", ui.select(list(self.bench.models), label="Models", multiple=True)
            )
            self._choice("axes", ui.select(list(AXES), label="Axes", multiple=True))
            names = {key: name for key, (name, _) in QUANTITIES.items()}
            self._choice("quantity", ui.select(names, label="Quantity"))
            with ui.column().classes("control horizon"):
                self.horizon = ui.label()
                at = HORIZONS.index(self.chosen["horizon"])
                slider = Slider(min=0, max=len(HORIZONS) - 1, step=1, value=at)
                slider.props('markers snap aria-label="Horizon"')
                slider.on("update:model-value", lambda e: self._horizon(e.args), throttle=0.05)
        self.horizon.text = f"Horizon, {horizon_text(self.chosen['horizon'])}"

    def _choice(self, name: str, control: Any) -> None:
        control.value = self.chosen[name]
        control.classes("control").props("outlined dense options-dense")

        async def changed() -> None:
            if control.value:  # at least one of several
                self.chosen[name] = control.value
                await self.draw()

        control.on_value_change(changed)

    async def _horizon(self, at: int) -> None:
        self.chosen["horizon"] = HORIZONS[at]
        self.horizon.text = f"Horizon, {horizon_text(HORIZONS[at])}"
        shown, predicted = await self._predicted()
        if self.chosen["horizon"] != HORIZONS[at]:  # moved on meanwhile
            return
        if self.traces:
            self.traces.redraw(shown)
        self._numbers(predicted)

    async def _predicted(self):
        """Panels and predictions of what is chosen."""
        chosen = self.chosen
        predicted = {
            name: await computed(
                self.bench.prediction, self.bench.models[name], chosen["run"], chosen["horizon"]
            )
            for name in chosen["models"]
            if name in self.bench.models
        }
        axes = [axis for axis in AXES if axis in chosen["axes"]]
        return panels(self.motion, predicted, axes, chosen["quantity"]), predicted

    async def draw(self) -> None:
        """Everything below the controls."""
        shown, predicted = await self._predicted()
        self.area.clear()
        with self.area:
            self.traces = Traces(
                self.motion.time, shown, f"Measured and simulated, run {self.chosen['run']}"
            )
            self.numbers = ui.column().classes("area")
            self._numbers(predicted)
            await self._path(self.traces)
            onward("Where does it fail?", "/where")

    def _numbers(self, predicted: dict) -> None:
        """Errors of this run and horizon, as comparison.json has them."""
        self.numbers.clear()
        horizon = self.chosen["horizon"]
        with self.numbers:
            rows = []
            for name in predicted:
                found = self.bench.metrics(self.bench.models[name], self.chosen["run"], horizon)
                cells = [cell(found.velocity_rmse[a], f"velocity_rmse/{a}") for a in AXES]
                cells += [
                    cell(getattr(found, k), k) for k in ("position_rmse_m", "attitude_rmse_rad")
                ]
                rows.append((name, cells))
            units = [f"{a} ({u})" for a, u in zip(AXES, VELOCITY_UNITS, strict=True)]
            table(
                f"Velocity error (root mean square) on run {self.chosen['run']}, "
                f"{horizon_text(horizon)}",
                ["model", *units, "position (m)", "attitude (rad)"],
                rows,
            )

    async def _path(self, traces: Traces) -> None:
        """Open loop in the tank, its moment marked in the curves."""
        predicted = {
            name: (
                await computed(
                    self.bench.prediction, self.bench.models[name], self.chosen["run"], None
                )
            ).eta
            for name in self.chosen["models"]
            if name in self.bench.models
        }
        self.path = Path(self.motion, predicted, traces.mark)


async def show(bench: Workbench) -> None:
    """Show the screen."""
    await Compare(bench).show()
