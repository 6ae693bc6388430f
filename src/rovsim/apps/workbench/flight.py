"""The screen Flight: plan the recording that would tell most, with its path and its commands."""

import shlex
from html import escape
from pathlib import Path
from typing import Any, Mapping, Sequence

from nicegui import ui

from rovsim.application.settings import select
from rovsim.apps.workbench import jobs
from rovsim.apps.workbench.choices import Choices
from rovsim.apps.workbench.parts import (
    cell,
    computed,
    heading,
    in_a_terminal,
    png,
    section,
    table,
    text,
    titled,
    words,
)
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.errors import RovsimError
from rovsim.design.settings import MAX_FLIGHT_SECONDS, MIN_FLIGHT_SECONDS, Question
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.effect_entry import describe_effect
from rovsim.dynamics.parameter_labels import label_parameters
from rovsim.reporting.units import unit
from rovsim.reporting.words.experiment import list_steps, size_of_odds, tell_limits, tell_share
from rovsim.results.experiment import Experiment

TITLE, QUESTION = "Flight", "Which flight would tell most?"
FLIGHT_QUESTIONS = {"between": "Which of two effects is it?", "know": "How large is a value?"}
USUAL_RIVALS = ("linear_damping", "quadratic_damping")  # where no diagnosis names two


class Flight:
    """The screen Flight on one page, and the choices made on it."""

    def __init__(self, bench: Workbench, place: Place) -> None:
        self.bench = bench
        rival_groups = bench.diagnosis.indistinguishable if bench.diagnosis else ()
        one, other = next((pair for pair in rival_groups if len(pair) == 2), USUAL_RIVALS)
        trained = {name for name, m in bench.models.items() if m.residual is not None or m.inert}
        self.known_models = [name for name in bench.known_models() if name not in trained]
        added = [name for name in list(bench.models)[1:] if name not in trained]
        first = {
            "model": (added or self.known_models)[-1],
            "asked": "between",
            "one": one,
            "other": other,
            "seconds": int(bench.settings.seconds),
        }
        effects = list(bench.catalogue)
        possible: Mapping[str, Sequence[Any]] = {
            "model": self.known_models,
            "asked": list(FLIGHT_QUESTIONS),
            "one": effects,
            "other": effects,
            "seconds": range(MIN_FLIGHT_SECONDS, MAX_FLIGHT_SECONDS + 1),
        }
        self.chosen = Choices(place, first, possible, self._draw)

    async def show(self) -> None:
        """Build the screen."""
        heading(TITLE, QUESTION)
        text(
            "A minute of commands, made for your question: predicted from all that the train runs "
            "leave open, within the walls and limits, and compared with the usual manoeuvres."
        )
        self.chosen.add({"know": []}, {"know": await self._values()})
        self.controls = ui.row().classes("controls")
        self.area = ui.column().classes("area")
        await self._draw_all()

    async def _draw_all(self) -> None:
        await self._controls()
        await self._draw()

    async def _controls(self) -> None:
        """Draw the controls: the question, the model, and which of its values may be asked for."""
        names, effects, choices = await self._values(), list(self.bench.catalogue), self.chosen
        choices["know"] = [name for name in choices["know"] if name in names]
        self.controls.clear()
        with self.controls:
            bind, redraw = choices.bind, self._draw_all
            bind("asked", ui.select(FLIGHT_QUESTIONS, label="The question"), redraw=redraw)
            if choices["asked"] == "between":
                bind("one", ui.select(effects, label="One", with_input=True))
                bind("other", ui.select(effects, label="Or the other", with_input=True))
            else:
                select = ui.select(names, label="Values (none: all)", multiple=True)
                bind("know", select, optional=True)
            bind("model", ui.select(titled(self.known_models), label="Model"), redraw=redraw)
            seconds = ui.number(
                "Length (s)", min=MIN_FLIGHT_SECONDS, max=MAX_FLIGHT_SECONDS, precision=0
            )
            seconds.props("debounce=500")  # ms, for two more digits
            bind("seconds", seconds, convert=int)

    async def _values(self) -> list[str]:
        """List every value of the effects that were added to the model, as "effect.parameter"."""
        try:
            model = await computed(self.bench.known_model, self.chosen["model"])
        except RovsimError:  # `_draw` shows it
            return []
        return [f"{e.id}.{name}" for e in model.added for name in describe_effect(e).parameters]

    @property
    def question(self) -> Question:
        """The question that is chosen."""
        choices, settings = self.chosen, self.bench.settings
        tells_apart = choices["asked"] == "between"
        return Question.of(
            select(settings, DiagnosisSettings),
            settings.design,
            "the question",
            seconds=choices["seconds"],
            between=(choices["one"], choices["other"]) if tells_apart else (),
            know=() if tells_apart else choices["know"],
        )

    async def _draw(self) -> None:
        """Show the flight that answers the question, or a button that plans it."""
        self.chosen.tell()
        self.area.clear()
        try:
            question = self.question
            folder = await computed(self.bench.flight_folder, self.chosen["model"], question)
            path = folder / "experiment.json"
            experiment = Experiment.read(path) if path.exists() else None
        except RovsimError as error:
            with self.area:
                text(str(error), "warning")
            return
        self.area.clear()  # another change may have been drawn meanwhile
        with self.area:
            if experiment is None:
                self._ask(question)
            else:
                _tell(experiment, folder, self.bench.data.vehicle.thruster_names)
            self._terminal()

    def _ask(self, question: Question) -> None:
        text(
            "Commands are searched that move the vehicle so that the answer shows best. This takes "
            "one to some minutes, and can be cancelled.",
            "soft",
        )
        button = jobs.Beginning(
            self.bench,
            "Plan the flight",
            icon="route",
            on_click=lambda: jobs.start_design(self.bench, self.chosen["model"], question),
        )
        button.props("unelevated no-caps").classes("onward")

    def _terminal(self) -> None:
        choices = self.chosen
        key = f"between=[{choices['one']},{choices['other']}]"
        key = key if choices["asked"] == "between" else f"know=[{','.join(choices['know'])}]"
        campaign, model = self.bench.settings.campaign, self.bench.paths[choices["model"]]
        args = [f"campaign={campaign}", f"model={model}", key, f"seconds={choices['seconds']}"]
        command = shlex.join(word for word in (*args, "out=PLAN") if word != "know=[]")
        in_a_terminal(f"rovsim design {command}")


