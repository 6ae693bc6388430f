"""Compare: measured and simulated, the difference, the path, and how far a model carries."""

from typing import Any

import numpy as np
from nicegui import ui

from rovsim import AXES
from rovsim.apps.workbench import path
from rovsim.apps.workbench.charts import styles
from rovsim.apps.workbench.parts import (
    Slider,
    cell,
    chart,
    computed,
    heading,
    onward,
    section,
    table,
    text,
)
from rovsim.apps.workbench.traces import HORIZONS, QUANTITIES, Traces, excited, horizon_text, panels
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.rotations import HALF_TURN_X
from rovsim.reporting.figures.marks import VELOCITY_UNITS

TITLE, QUESTION = "Compare", "How far is the model from the measurement?"
TICK = 0.1  # s between two pictures of a playback


class Compare:
    """The screen, with what was chosen on it."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        first = next((r for r, m in bench.data.motions.items() if m.run.split == "test"), None)
        run = first or next(iter(bench.data.motions))
        self.chosen: dict[str, Any] = bench.choices.setdefault(
            "compare",
            {"run": run, "axes": excited(bench, run), "models": [bench.base.name],
             "quantity": "nu", "horizon": 2.0, "turn": 30.0, "tilt": 25.0, "speed": 2},
        )  # fmt: skip
        self.moment = 0.0
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
            await self._path()
            onward("Where does it fail?", "/where")

    def _numbers(self, predicted: dict) -> None:
        """Errors of this run and horizon, as comparison.json has them."""
        self.numbers.clear()
        horizon = self.chosen["horizon"]
        with self.numbers:
            rows = []
            for name in predicted:
                found = self.bench.metrics(self.bench.models[name], self.chosen["run"], horizon)
                cells = [cell(found["velocity_rmse"][a], f"velocity_rmse/{a}") for a in AXES]
                cells += [cell(found[k], k) for k in ("position_rmse_m", "attitude_rmse_rad")]
                rows.append((name, cells))
            units = [f"{a} ({u})" for a, u in zip(AXES, VELOCITY_UNITS, strict=True)]
            table(
                f"Velocity error (root mean square) on run {self.chosen['run']}, "
                f"{horizon_text(horizon)}",
                ["model", *units, "position (m)", "attitude (rad)"],
                rows,
            )

    async def _path(self) -> None:
        section("Path in the tank")
        text("Measured and open loop, from the same start. Play, or drag the time.")
        models = [n for n in self.chosen["models"] if n in self.bench.models]
        found = {"measured": np.where(self.motion.usable[:, None], self.motion.eta[:, :3], np.nan)}
        for name in models:
            replayed = await computed(
                self.bench.prediction, self.bench.models[name], self.chosen["run"], None
            )
            found[name] = replayed.eta[:, :3]
        self.paths = {name: x * HALF_TURN_X for name, x in found.items()}
        self.look = styles(list(self.paths))
        self.corners = path.box(self.paths, self.motion.site.tank)
        with ui.row().classes("controls"):
            self.play = ui.button("Play", icon="play_arrow", on_click=self._toggle).props(
                "unelevated no-caps"
            )
            first, last = float(self.motion.time[0]), float(self.motion.time[-1])
            with ui.column().classes("control wide"):
                ui.label("Time (s)")
                self.clock = Slider(min=first, max=last, step=TICK, value=first).props(
                    'label aria-label="Time in the run, seconds"'
                )
                self.clock.on("update:model-value", lambda e: self._at(e.args), throttle=0.05)
            for name, label, low, high in (
                ("turn", "Turn (°)", -180, 180),
                ("tilt", "Tilt (°)", 0, 90),
            ):
                with ui.column().classes("control"):
                    ui.label(label)
                    slider = Slider(min=low, max=high, step=5, value=self.chosen[name])
                    slider.props(f'label aria-label="{label}"')
                    slider.on(
                        "update:model-value", lambda e, n=name: self._turn(n, e.args), throttle=0.05
                    )
        self.room = chart(self._view(), "Path in the tank").classes("path")
        self.timer = ui.timer(TICK, self._tick, active=False)

    def _view(self) -> dict[str, Any]:
        return path.view(
            self.paths, self.corners, self.look, self.chosen["turn"], self.chosen["tilt"]
        )

    def _turn(self, name: str, value: float) -> None:
        self.chosen[name] = value
        self.room.run_chart_method("setOption", self._view())
        self._at(self.moment)

    def _toggle(self) -> None:
        self.timer.active = not self.timer.active
        self.play.set_text("Pause" if self.timer.active else "Play")
        self.play.set_icon("pause" if self.timer.active else "play_arrow")

    def _tick(self) -> None:
        """One picture on; from the end it starts anew."""
        on = self.moment + TICK * self.chosen["speed"]
        on = on if on <= self.motion.time[-1] else float(self.motion.time[0])
        self.clock.value = round(on, 2)
        self._at(on)

    def _at(self, moment: float) -> None:
        """Show one instant, in the curves and in the tank."""
        self.moment = moment
        k = int(np.clip(np.searchsorted(self.motion.time, moment), 0, len(self.motion.time) - 1))
        spots = [
            path.here(
                name,
                path.projected(x[k : k + 1], self.chosen["turn"], self.chosen["tilt"])[0],
                self.look[name],
            )
            for name, x in self.paths.items()
        ]
        self.room.run_chart_method("setOption", {"series": spots})
        if self.traces:
            self.traces.mark(moment)


async def show(bench: Workbench) -> None:
    """Show the screen."""
    await Compare(bench).show()
