"""Sessions: the campaign of each browser tab, and its long work. Tabs may show different ones."""

import asyncio
import gc
import os
import tempfile
import time
from pathlib import Path
from typing import Any, Iterator, Mapping

from rovsim.application.configuration import compose
from rovsim.application.settings import WorkbenchSettings
from rovsim.apps.workbench.folders import CAMPAIGN_FILE, remember, tell_unopenable
from rovsim.apps.workbench.work import LongWork, reap
from rovsim.core.errors import RovsimError
from rovsim.dynamics.catalogue import Catalogue

PRACTICE_FOLDER = Path("results/practice/raw")
MAX_KEPT_TABS = 200  # tabs remembered: one that slept for days finds its campaign


class Session:
    """One browser tab.

    Attributes:
        settings: with the folder of the campaign.
        catalogue: all effects that are known.
        bench: the open campaign (a Workbench); None before it is read.
        problem: why the last folder could not be opened; the campaign then stays. Empty if it was.
        typed: that folder, as it was typed.
        opened_at: when the campaign was opened, s of the monotonic clock.
        proposal: of a campaign.yaml for a folder without one; None unless one is shown.
        described: that folder.
        scratch: temporary folder with copies of recordings for the proposal.
        work: long work that belongs to no campaign.
        pages: number of pages of this tab; during a reload the new one is there before the old
            one is gone.
    """

    def __init__(self, settings: WorkbenchSettings, catalogue: Catalogue, bench: Any) -> None:
        self.settings, self.catalogue, self.bench = settings, catalogue, bench
        self.problem, self.typed, self.opened_at = "", settings.campaign or "", 0.0
        self.proposal: Any = None
        self.described = Path()
        self.scratch: Any = None
        self.work, self.pages, self._changes = LongWork(), 0, 0
        self._reading: asyncio.Task[None] | None = None
        self._before: tuple[WorkbenchSettings, Any] | None = None  # while another one is read

    @property
    def name(self) -> str:
        """Name of the campaign; empty where there is none."""
        if self.bench is not None:
            return self.bench.data.campaign.name
        return "" if self.problem else Path(self.settings.campaign or "").name

    def choose(self, folder: str) -> None:
        """Open another campaign, or start to propose one for a folder of recordings."""
        place = Path(os.path.expanduser(folder))
        self.proposal, self.typed = None, folder
        if not folder:
            self.problem = "Type a folder first, or choose one below."
            self._changes += 1
            return
        if problem := tell_unopenable(place):
            self.problem = problem
            self._changes += 1
            return
        if place.is_dir() and not (place / CAMPAIGN_FILE).exists():
            self._look_into(place.absolute())
            return
        if self.bench is not None:
            self._before = (self.settings, self.bench)
        self.settings = self.settings.model_copy(update={"campaign": folder, "diagnosis": None})
        self.bench, self.problem = None, ""
        self._changes += 1

    def _look_into(self, folder: Path) -> None:
        from rovsim.apps.workbench import tasks

        self.scratch = tempfile.TemporaryDirectory()
        self.problem, self.described = "", folder
        self._begin(
            "Looking into the files",
            self._keep_proposal,
            tasks.look_into,
            folder,
            Path(self.scratch.name),
        )

    def _begin(self, *work: Any) -> None:
        """Start long work, see `LongWork.begin`; while other work runs, set `problem` instead."""
        try:
            self.work.begin(*work)
        except RovsimError as error:
            self.problem = str(error)
            self._changes += 1

    def _keep_proposal(self, proposal: Any) -> None:
        self.proposal = proposal

    def write(self, answers: Mapping[str, str]) -> None:
        """Write the proposed campaign.yaml into its folder, and open it.

        Args:
            answers: to the questions of the proposal, by place in campaign.yaml.

        Raises:
            BadInput: an answer is missing, or the file cannot be written.
        """
        from rovsim.intake.write import write_proposal

        write_proposal(self.proposal.fully(answers), self.described)
        self.scratch.cleanup()
        self.choose(str(self.described))

    def leave(self) -> None:
        """Drop the proposal."""
        self.proposal = None
        self._changes += 1

    def practise(self) -> None:
        """Open the practice campaign; start to make it where it does not exist."""
        from rovsim.apps.workbench import tasks

        if (PRACTICE_FOLDER / "campaign.yaml").exists():
            self.choose(str(PRACTICE_FOLDER))
            return
        self._begin(
            "Making a campaign",
            lambda path: self.choose(str(path)),
            tasks.practise,
            compose(["tank=practice"]).tank,
            PRACTICE_FOLDER,
        )

    @property
    def unread(self) -> bool:
        """Whether a campaign is chosen and no attempt was made to read it."""
        return self.bench is None and bool(self.settings.campaign) and not self.problem

    async def opened(self) -> Any:
        """Return the open campaign, which is read now if it was not; None where that fails."""
        while self.unread:
            if self._reading is None:
                self._reading = asyncio.create_task(self._read(self.settings))
            await asyncio.shield(self._reading)  # a screen that is left does not end it
        return self.bench

    async def _read(self, settings: WorkbenchSettings) -> None:
        """Read a campaign and open it, unless another one was chosen meanwhile."""
        from rovsim.apps.workbench.parts import in_thread

        bench, problem = None, ""
        try:
            bench = await in_thread(_open, settings, self.catalogue)
        except RovsimError as error:
            problem = str(error)
        finally:
            self._reading = None
        if settings is not self.settings:
            return
        self.bench, self.problem = bench, problem
        before, self._before = self._before, None
        if problem and before is not None:
            self.settings, self.bench = before
        if bench is not None:
            self.opened_at = time.monotonic()
            remember(Path(settings.campaign or ""))
            _keep_loaded()

    @property
    def works(self) -> Iterator[LongWork]:
        """Long work of this tab, and long work on its campaign, which tabs may share."""
        yield self.work
        if self.bench is not None:
            yield self.bench.work

    @property
    def busy(self) -> bool:
        """Whether long work is running."""
        return any(work.now for work in self.works)

    @property
    def changes(self) -> tuple[int, ...]:
        """A value that differs from the one before when the screen must be drawn again."""
        return (self._changes, id(self.bench), *(work.ended for work in self.works))

    def settle(self) -> None:
        """Load the results of long work that has ended."""
        if not self.busy:
            reap()
        for work in list(self.works):
            if work.settle() == "failed" and work is self.work:
                self.problem = work.why


