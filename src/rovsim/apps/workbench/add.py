"""The screen Add: tick effects, move their values, watch the replay change, save the model."""

import asyncio
from typing import Any, Mapping, Sequence

from nicegui import ui

from rovsim.apps.workbench.add_effects import Effects
from rovsim.apps.workbench.choices import Choices
from rovsim.apps.workbench.divergence import tell_divergence
from rovsim.apps.workbench.parts import about_axes, computed, heading, text, tile, tile_html
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.saving import Saving
from rovsim.apps.workbench.traces import (
    HORIZONS,
    Traces,
    excited,
    first_run,
    horizon_slider,
    panels,
)
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import AXES
from rovsim.core.errors import RovsimError
from rovsim.core.horizons import STANDARD_WINDOW
from rovsim.dynamics.model import Model
from rovsim.simulation.prediction import Prediction

TITLE, QUESTION = "Add", "How much better is it once that is added?"
# NiceGUI has sent the curves; beside them it would send the numbers first
SENDING_PAUSE_S = 0.002


class Add:
    """The screen Add on one page: the draft, and how it replays one run."""

    def __init__(self, bench: Workbench, place: Place) -> None:
        self.bench, self.draft = bench, bench.draft
        train = bench.data.runs.of("train")
        self.runs = train or list(bench.data.motions)
        run = first_run(bench)
        first = {"run": run, "axes": excited(bench, run), "horizon": STANDARD_WINDOW}
        possible: Mapping[str, Sequence[Any]] = {
            "run": self.runs,
            "axes": AXES,
            "horizon": HORIZONS,
        }
        self.chosen = Choices(place, first, possible, self._redraw)
        self.wanted = self.drawing = False
        self.missing = False  # no chart is shown, since no model could be built of the draft
        self.drawn = 0  # how often the chart was drawn
        self.traces: Traces | None = None

    async def show(self) -> None:
        """Build the screen."""
        heading(TITLE, QUESTION)
        text(
            "Tick an effect to add it, move a slider to change it: the replay follows at once. "
            "Here you see a train run; the test runs are opened when you save.",
            "soft",
        )
        about_axes()
        with ui.row().classes("halves"):
            with ui.column().classes("half left"):
                self.effects = Effects(self.bench, self.draw, self.update)
                Saving(self.bench)
            with ui.column().classes("half right"):
                with ui.row().classes("controls"):
                    bind = self.chosen.bind
                    bind("run", ui.select(self.runs, label="Run"))
                    bind("axes", ui.select(list(AXES), label="Axes", multiple=True))
                    horizon_slider(self.chosen["horizon"], self._horizon)
                with ui.row().classes("tiles"):
                    self.before = tile("This run, before", None, "run/before")
                    self.after = tile("This run, now", None, "run/now")
                self.area = ui.column().classes("area")
        await self.draw()

    async def _horizon(self, horizon: float | None) -> None:
        self.chosen.put("horizon", horizon)
        await self.draw()

    async def _redraw(self) -> None:
        self.chosen.tell()
        await self.draw()

    @property
    def run(self) -> str:
        """Name of the run that is shown."""
        return self.chosen["run"]

    def _model(self) -> Model | None:
        """Build a model of the draft; None, with a message on the page, where that cannot be."""
        try:
            model = self.draft.model()
            motion = self.bench.data.motions[self.run]
            model.check(motion.site, motion.commands.kind)
        except RovsimError as error:
            self.effects.tell(error)
            return None
        self.effects.forget()
        return model

    def _replayed(self, model: Model) -> tuple[Any, float | None]:
        """Replay the shown run; returns its prediction, and the 2 s error (None if unknown)."""
        prediction = self.bench.replays.prediction(model, self.run, self.chosen["horizon"])
        return prediction, self.bench.replays.run_error(model, self.run)

    def _remark(self, predicted: Mapping[str, Prediction]) -> str:
        """Say which replays of the shown run diverge; empty where none does."""
        return tell_divergence(self.bench.data.motions[self.run].time, predicted)

    def _tell(self, place: ui.html, when: str, error: float | None) -> None:
        """Write the 2 s error of the shown run into a tile; `when` is "before" or "now"."""
        split = self.bench.data.motions[self.run].run.split
        note = f"2 s windows, {split} run"
        place.content = tile_html(f"This run, {when}", error, f"run/{when}", note)

    async def draw(self) -> None:
        """Replay the base and the draft, and draw the chart and the two errors anew."""
        self.area.clear()
        self.traces, self.wanted = None, False
        self.drawn += 1
        number = self.drawn
        model = self._model()
        self.missing = model is None
        if model is None:
            return
        with self.area:  # outlives the control that was used
            waiting = ui.spinner()  # the first replay with a new force compiles it
            base, before = await computed(self._replayed, self.bench.base)
            prediction, error = await computed(self._replayed, model)
            if number != self.drawn:  # something else was chosen meanwhile
                return
            waiting.delete()
            motion = self.bench.data.motions[self.run]
            self.base = base
            run_panels = panels(
                motion, {self.bench.base.name: base, "new": prediction}, self.chosen["axes"]
            )
            about = f"Run {self.run}, before and with the effects"
            remark = self._remark({self.bench.base.name: base, "the new model": prediction})
            self.traces = Traces(motion.time, run_panels, about, remark=remark)
        self._tell(self.before, "before", before)
        self._tell(self.after, "now", error)
        if self.wanted:  # a slider was moved meanwhile
            await self.update()

    async def update(self) -> None:
        """Replay the draft after a slider was moved.

        Of several values that arrive during one replay only the last is replayed.
        """
        self.wanted = True
        if self.missing:
            await self.draw()
        if self.drawing or self.traces is None:
            return
        self.drawing = True
        try:
            while self.wanted and self.traces is not None:
                self.wanted = False
                model = self._model()
                if model is not None:
                    await self._follow(model, self.traces)
        finally:
            self.drawing = False

    async def _follow(self, model: Model, traces: Traces) -> None:
        """Replay the draft: put its curves into the present chart, then its error into the tile."""
        with self.area:
            prediction, error = await computed(self._replayed, model)
        if traces is not self.traces:  # another chart is drawn, with the draft as it is then
            return
        motion = self.bench.data.motions[self.run]
        remark = self._remark({self.bench.base.name: self.base, "the new model": prediction})
        traces.redraw(panels(motion, {"new": prediction}, self.chosen["axes"]), remark)
        await asyncio.sleep(SENDING_PAUSE_S)
        self._tell(self.after, "now", error)


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    await Add(bench, place).show()
