"""A workbench in a process of its own, and tabs of a real Chromium that look at it."""

import os
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Iterator
from urllib.request import urlopen

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FLAGS = (
    "--no-sandbox",
    "--disable-background-networking",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",  # three dimensions without a GPU
    "--disable-gpu-compositing",  # all else straight into memory: a third of the browser's time
)
SLOW_DRAWING = "GL Driver Message (OpenGL, Performance"  # of these flags: no user has them
DESK, PHONE = (1280, 720), (390, 844)
PICTURES = os.environ.get("ROVSIM_SCREENSHOTS")  # a folder: `make screenshots`
DARK = "document.body.classList.contains('body--dark')"
HOME = "/home/you"
# A folder, and the one that it is in, in all texts, and where a way leads through folders.
CALL_HOME = """([folder, home]) => {
  const around = folder.replace(/\\/[^/]*$/, '');
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) texts.currentNode.data =
    texts.currentNode.data.replaceAll(folder, home).replaceAll(around, home);
  const known = folder.split('/').length, called = home.split('/').slice(1);
  const way = [...document.querySelectorAll('.way button')].slice(1, known);
  way.splice(called.length).forEach(button => button.remove());
  way.forEach((button, k) => { button.querySelector('.block').innerText = called[k]; });
}"""
LOG = "workbench.log"  # what it says on the way: no traceback, if all is well


def installed() -> str | None:
    """Path of a Chromium on this machine; None: only Playwright's own, if any."""
    return next((path for name in NAMES if (path := shutil.which(name))), None)


def free_port() -> int:
    """A port that nobody listens to."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def started(folder: Path, *words: str) -> tuple[subprocess.Popen, str]:
    """The workbench, started in a folder, and its address, once it answers."""
    port = free_port()
    command = [sys.executable, "-m", "rovsim", "ui", "open=false", f"port={port}", *words]
    # NiceGUI behaves differently where it sees that pytest runs
    clean = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST_")}
    clean |= {"XDG_STATE_HOME": str(folder / ".state")}  # not what this user opened
    with (folder / LOG).open("a") as log:
        process = subprocess.Popen(
            command, cwd=folder, stdout=subprocess.DEVNULL, stderr=log, env=clean
        )
    address = f"http://127.0.0.1:{port}"
    for _ in range(600):
        try:
            urlopen(address, timeout=5).close()
            return process, address
        except OSError:  # refused, or too busy to answer in time
            assert process.poll() is None, "the workbench ended"
            time.sleep(0.05)
    raise AssertionError("the workbench does not answer")


class Tab:
    """A browser tab that remembers what went wrong, and what it asked of other machines."""

    def __init__(self, page, address: str) -> None:
        self.page, self.address, self.complaints = page, address, []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("requestfailed", self._failed)
        page.on("request", self._request)
        page.on("response", self._response)

    def _failed(self, request) -> None:
        """A page that is left while a part of it still loads has not failed."""
        if request.failure != "net::ERR_ABORTED":
            self.complaints.append(f"failed: {request.url}")

    def _console(self, message) -> None:
        if SLOW_DRAWING not in message.text and message.type in ("error", "warning"):
            self.complaints.append(message.text)

    def _response(self, response) -> None:
        if response.status >= 400:
            self.complaints.append(f"{response.status} {response.url}")

    def _request(self, request) -> None:
        if not request.url.startswith((self.address, "data:", "blob:")):
            self.complaints.append(f"asks {request.url}")

    def go(self, screen: str) -> None:
        """Open a screen, and wait until it is there."""
        self.page.goto(f"{self.address}/{screen}")
        self.page.wait_for_selector("h1")

    def numbers(self, prefix: str = "") -> dict[str, float]:
        """Every number shown, at full precision, by name."""
        pairs = self.page.eval_on_selector_all(
            "[data-name][data-value]", "all => all.map(e => [e.dataset.name, e.dataset.value])"
        )
        return {name: float(value) for name, value in pairs if name.startswith(prefix)}

    def schemes(self) -> Iterator[str]:
        """Light, then dark, each once the page shows it."""
        for scheme in ("light", "dark"):
            self.page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
            self.page.wait_for_function(f"{DARK} === {str(scheme == 'dark').lower()}")
            yield scheme

    def violations(self) -> list[str]:
        """What axe-core finds to complain about, and in which element."""
        from axe_playwright_python.sync_playwright import Axe

        found = Axe().run(self.page).response["violations"]
        return [f"{one['id']}, {one['nodes'][0]['html'][:120]}" for one in found]

    def picture(self, name: str, height: int = 0, home: Path | None = None) -> None:
        """A screenshot for the docs, where they were asked for.

        `height` of the window in px, where it needs another; `home`: a folder that it calls HOME,
        because readers have no folder of tests.
        """
        if not PICTURES:
            return
        size = self.page.viewport_size
        if height:
            self.page.set_viewport_size({**size, "height": height})
        self.page.wait_for_timeout(800)
        self.page.mouse.move(0, 0)
        self.page.locator(".q-notification").first.wait_for(state="hidden")
        if home:
            self.page.evaluate(CALL_HOME, [str(home), HOME])
        self.page.screenshot(path=str(Path(PICTURES) / f"{name}.png"))
        self.page.set_viewport_size(size)
