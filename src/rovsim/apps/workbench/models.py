"""The screen Models: two models side by side, with their errors, replays and parameters."""

from pathlib import Path
from typing import Any, Mapping, Sequence

from nicegui import ui

from rovsim.apps.workbench.charts import Panel
from rovsim.apps.workbench.choices import Choices
from rovsim.apps.workbench.divergence import tell_divergence
from rovsim.apps.workbench.parts import (
    Failure,
    about_axes,
    alarm,
    cell,
    computed,
    heading,
    onward,
    section,
    table,
    text,
    titled,
    words,
)
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.traces import (
    HORIZONS,
    Traces,
    excited,
    first_run,
    horizon_slider,
    panels,
)
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import AXES, VELOCITY_UNITS
from rovsim.core.errors import RovsimError
from rovsim.core.horizons import OPEN_LOOP, STANDARD_WINDOW, name_horizon
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effect_entry import describe_effect
from rovsim.dynamics.model import Model, nominal
from rovsim.dynamics.parameter_labels import label_parameter
from rovsim.learning.learner import learners
from rovsim.reporting.figures.palette import FAMILIES
from rovsim.reporting.units import unit
from rovsim.reporting.wording import listed, significant, title
from rovsim.reporting.words.intervals import interval
from rovsim.reporting.words.totals import list_totals, warn
from rovsim.results.comparison import Metrics
from rovsim.results.fitted import FittedValue

TITLE, QUESTION = "Models", "Which of two models is better, and what sets them apart?"
SIDES = ("left", "right")
ABSENT_SIGN = "–"
SIDE_LOOKS = (FAMILIES["nominal"], FAMILIES["knn"])  # left and right, whichever models these are
VELOCITY_ERRORS = {f"{axis} ({u})": axis for axis, u in zip(AXES, VELOCITY_UNITS, strict=True)}
POSE_ERRORS = {"position (m)": "position_rmse_m", "attitude (rad)": "attitude_rmse_rad"}
Errors = dict[str, dict[float | None, Metrics]]  # by model and horizon


class Models:
    """The screen Models on one page, and the choices made on it."""

    def __init__(self, bench: Workbench, place: Place) -> None:
        self.bench = bench
        motions, run = bench.data.motions, first_run(bench)
        names = list(bench.known_models())
        added = list(bench.models)[1:]
        others = [*(name for name in names if name != bench.base.name), *added]
        first = {
            "left": bench.base.name,
            "right": next(reversed(others), None),
            "run": run,
            "axes": excited(bench, run),
            "horizon": STANDARD_WINDOW,
        }
        possible: Mapping[str, Sequence[Any]] = {
            "left": names,
            "right": names,
            "run": list(motions),
            "axes": AXES,
            "horizon": HORIZONS,
        }
        self.chosen = Choices(place, first, possible, self.draw, zooms=True)
        self.models: dict[str, Model] = {}  # that are shown, by name
        self.traces: Traces | None = None
        self.drawn = 0  # how often the screen was drawn

    async def show(self) -> None:
        """Build the screen."""
        heading(TITLE, QUESTION)
        about_axes()
        titles = titled(self.bench.known_models())
        runs = {r: f"{r} ({split})" for r, split in self.bench.data.runs.splits.items()}
        with ui.row().classes("controls"):
            bind = self.chosen.bind
            self.sides = [bind(side, ui.select(titles, label=side.capitalize())) for side in SIDES]
            bind("run", ui.select(runs, label="Run"))
            bind("axes", ui.select(list(AXES), label="Axes", multiple=True))
            horizon_slider(self.chosen["horizon"], self._horizon)
        with ui.row().classes("controls"):
            self.file = ui.input("Another model file").classes("control wide")
            self.file.props("outlined dense").on("keydown.enter", self._open)
            ui.button("Open it on the right", on_click=self._open).props("outline no-caps")
        self.failure = Failure()
        self.area = ui.column().classes("area")
        await self.draw()

    async def _open(self) -> None:
        try:
            model = await computed(self.bench.open_model, Path(self.file.value.strip()))
        except RovsimError as error:
            self.failure.tell(error)
            return
        self.failure.forget()
        for side in self.sides:
            side.set_options(titled(self.bench.known_models()))
        self.sides[1].value = model.name

    async def _horizon(self, horizon: float | None) -> None:
        self.chosen.put("horizon", horizon)
        all_panels, remark = await self._panels()
        if self.chosen["horizon"] == horizon and self.traces:  # not moved on meanwhile
            self.traces.redraw(all_panels, remark)

    async def draw(self) -> None:
        """Draw everything below the controls."""
        self.chosen.tell()
        self.area.clear()
        self.traces, self.drawn = None, self.drawn + 1
        number = self.drawn
        try:
            names = dict.fromkeys(self.chosen[side] for side in SIDES if self.chosen[side])
            self.models = {n: await computed(self.bench.known_model, n) for n in names}
            all_panels, remark = await self._panels()
            errors = await computed(self._errors)
        except RovsimError as error:  # of a file, or of a run that lacks what an effect needs
            if number == self.drawn:
                with self.area:
                    text(str(error), "warning")
            return
        if number != self.drawn:  # something else was chosen meanwhile
            return
        with self.area:
            if len(self.models) == 1:
                text("There is only one model yet. Save another on Add, or open its file here.")
            _tell_errors(self.chosen["run"], errors)
            section("Replays")
            about = f"Measured and simulated, run {self.chosen['run']}"
            time = self.bench.data.motions[self.chosen["run"]].time
            look = {
                "measured": FAMILIES["measured"],
                **dict(zip(self.models, SIDE_LOOKS, strict=False)),
            }
            span, zoom = self.chosen.span, self.chosen.zoom
            self.traces = Traces(time, all_panels, about, span, zoom, look, remark)
            section("What is in them")
            _tell_parameters(self.models)
            _tell_totals(self.models, self.bench.catalogue)
            onward("See the test runs of all models", "/ladder")

    async def _panels(self) -> tuple[list[Panel], str]:
        """Replay both models; returns the panels, and a sentence on replays that diverge."""
        motion = self.bench.data.motions[self.chosen["run"]]
        predicted = {
            name: await computed(
                self.bench.replays.prediction, model, self.chosen["run"], self.chosen["horizon"]
            )
            for name, model in self.models.items()
        }
        by_title = {title(name): prediction for name, prediction in predicted.items()}
        all_panels = panels(motion, predicted, self.chosen["axes"])
        return all_panels, tell_divergence(motion.time, by_title)

    def _errors(self) -> Errors:
        """Compute the errors of each model at each horizon of comparison.json; None: open loop."""
        horizons = (*self.bench.settings.replay.horizons, None)
        return {
            name: {h: self.bench.replays.metrics(model, self.chosen["run"], h) for h in horizons}
            for name, model in self.models.items()
        }