class Sessions:
    """The sessions of all tabs, by the id of the tab; a new one begins with the latest campaign.

    The campaign of the settings is read when the first tab is open, since the browser could not
    load the page meanwhile. A campaign stays in memory while a tab shows it, while work on it
    runs, or if it was opened last.
    """

    def __init__(self, settings: WorkbenchSettings, catalogue: Catalogue) -> None:
        self._given = settings, catalogue
        self._by_tab: dict[str, Session] = {}

    @property
    def last(self) -> Session | None:
        """The session whose campaign was opened last; None where no campaign is open."""
        sessions = [session for session in self._by_tab.values() if session.bench is not None]
        return max(sessions, key=lambda session: session.opened_at, default=None)

    def enter(self, tab: str) -> Session:
        """Return the session of a tab that has opened a page."""
        session = self._by_tab.pop(tab, None) or self._new()
        self._by_tab[tab] = session  # the newest comes last
        session.pages += 1
        self._forget()
        return session

    def _new(self) -> Session:
        """Make a session for a new tab, with the campaign that was opened last."""
        last = self.last
        if last is None:
            return Session(*self._given, None)
        session = Session(last.settings, last.catalogue, last.bench)
        session.opened_at = last.opened_at
        return session

    def leave(self, session: Session) -> None:
        """Note that a page of a session was closed."""
        session.pages -= 1

    def settle(self, session: Session) -> None:
        """Load the results of a tab's work, and drop campaigns that no tab shows any more."""
        session.settle()
        last = self.last
        for other in self._by_tab.values():
            if not other.pages and not other.busy and other is not last:
                other.bench = None

    def _forget(self) -> None:
        closed = [t for t, s in self._by_tab.items() if not s.pages and s is not self.last]
        for tab in closed[: max(0, len(self._by_tab) - MAX_KEPT_TABS)]:
            del self._by_tab[tab]


def _open(settings: WorkbenchSettings, catalogue: Catalogue) -> Any:
    """Read a campaign; the modules for it are imported here, when the page is already shown."""
    from rovsim.apps.workbench.workbench import Workbench

    return Workbench.opened(settings, catalogue)


def _keep_loaded() -> None:
    """Free the memory of the last campaign, and exempt all that is loaded from later collections.

    A collection would go through all of it, which takes 0.2 s.
    """
    if gc.get_freeze_count():
        gc.unfreeze()
        gc.collect()
    gc.freeze()
