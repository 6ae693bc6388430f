"""The screen Open: choose another campaign, or make one to practise on."""

from pathlib import Path
from typing import Callable

from nicegui import ui

from rovsim.apps.workbench.folders import Inside, Listing, list_recent, look, shown
from rovsim.apps.workbench.parts import Failure, heading, section, text

TITLE, QUESTION = "Open", "Which campaign do you want to look at?"
CAMPAIGN_PATTERNS = ("campaigns/*/campaign.yaml", "results/*/raw/campaign.yaml", "*/campaign.yaml")


def list_campaigns() -> list[Path]:
    """List the folders of campaigns at the usual places below the working directory."""
    folders = {path.parent for place in CAMPAIGN_PATTERNS for path in Path().glob(place)}
    return sorted(folders)


def _list(title: str, paths: list[Path], choose: Callable[[str], None]) -> None:
    if not paths:
        return
    section(title)
    with ui.column().classes("effects"):
        for path in paths:
            _button(shown(path), lambda _, p=path: choose(str(p)))


def _button(words: str, clicked: Callable[..., None], icon: str | None = None) -> ui.button:
    return ui.button(words, icon=icon, on_click=clicked).props("flat no-caps align=left")


class Browser:
    """A list of folders to walk through; one that holds a campaign is opened with `choose`."""

    def __init__(self, folder: Path, choose: Callable[[str], None]) -> None:
        self.folder, self.choose = folder, choose
        self.listing: Listing | None = None

    def show(self) -> None:
        """Draw the way to the folder, and the folders inside it."""
        self.top = ui.column()
        self.area = ui.column().classes("effects folders")
        self._go(self.folder)

    def _go(self, folder: Path) -> None:
        listing = look(folder)
        self.top.clear()
        with self.top:
            with ui.row().classes("bins way"):
                for path in (*listing.parents, listing.folder):
                    name = shown(path) if path == path.parent else shown(Path(path.name))
                    _button(name, lambda _, p=path: self._go(p))
            # another field for each folder: one that is emptied may take back what is typed already
            part = ui.input(
                "Only names with",
                on_change=lambda typed: self._list(look(listing.folder, typed.value or "")),
            )
            part.classes("control").props("outlined dense clearable")
        self._list(listing)

    def _list(self, listing: Listing) -> None:
        if listing == self.listing:  # nothing is redrawn under the mouse
            return
        self.listing = listing
        self.area.clear()
        with self.area:
            if listing.problem:
                text(f"This folder cannot be read: {listing.problem}.", "warning")
            for entry in listing.inside:
                self._entry(entry)
            if listing.more:
                text(f"{listing.more} more are not listed: type a part of the name.", "soft")
            if listing.campaign or listing.files:
                files = "1 file" if listing.files == 1 else f"{listing.files} files"
                contents = "the campaign" if listing.campaign else files
                _button(f"Open this folder ({contents})", lambda: self.choose(str(listing.folder)))

    def _entry(self, one: Inside) -> None:
        name = shown(Path(one.path.name))
        if one.campaign:
            button = _button(f"{name} (campaign)", lambda: self.choose(str(one.path)), "route")
        else:
            button = _button(name, lambda: self._go(one.path), "folder")
        button.classes("entry")


def show(
    choose: Callable[[str], None], practise: Callable[[], None], problem: str = "", typed: str = ""
) -> None:
    """Show the screen.

    Args:
        choose: opens a folder.
        practise: makes a synthetic campaign and opens it.
        problem: why the last folder could not be opened; empty if it could.
        typed: that folder, as it was typed.
    """
    heading(TITLE, QUESTION)
    failure = Failure()
    if problem:
        failure.tell(problem)
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
    _list("Opened last", list_recent(), choose)
    _list("Campaigns in this folder", list_campaigns(), choose)
    section("Look for a folder")
    Browser(Path(typed or "."), choose).show()
    section("No recordings at hand?")
    text(
        "A synthetic tank hides something from the model, as a real one would. Find out what it "
        "is: it takes a few minutes, and you will have used every screen."
    )
    ui.button("Practise on a campaign", icon="school", on_click=practise).props(
        "unelevated no-caps"
    ).classes("onward")