def _tell(experiment: Experiment, folder: Path, thrusters: Sequence[str]) -> None:
    """Show a planned flight: what it is expected to tell, its path, and instructions.

    Args:
        experiment: the plan.
        folder: that holds its files.
        thrusters: names of the vehicle's thrusters.
    """
    section(f"A flight of {experiment.seconds:g} s")
    for item in experiment.warnings:
        text(item, "warning")
    _show_expected(experiment, thrusters)
    text(tell_limits(experiment))
    png(folder / "experiment.png", "The predicted path from above and from the side, the commands")
    with ui.row().classes("controls"):
        for name, title in (("experiment.csv", "Commands"), ("instructions.txt", "Instructions")):
            ui.button(
                f"{title} ({name})",
                icon="download",
                on_click=lambda _, path=folder / name: ui.download.file(path),
            ).props("outline no-caps")
    section("What to do")
    ui.html(_numbered(experiment.instructions), sanitize=False).classes("text")
    section("What the usual manoeuvres would tell")
    rows = [(name, [words(tell_share(item))]) for name, item in experiment.baselines.items()]
    table(
        "On the same seconds, at their best amplitudes",
        ["manoeuvre", "beside this flight"],
        rows,
    )


def _numbered(instructions: Sequence[str]) -> str:
    """Return instructions as HTML: numbered steps, with the parts of each step below it."""

    def items(texts: Sequence[str]) -> str:
        return "".join(f"<li>{escape(entry)}</li>" for entry in texts)

    steps = [
        f"<li>{escape(step)}{f'<ul>{items(parts)}</ul>' if parts else ''}</li>"
        for step, parts in list_steps(instructions)
    ]
    return f"<ol>{''.join(steps)}</ol>"


def _show_expected(experiment: Experiment, thrusters: Sequence[str]) -> None:
    if experiment.expects.odds:
        rows = [
            (name, [words(size_of_odds(estimate.now)), words(size_of_odds(estimate.then))])
            for name, estimate in experiment.expects.odds.items()
        ]
        table(
            "Odds of each effect against the other, if it is the true one",
            ["effect", "now", "after the flight"],
            rows,
        )
    if experiment.expects.std:
        labels = label_parameters(experiment.expects.std, thrusters)
        rows = [
            (
                f"{label} ({unit(estimate.unit)})" if estimate.unit not in (None, "1") else label,
                [cell(estimate.now, f"{name}/now"), cell(estimate.then, f"{name}/then")],
            )
            for label, (name, estimate) in zip(labels, experiment.expects.std.items(), strict=True)
        ]
        table("Standard deviation of each value", ["value", "now", "after the flight"], rows)


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    await Flight(bench, place).show()
