"""Open, where nobody has described the recordings: what is in them, and what has to be asked."""

from typing import Callable, Mapping

from nicegui import ui

from rovsim.application.intake.proposal import Proposal, Question
from rovsim.apps.workbench.parts import Failure, heading, section, text
from rovsim.core.errors import RovsimError

TITLE, QUESTION = "New campaign", "What is in these recordings?"
TOPICS = {
    "vehicle": "Vehicle",
    "mocap.body": "Body",
    "mocap.world_axes": "Axes of the world",
    "mocap.body_axes": "Axes of the rigid body",
    "runs": "Runs",
    "commands.kind": "Kind of commands",
    "commands.columns": "Columns of commands",
}


def show(
    proposal: Proposal,
    folder: str,
    write: Callable[[Mapping[str, str]], None],
    leave: Callable[[], None],
) -> None:
    """Show the screen; `write` takes answers by place, `leave` goes back to other folders."""
    heading(TITLE, QUESTION)
    text(f"{folder} holds no campaign.yaml. This is what stands in its files.")
    with ui.column().classes("effects found"):
        for line in proposal.found:
            text(line)
    for check in proposal.checks:
        text(check, "warning")
    _guesses(proposal)
    answers: dict[str, Callable[[], str]] = {}
    if proposal.questions:
        section("What no file tells")
        for question in proposal.questions:
            answers[question.place] = _field(question)

    def answered() -> None:
        try:
            write({place: value() for place, value in answers.items()})
        except RovsimError as error:
            failure.tell(error)

    with ui.row().classes("controls"):
        ui.button("Write campaign.yaml and open it", on_click=answered).props("unelevated no-caps")
        ui.button("Another folder", on_click=leave).props("flat no-caps")
    failure = Failure()


def _guesses(proposal: Proposal) -> None:
    """What was taken for a reason that may be wrong."""
    told = {
        (place.partition(".")[0] if place.startswith("runs.") else place, line)
        for place, lines in proposal.comments.items()
        for line in lines
        if line.startswith("guess: ")
    }
    if not told:
        return
    section("Taken, and why")
    with ui.column().classes("effects"):
        for place, line in sorted(told):
            reason = line.removeprefix("guess: ")
            text(f"{TOPICS.get(place, place)}: {_value(proposal, place)}{reason}")


def _value(proposal: Proposal, place: str) -> str:
    value = proposal.content
    for part in place.split("."):
        value = value[part]
    shown = ", ".join(value) if isinstance(value, list) and isinstance(value[0], str) else value
    return f"{shown}; " if isinstance(shown, str) else ""


def _field(question: Question) -> Callable[[], str]:
    """A field with the question above it; returns what tells its value."""
    label = TOPICS.get(question.place, question.place)
    text(question.asks)
    if question.free:
        entry = ui.input(label, autocomplete=[value for value, _ in question.answers])
        entry.props("outlined dense").classes("control wide")
        with ui.row().classes("bins"):
            for value, _ in question.answers:
                ui.button(value, on_click=lambda _, v=value: entry.set_value(v)).props(
                    "flat dense no-caps"
                )
        return lambda: entry.value or ""
    choices = {v: f"{v}: {meaning}" if meaning else v for v, meaning in question.answers}
    choice = ui.select(choices, label=label).props("outlined dense").classes("control wide")
    return lambda: choice.value or ""
