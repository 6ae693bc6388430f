"""Open: another campaign, or one to practise on."""

from pathlib import Path
from typing import Callable

from nicegui import ui

from rovsim.apps.workbench.parts import heading, section, text

TITLE, QUESTION = "Open", "Which campaign do you want to look at?"
PLACES = ("campaigns/*/campaign.yaml", "results/*/raw/campaign.yaml", "*/campaign.yaml")


def known() -> list[Path]:
    """Folders of campaigns near here."""
    found = {path.parent for place in PLACES for path in Path().glob(place)}
    return sorted(found)


def show(
    choose: Callable[[str], None], practise: Callable[[], None], problem: str = "", typed: str = ""
) -> None:
    """Show the screen; `choose` opens a folder, `practise` makes a campaign and opens it.

    `typed` is the folder that could not be opened, for `problem`.
    """
    heading(TITLE, QUESTION)
    if problem:
        text(problem, "warning")
    with ui.row().classes("controls"):
        folder = ui.input("Folder of a campaign, or of recordings", value=typed).classes(
            "control wide"
        )
        folder.props("outlined dense")
        folder.on("keydown.enter", lambda: choose(folder.value.strip()))
        ui.button("Open", on_click=lambda: choose(folder.value.strip())).props("unelevated no-caps")
    text(
        "A folder without campaign.yaml is looked into: exports, bags, logs of commands. You are "
        "shown what is in them, and asked what no file tells.",
        "soft",
    )
    if found := known():
        section("Campaigns in this folder")
        with ui.column().classes("effects"):
            for path in found:
                ui.button(str(path), on_click=lambda _, p=path: choose(str(p))).props(
                    "flat no-caps align=left"
                )
    section("No recordings at hand?")
    text(
        "A synthetic tank hides something from the model, as a real one would. Find out what it "
        "is: it takes a few minutes, and you will have used every screen."
    )
    ui.button("Practise on a campaign", icon="school", on_click=practise).props(
        "unelevated no-caps"
    ).classes("onward")