def _tell_errors(run: str, errors: Errors) -> None:
    """Show a table of errors by axis and horizon, and of the change from the left to the right."""
    section("Errors")
    horizons = list(next(iter(errors.values())))
    names = list(map(title, errors))
    heads = [*names, *(["change"] if len(errors) == 2 else [])]
    rows = []
    for name in (*VELOCITY_ERRORS, *POSE_ERRORS):
        cells: list[str] = []
        for horizon in horizons:
            values = {
                model: _read(by_horizon[horizon], name) for model, by_horizon in errors.items()
            }
            label = OPEN_LOOP if horizon is None else name_horizon(horizon)
            cells += [cell(v, f"{model}/{label}/{name.split()[0]}") for model, v in values.items()]
            if len(values) == 2:
                cells.append(f'<td class="number">{tell_change(*values.values())}</td>')
        rows.append((name, cells))
    groups = [("open loop" if h is None else f"{h:g} s", len(heads)) for h in horizons]
    spans = listed([f"{h:g}" for h in horizons if h is not None])
    change = f"; change from {' to '.join(names)}" if len(errors) == 2 else ""
    table(
        f"Root mean square error on run {run}: restarted every {spans} s; open loop{change}",
        ["axis", *heads * len(horizons)],
        rows,
        groups,
    )


def _read(metrics: Metrics, name: str) -> float | None:
    """Return the error that a row of the table shows."""
    return (
        metrics.velocity_rmse[VELOCITY_ERRORS[name]]
        if name in VELOCITY_ERRORS
        else getattr(metrics, POSE_ERRORS[name])
    )


def tell_change(before: float | None, after: float | None) -> str:
    """Say by how many percent an error is larger (+) or smaller (−) than another."""
    if not before or after is None:
        return ABSENT_SIGN
    percent = round(100.0 * (after / before - 1.0))
    return f"{percent:+d} %".replace("-", "−") if percent else "0 %"


def _tell_parameters(models: Mapping[str, Model]) -> None:
    """Show a table of all parameters of the effects that were added to either model."""
    columns = {name: _values(model) for name, model in models.items()}
    keys = dict.fromkeys(key for values in columns.values() for key in values)
    if not keys:
        text("No effect was added to the vehicle file.")
        return
    rows = [
        (
            f"{effect}, {parameter}" if parameter else effect,
            [words(values.get((effect, parameter), ABSENT_SIGN)) for values in columns.values()],
        )
        for effect, parameter in keys
    ]
    heads = ["value", *map(title, columns)]
    table("Effects that were added, with 95 % intervals", heads, rows)


def _values(model: Model) -> dict[tuple[str, str], str]:
    """Return what a model adds to its vehicle file, as text by effect and parameter."""
    texts: dict[tuple[str, str], str] = {}
    for effect in model.added:
        units = {p.name: p.unit for p in effect.parameters}
        for name, parameter in describe_effect(effect).parameters.items():
            value = FittedValue(value=parameter.value, std=parameter.std, unit=units[name])
            label = label_parameter(effect.id, name, model.vehicle.thruster_names)
            texts[effect.id, label] = interval(value)
    if (learned := model.residual) is not None:
        learner = learners().get(learned.kind)
        kind = learned.kind if learner is None else learner.title
        texts["learned residual", ""] = f"{kind}, {learned.points} points"
    return texts


def _tell_totals(models: Mapping[str, Model], catalogue: Catalogue) -> None:
    """Show the total of each coefficient that differs between vehicle file and models."""
    base = nominal(next(iter(models.values())).vehicle)
    bodies = {"vehicle file": base.body} | {name: model.body for name, model in models.items()}
    columns = {name: list_totals(body) for name, body in bodies.items()}
    rows = []
    for key, before in columns["vehicle file"].items():
        values = [column[key] for column in columns.values()]
        if any(value != before for value in values):
            effect, axis = key
            (si,) = (p.unit for p in catalogue[effect].parameters if p.name == axis)
            cells = [f"<td>{significant(v)} {alarm(warn(effect, v))}</td>" for v in values]
            rows.append((f"{effect}, {axis} ({unit(si)})", cells))
    if rows:
        section("What the coefficients come to")
        table(
            "The vehicle file and what was added, together",
            ["coefficient", *map(title, columns)],
            rows,
        )


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    await Models(bench, place).show()
