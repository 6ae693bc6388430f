"""Add: sliders, typed values, undo."""

import json

import pytest

from rovsim.core.rounding import rounded
from screens import CHANGED, READY, have_diagnosed

pytestmark = pytest.mark.browser
SAME = """() => {
  const [now, before] = ["now", "before"].map(
    name => Number(document.querySelector(`[data-name="run/${name}"]`).dataset.value));
  return Math.abs(now / before - 1) < 1e-3;
}"""
NUMBER = "document.querySelector(\"input[aria-label='thruster_lag, time_constant, number']\")"


def test_a_slider_moves_the_replay_and_keys_alone_suffice(tab):
    have_diagnosed(tab)
    tab.page.keyboard.press("4")
    tab.page.wait_for_selector(READY["add"])
    before = tab.numbers("run/now")["run/now"]
    tab.page.locator(".slider .q-slider__track-container").first.focus()
    for _ in range(40):
        tab.page.keyboard.press("PageDown")
    tab.page.wait_for_function(CHANGED, arg=["run/now", before])
    tab.page.wait_for_function(SAME)  # a busy machine follows the last key later
    put_back(tab)
    tab.page.keyboard.press("1")
    tab.page.get_by_role("heading", name="Compare").wait_for()
    tab.page.keyboard.press("Tab")
    assert tab.page.evaluate("document.activeElement !== document.body")


def test_what_was_added_is_typed_undone_and_put_back(tab, workbench):
    have_diagnosed(tab)
    (path,) = workbench[1].glob("results/*/ui/*/diagnosis.json")
    (fitted,) = json.loads(path.read_text())["selected"]
    tab.go("add")
    tab.page.wait_for_selector(READY["add"])
    first = tab.numbers("run/now")["run/now"]
    number = tab.page.get_by_label("thruster_lag, time_constant, number")
    kept = number.input_value()
    number.fill("0.9")
    number.press("Enter")
    tab.page.wait_for_function(CHANGED, arg=["run/now", first])
    tab.page.get_by_role("button", name="Undo").click()
    tab.page.wait_for_function(f"!({CHANGED})({json.dumps(['run/now', first])})")
    assert number.input_value() == kept
    number.fill("0.9")
    number.press("Enter")
    tab.page.wait_for_function(CHANGED, arg=["run/now", first])
    put_back(tab)
    begun = rounded(fitted["parameters"]["time_constant"]["value"], 3)
    tab.page.wait_for_function(f"Number({NUMBER}.value) == {begun}")


def put_back(tab) -> None:
    """Leave the draft as the diagnosis made it: other tests look at it too."""
    tab.page.get_by_role("button", name="back to where it began").click()
