"""The workbench in a process of its own, and a real Chromium that looks at it."""

import os
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

import pytest

from rovsim.cli import main

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FLAGS = ("--no-sandbox", "--disable-gpu", "--disable-background-networking")
DESK, PHONE = (1280, 720), (390, 844)
PICTURES = os.environ.get("ROVSIM_SCREENSHOTS")  # a folder: `make screenshots`


@pytest.fixture(scope="session")
def chromium():
    """A running Chromium; the test is skipped, with the reason, where there is none."""
    api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    with api.sync_playwright() as driver:
        if found is None and not Path(driver.chromium.executable_path).exists():
            pytest.skip("no Chromium is installed: `make test-ui` installs one")
        browser = driver.chromium.launch(executable_path=found, args=list(FLAGS))
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def campaign(chromium, tmp_path_factory):
    """A tank that hides a thruster lag."""
    out = tmp_path_factory.mktemp("hidden") / "raw"
    main(["tank", f"tank={'practice' if PICTURES else 'tiny'}", f"out={out}", "--quiet"])
    return out


def free_port() -> int:
    """A port that nobody listens to."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def started(folder: Path, *words: str) -> tuple[subprocess.Popen, str]:
    """The workbench, started in a folder, and its address, once it answers."""
    port = free_port()
    code = "from rovsim.cli import main; main()"
    command = [sys.executable, "-c", code, "ui", "open=false", f"port={port}", *words]
    # NiceGUI behaves differently where it sees that pytest runs
    clean = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST_")}
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, env=clean)
    address = f"http://127.0.0.1:{port}"
    for _ in range(600):
        try:
            urlopen(address, timeout=5).close()
            return process, address
        except (URLError, ConnectionError):
            assert process.poll() is None, "the workbench ended"
            time.sleep(0.05)
    raise AssertionError("the workbench does not answer")


@pytest.fixture(scope="session")
def workbench(campaign, tmp_path_factory):
    """Address and folder of a workbench with that campaign."""
    folder = tmp_path_factory.mktemp("desk")
    process, address = started(folder, f"campaign={campaign}")
    yield address, folder
    process.terminate()
    process.wait(20)


class Tab:
    """A browser tab that remembers what went wrong, and what it asked of other machines."""

    def __init__(self, page, address: str) -> None:
        self.page, self.address, self.complaints = page, address, []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("requestfailed", lambda r: self.complaints.append(f"failed: {r.url}"))
        page.on("request", self._request)
        page.on("response", self._response)

    def _console(self, message) -> None:
        if message.type in ("error", "warning"):
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

    def picture(self, name: str) -> None:
        """A screenshot for the docs, where they were asked for."""
        if PICTURES:
            self.page.wait_for_timeout(800)
            self.page.mouse.move(0, 0)
            self.page.screenshot(path=str(Path(PICTURES) / f"{name}.png"))


@pytest.fixture
def tab(chromium, workbench):
    """A tab of a desk's size; in the end there is nothing to complain about."""
    yield from _tab(chromium, workbench[0], DESK)


@pytest.fixture
def phone(chromium, workbench):
    """The same on a phone."""
    yield from _tab(chromium, workbench[0], PHONE)


def _tab(chromium, address, size):
    page = chromium.new_page(viewport={"width": size[0], "height": size[1]})
    page.set_default_timeout(20_000)
    found = Tab(page, address)
    yield found
    page.close()
    assert found.complaints == []
