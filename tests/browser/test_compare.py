"""Compare: its horizon, its run that plays, its curves, and what is kept of them."""

import re
from xml.etree import ElementTree

import pytest

from rovsim.apps.workbench.traces import HORIZONS
from screens import CHANGED, READY, read_csv

pytestmark = pytest.mark.browser
WHEEL = """document.querySelector('.path canvas').dispatchEvent(
  new WheelEvent('wheel', {deltaY: 100, bubbles: true, cancelable: true}))"""
# A promise that waits for the next tick, as every chart does, waits for five seconds.
SLOW_CHARTS = """const soon = window.setTimeout, resolves = /native code/;
  window.setTimeout = (f, ms, ...more) => soon(f, ms || !resolves.test(f) ? ms : 5000, ...more)"""
LATER = (
    "([name, v]) => Number(document.querySelector(`[role=slider][aria-label='${name}']`)"
    ".getAttribute('aria-valuenow')) > v"
)


def test_the_horizon_changes_the_errors_and_a_run_plays(tab):
    tab.go("compare")
    tab.page.wait_for_selector("table")
    before = tab.numbers()["velocity_rmse/surge"]
    tab.page.locator(".horizon .q-slider__track-container").focus()
    ends = (("ArrowLeft", "restarted every 0.5 s"), ("ArrowRight", "open loop"))
    for key, reached in 4 * ends:
        for _ in range(len(HORIZONS) - 1):  # no key of a fast hand is lost
            tab.page.keyboard.press(key)
        tab.page.get_by_text(f"Horizon, {reached}").wait_for()
    tab.page.wait_for_function(CHANGED, arg=["velocity_rmse/surge", before])
    tab.page.get_by_role("button", name="Play").click()
    tab.page.wait_for_function(LATER, arg=["Time in the run, seconds", 0.5])
    # Without a graphics card a click of the mouse waits for pictures of the tank: press at once.
    tab.page.get_by_role("button", name="Pause").dispatch_event("click")
    tab.page.get_by_role("button", name="Play").wait_for()


def test_charts_that_are_replaced_before_they_are_drawn_leave_no_error(tab):
    tab.page.add_init_script(SLOW_CHARTS)
    tab.go("compare?axes=surge")
    tab.page.wait_for_selector(".chart", state="attached")
    assert tab.page.locator(".chart canvas").count() == 0
    first = tab.page.locator(".chart").first.get_attribute("id")
    tab.page.get_by_label("Quantity").click()
    tab.page.get_by_role("option", name="position and attitude").click()
    tab.page.wait_for_selector(f"#{first}", state="detached")
    tab.page.wait_for_selector(READY["compare"])


def test_a_wide_window_is_used(tab):
    tab.page.set_viewport_size({"width": 1920, "height": 1080})
    tab.go("compare")
    for one in (READY["compare"], ".path canvas"):
        tab.page.wait_for_selector(one)
        assert tab.page.locator(one).first.bounding_box()["width"] > 0.75 * 1920


def test_over_the_curves_the_wheel_moves_the_page_and_the_time_is_told_once(tab):
    tab.go("compare?axes=surge&axes=yaw")
    tab.page.wait_for_selector("table")
    curves = tab.page.locator(".chart canvas").first.bounding_box()
    at = (curves["x"] + 0.5 * curves["width"], curves["y"] + 100.0)
    tab.page.mouse.move(*at)
    tip = tab.page.locator(".chart").get_by_text("surge (m/s):")
    tip.wait_for()
    told = tip.locator("..").inner_text()
    assert len(re.findall(r"\d\.\d\d s$", told, re.MULTILINE)) == 1
    assert "yaw (rad/s): measured" in told
    tab.page.mouse.wheel(0, 200)
    tab.page.wait_for_function("scrollY > 50")
    tab.page.wait_for_selector(".path canvas")
    assert tab.page.evaluate(WHEEL)  # left to the page


def test_a_chart_is_kept_as_a_picture_and_as_values(tab):
    tab.go("compare?run=3dof-1")
    tab.page.wait_for_selector(READY["compare"])
    with tab.page.expect_download() as picture:
        tab.page.get_by_role("button", name="PNG: ").first.click()
    assert picture.value.path().read_bytes().startswith(b"\x89PNG")
    with tab.page.expect_download() as lines:
        tab.page.get_by_role("button", name="SVG: ").click()
    drawn = ElementTree.fromstring(lines.value.path().read_text())
    assert drawn.tag.endswith("svg")
    words = {"".join(text.itertext()) for text in drawn.iter() if text.tag.endswith("text")}
    assert any("measured" in word for word in words)
    assert len([one for one in drawn.iter() if one.tag.endswith("path")]) > 10
    with tab.page.expect_download() as values:
        tab.page.get_by_role("button", name="CSV: ").first.click()
    table = read_csv(values)
    named = "3dof-1 surge velocity, {} (m/s)"
    assert {"time (s)", *map(named.format, ("measured", "nominal", "measured − nominal"))} <= set(
        table[0]
    )
    known = [row for row in table if all(row[named.format(n)] for n in ("measured", "nominal"))]
    assert len(known) > 100
    missed = [float(row[named.format("measured − nominal")]) for row in known]
    for row, one in zip(known, missed, strict=True):
        apart = float(row[named.format("measured")]) - float(row[named.format("nominal")])
        assert one == pytest.approx(apart, abs=2e-5)
    with tab.page.expect_download() as values:
        tab.page.get_by_role("button", name="CSV: Path in the tank").click()
    table = read_csv(values)
    assert list(table[0])[:3] == [
        "time (s)",
        "3dof-1 measured, north (m)",
        "3dof-1 measured, east (m)",
    ]
    assert len([row for row in table if row["3dof-1 nominal, down (m)"]]) > 100
