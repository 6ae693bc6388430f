"""The screen for recordings without campaign.yaml: what is in them, and questions about them."""

from pathlib import Path
from typing import Callable, Mapping, Sequence

from nicegui import ui

from rovsim.apps.workbench.folders import CAMPAIGN_FILE, shown
from rovsim.apps.workbench.parts import Failure, heading, section, text
from rovsim.core.errors import RovsimError
from rovsim.intake.guesses import list_guesses
from rovsim.intake.proposal import CampaignProposal, OpenQuestion
from rovsim.reporting.wording import listed

TITLE, QUESTION = "New campaign", "What is in these recordings?"
TOPIC_TITLES = {
    "vehicle": "Vehicle",
    "mocap.body": "Body",
    "mocap.world_axes": "Axes of the world",
    "mocap.body_axes": "Axes of the rigid body",
    "mocap.velocity": "Velocities",
    "runs": "Runs",
    "commands.kind": "Kind of commands",
    "commands.columns": "Columns of commands",
}


def show(
    proposal: CampaignProposal,
    folder: Path,
    write: Callable[[Mapping[str, str]], None],
    leave: Callable[[], None],
) -> None:
    """Show the screen.

    Args:
        proposal: of a campaign.yaml, with the questions that no file answers.
        folder: of the recordings, an absolute path.
        write: called with the answers by place in campaign.yaml, once all are given.
        leave: called to go back to the choice of folders.
    """
    heading(TITLE, QUESTION)
    text(f"{shown(folder)} holds no campaign.yaml. This is what stands in its files.")
    with ui.column().classes("effects found"):
        for line in proposal.findings:
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
        texts = {place: value() for place, value in answers.items()}
        open_still = tell_unanswered(proposal.questions, texts)
        if open_still:
            failure.tell(open_still)
            return
        try:
            write(texts)
        except RovsimError as error:
            failure.tell(error)

    text(f"It is written as `{shown(folder / CAMPAIGN_FILE)}`, and can be edited later.", "soft")
    with ui.row().classes("controls"):
        ui.button("Write campaign.yaml and open it", on_click=answered).props("unelevated no-caps")
        ui.button("Another folder", on_click=leave).props("flat no-caps")
    failure = Failure()


def _guesses(proposal: CampaignProposal) -> None:
    """Show the guesses of the proposal, each with its reason."""
    guesses = list_guesses(proposal, TOPIC_TITLES)
    if not guesses:
        return
    section("Taken, and why")
    with ui.column().classes("effects"):
        for line in guesses:
            text(line)


def tell_unanswered(questions: Sequence[OpenQuestion], answers: Mapping[str, str]) -> str:
    """Say which questions have no answer yet, by the labels of their fields; empty if all have.

    Args:
        questions: of a proposal.
        answers: by place in campaign.yaml.
    """
    unanswered = [q.place for q in questions if not answers.get(q.place, "").strip()]
    names = listed([TOPIC_TITLES.get(place, place) for place in unanswered])
    return f"No answer yet: {names}. Answer every question; no file does." if unanswered else ""


def _field(question: OpenQuestion) -> Callable[[], str]:
    """Show a question and a field for its answer; returns a function that reads the answer."""
    label = TOPIC_TITLES.get(question.place, question.place)
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
