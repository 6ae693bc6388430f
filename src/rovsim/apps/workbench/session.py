"""What each browser tab looks at: its campaign, and work that belongs to none. Tabs may differ."""

import asyncio
import gc
import os
import tempfile
import time
from pathlib import Path
from typing import Any, Iterator, Mapping

from rovsim.application.configuration import compose
from rovsim.application.settings import WorkbenchSettings
from rovsim.apps.workbench.folders import DESCRIPTION, remember, tell_unopenable
from rovsim.apps.workbench.work import LongWork, reap
from rovsim.core.errors import RovsimError
from rovsim.dynamics.catalogue import Catalogue

PRACTICE = Path("results/practice/raw")
MOST = 200  # tabs remembered: one that slept for days finds its campaign


class Session:
    """One tab: the settings with its campaign, and long work that belongs to none.

    `bench` is the open campaign; where another folder, as it was `typed`, could not be opened,
    `problem` says why, and the campaign stays. `proposal` of a folder that nobody has described.
    `pages` of the tab that are there: a reload is the next before the last is gone.
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
        """Of the campaign."""
        if self.bench is not None:
            return self.bench.data.campaign.name
        return "" if self.problem else Path(self.settings.campaign or "").name

    def choose(self, folder: str) -> None:
        """Open another campaign, or look into a folder that holds none."""
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
        if place.is_dir() and not (place / DESCRIPTION).exists():
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
            "Looking into the files", self._found, tasks.look_into, folder, Path(self.scratch.name)
        )

    def _begin(self, *work: Any) -> None:
        """See `LongWork.begin`; where other work goes on, that is the problem."""
        try:
            self.work.begin(*work)
        except RovsimError as error:
            self.problem = str(error)
            self._changes += 1

    def _found(self, proposal: Any) -> None:
        self.proposal = proposal

    def write(self, answers: Mapping[str, str]) -> None:
        """Write campaign.yaml into the folder that was looked into, and open it.

        Raises:
            BadInput: an answer is missing, or the file cannot be written.
        """
        from rovsim.intake.write import write_proposal

        write_proposal(self.proposal.fully(answers), self.described)
        self.scratch.cleanup()
        self.choose(str(self.described))

    def leave(self) -> None:
        """Forget what was looked into."""
        self.proposal = None
        self._changes += 1

    def practise(self) -> None:
        """Make the practice campaign, unless it is there, and open it."""
        from rovsim.apps.workbench import tasks

        if (PRACTICE / "campaign.yaml").exists():
            self.choose(str(PRACTICE))
            return
        self._begin(
            "Making a campaign",
            lambda path: self.choose(str(path)),
            tasks.practise,
            compose(["tank=practice"]).tank,
            PRACTICE,
        )

    @property
    def unread(self) -> bool:
        """Whether a campaign is chosen that nobody has tried to read yet."""
        return self.bench is None and bool(self.settings.campaign) and not self.problem

    async def opened(self) -> Any:
        """The open campaign, read now if need be; None when there is none, or it cannot be read."""
        while self.unread:
            if self._reading is None:
                self._reading = asyncio.create_task(self._read(self.settings))
            await asyncio.shield(self._reading)  # a screen that is left does not end it
        return self.bench

    async def _read(self, settings: WorkbenchSettings) -> None:
        """Read a campaign, unless another one is chosen meanwhile."""
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
        """Work of this tab alone, and on its campaign, which other tabs may look at as well."""
        yield self.work
        if self.bench is not None:
            yield self.bench.work

    @property
    def busy(self) -> bool:
        """Whether long work is going on."""
        return any(work.now for work in self.works)

    @property
    def changes(self) -> tuple[int, ...]:
        """Another one than before: the screen must be drawn again."""
        return (self._changes, id(self.bench), *(work.ended for work in self.works))

    def settle(self) -> None:
        """Look after long work: take in what came of it."""
        if not self.busy:
            reap()
        for work in list(self.works):
            if work.settle() == "failed" and work is self.work:
                self.problem = work.why


class Sessions:
    """The tabs by the names that they give themselves; a new one begins with what was opened last.

    The campaign of the settings is read for the first tab, not before: the browser could not load
    the page meanwhile. A campaign stays in memory while a tab shows it, while work on it goes on,
    or if it is the last.
    """

    def __init__(self, settings: WorkbenchSettings, catalogue: Catalogue) -> None:
        self._given = settings, catalogue
        self._by_tab: dict[str, Session] = {}

    @property
    def last(self) -> Session | None:
        """The one that has opened its campaign last."""
        sessions = [session for session in self._by_tab.values() if session.bench is not None]
        return max(sessions, key=lambda session: session.opened_at, default=None)

    def enter(self, tab: str) -> Session:
        """The session of a tab, one page more."""
        session = self._by_tab.pop(tab, None) or self._new()
        self._by_tab[tab] = session  # the newest comes last
        session.pages += 1
        self._forget()
        return session

    def _new(self) -> Session:
        """What a new tab looks at."""
        last = self.last
        if last is None:
            return Session(*self._given, None)
        session = Session(last.settings, last.catalogue, last.bench)
        session.opened_at = last.opened_at
        return session

    def leave(self, session: Session) -> None:
        """One page less."""
        session.pages -= 1

    def settle(self, session: Session) -> None:
        """Look after a tab's work, and after campaigns that no tab shows any more."""
        session.settle()
        last = self.last
        for other in self._by_tab.values():
            if not other.pages and not other.busy and other is not last:
                other.bench = None

    def _forget(self) -> None:
        closed = [t for t, s in self._by_tab.items() if not s.pages and s is not self.last]
        for tab in closed[: max(0, len(self._by_tab) - MOST)]:
            del self._by_tab[tab]


def _open(settings: WorkbenchSettings, catalogue: Catalogue) -> Any:
    """A campaign; what computes is imported here, while the page already says that it waits."""
    from rovsim.apps.workbench.workbench import Workbench

    return Workbench.opened(settings, catalogue)


def _keep_loaded() -> None:
    """Collect what the last campaign left; never look through what is loaded now, for 0.2 s."""
    if gc.get_freeze_count():
        gc.unfreeze()
        gc.collect()
    gc.freeze()
