"""A long day at the workbench: python tests/browser/soak.py [REPLAYS] [CAMPAIGNS]

Campaigns are opened one after the other; in each, every screen is shown, a slider is moved again
and again, a diagnosis is begun and cancelled, and one worker is killed. Printed for each: memory
of the server and how many processes it has. In the end memory must be flat and no process left.
"""

import os
import shutil
import signal
import sys
import tempfile
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright

from chromium import DESK, FLAGS, Tab, installed, started
from rovsim.apps.cli.main import main

SCREENS = ("compare", "where", "why", "add", "ladder", "models", "flight", "data", "gallery")
FLAT = 1.0  # MB a campaign: what memory may grow by, in the second half
DRAWN = "() => document.querySelector(\"[data-name='run/now']\")?.dataset.value"


def memory(pid: int) -> float:
    """Resident memory of a process, MB."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return next(float(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1024


def workers(pid: int) -> list[int]:
    """Processes that a process started; Python's own tracker of resources is none."""
    found = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [
        int(child)
        for child in found
        if b"resource_tracker" not in Path(f"/proc/{child}/cmdline").read_bytes()
    ]


def campaigns(folder: Path, count: int) -> list[Path]:
    """So many campaigns of other names."""
    main(["tank", "tank=tiny", f"out={folder / 'first'}", "--quiet"])
    made = []
    for k in range(count):
        place = folder / f"campaign-{k}"
        shutil.copytree(folder / "first", place)
        file = place / "campaign.yaml"
        file.write_text(file.read_text().replace("name: tank-tiny", f"name: tank-{k}"))
        made.append(place)
    return made


def begin(tab: Tab) -> None:
    """A diagnosis that was not there yet."""
    tab.go("why")
    tab.page.get_by_role("button", name="Find what is missing").click()
    tab.page.get_by_role("button", name="Cancel").wait_for()


def day(tab: Tab, pid: int, campaign: Path, replays: int) -> None:
    """Everything that is done with one campaign."""
    page = tab.page
    tab.go("open")
    page.get_by_label("Folder of a campaign").fill(str(campaign))
    page.get_by_role("button", name="Open", exact=True).click()
    page.get_by_role("heading", name="Compare").wait_for()
    for screen in SCREENS:
        tab.go(screen)
    begin(tab)
    page.get_by_role("button", name="Cancel").click()
    page.get_by_text("cancelled, nothing was changed").wait_for()
    begin(tab)
    page.wait_for_timeout(300)
    os.kill(workers(pid)[-1], signal.SIGKILL)
    page.get_by_text("ended unexpectedly").wait_for()
    tab.go("add")
    page.get_by_label("Another effect").fill("thruster_lag")
    page.get_by_role("option", name="thruster_lag").click()
    page.locator(".slider .q-slider__track-container").first.focus()
    for k in range(replays):
        before = page.evaluate(DRAWN)
        page.keyboard.press("ArrowRight" if k // 100 % 2 == 0 else "ArrowLeft")
        page.wait_for_function(f"before => ({DRAWN})() != before", arg=before)


def run(folder: Path, replays: int, count: int) -> None:
    """Print a line a campaign, then what must hold."""
    places = campaigns(folder, count)
    server, address = started(folder, f"campaign={places[0]}")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=installed(), args=list(FLAGS))
        page = browser.new_page(viewport={"width": DESK[0], "height": DESK[1]})
        page.set_default_timeout(60_000)
        tab, held = Tab(page, address), []
        for place in places:
            day(tab, server.pid, place, replays // count)
            held.append(memory(server.pid))
            print(
                f"{place.name}: {held[-1]:.0f} MB, {len(workers(server.pid))} workers", flush=True
            )
        browser.close()
    left = len(workers(server.pid))
    server.terminate()
    server.wait(20)
    late = held[len(held) // 2 :]
    growth = float(np.polyfit(range(len(late)), late, 1)[0])
    print(f"{replays} replays, {count} campaigns: {growth:+.2f} MB a campaign, {left} workers left")
    assert growth < FLAT
    assert left == 0


if __name__ == "__main__":
    asked = [int(word) for word in sys.argv[1:]] or [1000, 20]
    with tempfile.TemporaryDirectory() as place:
        run(Path(place), *asked)
