"""The page of the workbench: header, navigation, progress of long work, and one screen."""

import logging
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, Callable

from nicegui import PageArguments, ui
from nicegui import app as server
from nicegui.page_arguments import RouteMatch
from starlette.middleware.trustedhost import TrustedHostMiddleware

from rovsim.application.settings import WorkbenchSettings
from rovsim.apps.workbench import HOST
from rovsim.apps.workbench.gate import Gate
from rovsim.apps.workbench.parts import Failure, heading
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.session import Session, Sessions
from rovsim.apps.workbench.work import LongWork
from rovsim.core.collector import give_back_memory
from rovsim.core.errors import RovsimError
from rovsim.dynamics.catalogue import Catalogue

SCREENS = ("compare", "where", "why", "add", "ladder", "models", "flight", "data")
STYLE_FILE, CHARTS_FILE = (Path(__file__).with_name(name) for name in ("style.css", "charts.js"))
ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32"><path fill="none" '
    'stroke="#0072B2" stroke-width="4" d="M2 21c5-14 9-14 14 0s9 14 14 0"/></svg>'
)
# Light or dark as the system is, until the user changes it; the browser then remembers that.
SWITCH_SHADE = """() => {
  const dark = !document.body.classList.contains("body--dark");
  localStorage.setItem("dark", dark);
  setDark(dark);
}"""
RECALL_SHADE = """
  const kept = localStorage.getItem("dark");
  if (kept !== null) setDark(kept === "true");
"""
LOOK_INTERVAL_S = 0.25  # between two looks at long work
TIDY_INTERVAL_S = 60.0  # between two times that memory is given back


class Screens(ui.sub_pages):
    """The screens by their addresses, and a message with a link for any other address."""

    def _render_page(self, match: RouteMatch) -> bool:
        """Render a screen; none where the address continues after that of the screen."""
        return not match.remaining_path and super()._render_page(match)

    def _render_404(self) -> None:
        heading("No such screen", "The address is wrong, or of another version.")
        ui.link("Compare", "/compare")


