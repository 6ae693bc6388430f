"""How fast the workbench is in a real Chromium: `make bench-ui` writes results/bench_ui.json.

From the start of the process to the page and to its first curves; from the key that moves a slider
to the end of the drawing of the replay, for a run of 60 s; from a horizon chosen to its drawing.
"""

import tempfile
import time
from pathlib import Path
from statistics import median

from playwright.sync_api import sync_playwright

from chromium import DESK, installed, started
from rovsim.apps.cli.main import main
from rovsim.core.files import write_json
from rovsim.core.making import describe_machine

# Drawn by Chromium itself: a graphics card that is computed, as tests of three dimensions need it,
# takes a fifth longer.
PLAIN = ("--no-sandbox", "--disable-background-networking", "--disable-gpu")
STARTS = 5
MOVES = 10 * (10 * ["ArrowRight"] + 10 * ["ArrowLeft"])  # 200 keys that stay on the slider
# ECharts clears its canvas, then draws in the same task: the task after that is the end.
CLOCK = """
window.times = []; let pressed = null;
addEventListener('keydown', () => { pressed = performance.now(); }, true);
const clear = CanvasRenderingContext2D.prototype.clearRect;
CanvasRenderingContext2D.prototype.clearRect = function (...area) {
  const since = pressed; pressed = null;
  if (since !== null) setTimeout(() => times.push(performance.now() - since), 0);
  return clear.apply(this, area);
};
"""


def first_screens(browser, campaign: Path, folder: Path) -> tuple[list[float], list[float]]:
    """Seconds from the start of the process until the page is there, and until its curves are.

    Between the two the page says that the recordings are being read.
    """
    pages, curves = [], []
    for _ in range(STARTS):
        begun = time.perf_counter()
        process, address = started(folder, f"campaign={campaign}")
        page = browser.new_page(viewport={"width": DESK[0], "height": DESK[1]})
        page.goto(address, wait_until="commit")
        for shown, times in (("header", pages), (".chart canvas", curves)):
            page.locator(shown).first.wait_for()
            times.append(time.perf_counter() - begun)
        page.close()
        process.terminate()
        process.wait(20)
    return pages, curves


def redraws(page, slider: str, keys: list[str]) -> list[float]:
    """Milliseconds from each key to the end of the drawing."""
    page.wait_for_timeout(2000)
    page.locator(slider).first.focus()
    page.evaluate("times.length = 0")
    for key in keys:
        page.keyboard.press(key)
        page.wait_for_timeout(500)
    return page.evaluate("times")


def summary(values: list[float]) -> dict[str, float]:
    """Median and worst."""
    return {"median": round(median(values), 3), "worst": round(max(values), 3), "n": len(values)}


def run(folder: Path) -> dict:
    """Measure all of it."""
    campaign = folder / "raw"
    main(["tank", "tank=lag", f"out={campaign}", "--quiet"])
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=installed(), args=list(PLAIN))
        pages, curves = first_screens(browser, campaign, folder)
        process, address = started(folder, f"campaign={campaign}")
        page = browser.new_page(viewport={"width": DESK[0], "height": DESK[1]})
        page.add_init_script(CLOCK)
        page.goto(f"{address}/why")
        page.get_by_role("button", name="Find what is missing").click()
        page.wait_for_selector(".verdict", timeout=300_000)
        page.goto(f"{address}/add")
        page.wait_for_selector("[data-name='run/now'][data-value]")
        moves = redraws(page, ".slider .q-slider__track-container", MOVES)
        page.goto(f"{address}/compare")
        page.wait_for_selector("table")
        horizon = ".horizon .q-slider__track-container"
        jumps = redraws(page, horizon, ["ArrowRight"] * 4 + ["ArrowLeft"] * 6)
        browser.close()
        process.terminate()
        process.wait(20)
    return {
        "schema": "rovsim.bench_ui/1",
        "machine": describe_machine(),
        "first_page_s": summary(pages),
        "first_curves_s": summary(curves),
        "slider_to_drawn_ms": summary(moves),
        "horizon_to_drawn_ms": summary(jumps),
    }


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        content = run(Path(place))
    write_json(Path("results/bench_ui.json"), content)
    print(content)
