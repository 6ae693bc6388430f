"""What all pages of the workbench share: the settings, the open campaign, long work."""

import asyncio
import gc
import tempfile
from pathlib import Path
from typing import Any, Mapping

from nicegui import ui

from rovsim.application.settings import WorkbenchSettings, compose
from rovsim.apps.workbench.folders import remember
from rovsim.apps.workbench.work import reap
from rovsim.core.errors import RovsimError
from rovsim.dynamics.catalogue import Catalogue

PRACTICE = Path("results/practice/raw")


class State:
    """The settings, the open campaign, and long work that belongs to none."""

    def __init__(self, settings: WorkbenchSettings, catalogue: Catalogue) -> None:
        self.settings, self.catalogue, self.problem = settings, catalogue, ""
        self.said = ""  # of the work that ended last
        self.trouble = ""  # why it failed, until somebody has read it
        self.bench: Any = None
        self.work: Any = None
        self.version = 0  # changes when the screens must be drawn again
        self.opening = asyncio.Lock()
        self.proposal: Any = None  # of a folder that nobody has described
        self.described = Path()
        self.scratch: Any = None

    def choose(self, folder: str) -> None:
        """Open another campaign, or look into a folder that holds none."""
        place = Path(folder).expanduser()
        self.proposal = None
        if folder and place.is_dir() and not (place / "campaign.yaml").exists():
            self._look_into(place)
            return
        self.settings = self.settings.model_copy(update={"campaign": folder, "diagnosis": None})
        self.bench, self.problem, self.said = None, "", ""
        self.version += 1

    def _look_into(self, folder: Path) -> None:
        from rovsim.apps.workbench import tasks
        from rovsim.apps.workbench.work import Work

        self.scratch = tempfile.TemporaryDirectory()
        self.problem, self.said, self.described = "", "", folder
        self.work = Work.start(
            "Looking into the files", self._found, tasks.look_into, folder, Path(self.scratch.name)
        )

    def _found(self, proposal: Any) -> None:
        self.proposal = proposal

    def write(self, answers: Mapping[str, str]) -> None:
        """Write campaign.yaml into the folder that was looked into, and open it."""
        from rovsim.application.intake.write import write_proposal

        try:
            write_proposal(self.proposal.fully(answers), self.described)
        except RovsimError as error:
            ui.notify(str(error), type="warning", multi_line=True)
            return
        self.scratch.cleanup()
        self.choose(str(self.described))

    def leave(self) -> None:
        """Forget what was looked into."""
        self.proposal = None
        self.version += 1

    def practise(self) -> None:
        """Make the practice campaign, unless it is there, and open it."""
        from rovsim.apps.workbench import tasks
        from rovsim.apps.workbench.work import Work

        if (PRACTICE / "campaign.yaml").exists():
            self.choose(str(PRACTICE))
            return
        self.work = Work.start(
            "Making a campaign",
            lambda path: self.choose(str(path)),
            tasks.practise,
            compose(["tank=practice"]).tank,
            PRACTICE,
        )

    async def opened(self) -> Any:
        """The open campaign, read now if need be; None when there is none, or it cannot be read."""
        async with self.opening:
            if self.bench is None and self.settings.campaign and not self.problem:
                from rovsim.apps.workbench.parts import in_thread
                from rovsim.apps.workbench.workbench import Workbench

                try:
                    self.bench = await in_thread(Workbench.opened, self.settings, self.catalogue)
                    remember(Path(self.settings.campaign))
                    _keep_loaded()
                except RovsimError as error:
                    self.problem = str(error)
        return self.bench

    def working(self) -> Any:
        """The long work that is going on or has just ended."""
        return self.work or getattr(self.bench, "work", None)

    def settle(self) -> None:
        """Look after long work: take in what came of it."""
        work = self.working()
        if work is None:
            reap()
        if work is None or work.look() == "running":
            return
        self.work = None
        if self.bench is not None:
            self.bench.work = None
        if work.state == "done":
            work.after(work.said)
        elif work.state == "failed":
            self.problem = work.said if self.bench is None else ""
            self.trouble = f"{work.title}: {work.said}"
        self.version += 1
        self.said = {
            "done": f"{work.title}: done in {work.elapsed:.0f} s.",
            "failed": "",
            "cancelled": f"{work.title}: cancelled, nothing was changed.",
        }[work.state]


def _keep_loaded() -> None:
    """Collect what the last campaign left; never look through what is loaded now, for 0.2 s."""
    if gc.get_freeze_count():
        gc.unfreeze()
        gc.collect()
    gc.freeze()