class Page:
    """The page in one browser tab."""

    def __init__(self, sessions: Sessions) -> None:
        self.sessions = sessions
        self.session: Session | None = None  # of the tab, once the browser has told the tab's id
        self.seen: tuple[int, ...] = ()
        self.heard: dict[LongWork, int] = {}  # how often each had ended when the page was drawn
        self.name = ""  # of the screen that is shown; empty while a campaign is being chosen
        self.kept: dict[str, dict[str, Any]] = {}  # the choices on each screen of this tab
        self.links: dict[str, ui.link] = {}

    def build(self) -> None:
        """Build the header, the line that shows progress, and the screen."""
        ui.add_head_html(f"<style>{STYLE_FILE.read_text(encoding='utf-8')}</style>")
        ui.add_head_html(f"<script>{CHARTS_FILE.read_text(encoding='utf-8')}</script>")
        ui.colors(primary="#0072B2")
        ui.query("html").props('lang="en"')
        with ui.element("header"):
            with ui.row().classes("brand"):
                ui.link("rovsim", "/open").classes("logo").props('title="Open another campaign"')
                self.campaign = ui.label().classes("campaign")
            with ui.element("nav").props('aria-label="Screens"'):
                for k, name in enumerate((*SCREENS, "gallery"), 1):
                    title = "Effects" if name == "gallery" else name.capitalize()
                    link = ui.link(title, f"/{name}").props(f'accesskey="{k}" title="key {k}"')
                    self.links[name] = link
            shade = ui.button(icon="contrast").classes("shade").on("click", js_handler=SWITCH_SHADE)
            shade.props('flat round dense aria-label="Light or dark" title="Light or dark"')
        self._progress()
        with ui.element("div").classes("screen"):
            routes: dict[str, Callable] = {f"/{n}": partial(self._screen, n) for n in self.links}
            routes |= {"/": partial(self._screen, "compare"), "/open": self._open}
            routes["/gallery/{effect}"] = self._effect
            self.pages = Screens(routes)
        ui.keyboard(on_key=self._key)
        ui.timer(LOOK_INTERVAL_S, self._look)
        ui.run_javascript(RECALL_SHADE)

    async def _enter(self) -> Session:
        """Return the session of this tab, once the tab is connected."""
        if self.session is None:
            client = ui.context.client
            await client.connected()
            if self.session is None:
                self.session = self.sessions.enter(str(client.tab_id))
                client.on_delete(partial(self.sessions.leave, self.session))
                self._note(self.session)
        return self.session

    def _progress(self) -> None:
        with ui.row().classes("progress").props('role="status" aria-live="polite"') as self.strip:
            self.what = ui.label()
            self.bar = ui.linear_progress(show_value=False).props('aria-label="Progress"')
            self.left = ui.label().classes("soft")
            ui.button("Cancel", on_click=self._cancel).props("flat dense no-caps")
        self.strip.visible = False
        with ui.row().classes("progress warning").props('role="alert"') as self.trouble:
            self.failed = ui.label().classes("text")
            ui.button("Close", on_click=self._read).props("flat dense no-caps")
        self.trouble.visible = False

    def _cancel(self) -> None:
        for work in self.session.works if self.session else ():
            if work.now:
                work.now.cancel()

    def _read(self) -> None:
        for work in self.session.works if self.session else ():
            work.trouble = ""

    def _look(self) -> None:
        """Show the progress of long work; draw the screen again when something has changed."""
        session = self.session
        if session is None:
            return
        self.sessions.settle(session)
        work = next((w.now for w in session.works if w.now), None)
        self.strip.visible = work is not None
        self.failed.text = next((w.trouble for w in session.works if w.trouble), "")
        self.trouble.visible = bool(self.failed.text)
        if work is not None:
            self.what.text = f"{work.title}: {work.what.partition(': ')[2] or work.what}"
            self.bar.value = work.share or 0.0
            remaining = "" if work.left is None else f", about {work.left:.0f} s left"
            self.left.text = f"{work.elapsed:.0f} s{remaining}"
        if self.seen != session.changes:
            self._tell(session)
            self._note(session)
            if self.name or session.proposal is not None or session.problem:
                self.pages.refresh()
            else:
                ui.navigate.to("/compare")

    def _tell(self, session: Session) -> None:
        """Notify the user of long work that has ended since the screen was drawn."""
        for work in session.works:
            if work.message and work.ended > self.heard.get(work, work.ended):
                ui.notify(work.message, color="dark", position="bottom-right", multi_line=True)

    def _note(self, session: Session) -> None:
        """Remember the state that the page is drawn in, to notice later changes."""
        self.seen, self.campaign.text = session.changes, session.name
        self.heard = {work: work.ended for work in session.works}

    def _key(self, event: Any) -> None:
        """Change the screen when a digit is pressed."""
        names = list(self.links)
        number = event.key.number or 0
        if event.action.keydown and not event.modifiers.alt and 1 <= number <= len(names):
            ui.navigate.to(f"/{names[number - 1]}")

    def _active(self, name: str) -> None:
        self.name = name
        for key, link in self.links.items():
            link.classes(add="active") if key == name else link.classes(remove="active")

    async def _screen(self, name: str, asked: PageArguments) -> None:
        """Show a screen, once the campaign is read."""
        self._active(name)
        bench = await self._opened(await self._enter())
        if bench is None:
            return
        with ui.element("div").classes("sheet"):  # removed together with the screen
            try:
                await _module(name).show(bench, Place(name, asked.query_parameters, self.kept))
            except RovsimError as error:
                Failure().tell(error)

    async def _opened(self, session: Session) -> Any:
        """Return the open campaign (a Workbench), which is read now if it was not yet.

        None where that fails; the page then offers other campaigns.
        """
        unread = session.unread
        if unread:
            waiting = ui.label(f"Reading the recordings of {session.name} …").classes("waiting")
        bench = await session.opened()
        if unread:
            waiting.delete()
        self._note(session)
        if bench is None:
            self._choose(session)
        elif unread and session.problem:  # the one before is open still
            ui.navigate.to("/open")
            return None
        return bench

    async def _effect(self, effect: str) -> None:
        self._active("gallery")
        if (bench := await self._opened(await self._enter())) is not None:
            await _module("gallery").entry(bench, effect)

    async def _open(self) -> None:
        self._active("")
        self._choose(await self._enter())

    def _choose(self, session: Session) -> None:
        from rovsim.apps.workbench import campaigns, new_campaign

        if session.proposal is not None:
            new_campaign.show(session.proposal, session.described, session.write, session.leave)
            return
        session.work.trouble = ""  # of looking into a folder: said here
        typed = session.typed if session.problem else ""
        campaigns.show(session.choose, session.practise, session.problem, typed)


def _module(name: str) -> ModuleType:
    """Import the module of a screen; only when first shown, so that the page opens at once."""
    import importlib

    return importlib.import_module(f"rovsim.apps.workbench.{name}")


def was_answered(record: logging.LogRecord) -> bool:
    """Whether a log record is worth showing: a filter of the server's log.

    It is not where a page was closed during a request: Starlette's middleware then has no response
    to pass on, and logs a long traceback.
    """
    error = record.exc_info[1] if record.exc_info else None
    return not (isinstance(error, RuntimeError) and str(error) == "No response returned.")


def serve(settings: WorkbenchSettings, catalogue: Catalogue) -> None:
    """Serve the workbench on loopback until interrupted."""
    sessions = Sessions(settings, catalogue)
    server.timer(TIDY_INTERVAL_S, give_back_memory, immediate=False)
    logging.getLogger("uvicorn.error").addFilter(was_answered)
    server.add_middleware(Gate)
    server.add_middleware(TrustedHostMiddleware, allowed_hosts=[HOST, "localhost"])

    ui.run(
        lambda: Page(sessions).build(),
        host=HOST,
        port=settings.port,
        show=settings.open,
        reload=False,
        title="rovsim",
        favicon=ICON,
        tailwind=False,
        show_welcome_message=False,
        reconnect_timeout=10.0,
        dark=None,
        ws_per_message_deflate=False,  # within one machine packing takes longer than sending
    )
