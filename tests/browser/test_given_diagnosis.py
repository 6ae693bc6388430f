"""The workbench with a diagnosis that was given: several effects, and a push that has no law."""

import re

import pytest

from chromium import PICTURES, Tab, started
from rovsim.reporting.wording import ERROR_MEANING
from rovsim.results.diagnosis import Diagnosis
from screens import READY

pytestmark = pytest.mark.browser
PICTURE = "What pushes and follows no law: on the path, in time and by frequency"


def drawn_why(tab):
    """Why, drawn to its end: the pictures of its effects come last."""
    tab.go("why")
    for effect in ("thruster_lag", "thrust_asymmetry", "voltage_sag", "net_buoyancy"):
        card = tab.page.locator(".effect", has=tab.page.get_by_role("heading", name=effect))
        card.locator(".chart canvas, .picture").first.wait_for()
    return tab.page


def test_a_disturbance_is_shown(diagnosed_tab):
    picture = drawn_why(diagnosed_tab).get_by_role("img", name=PICTURE)
    assert picture.evaluate("e => e.decode().then(() => e.naturalWidth)") > 500
    with diagnosed_tab.page.expect_download() as kept:
        diagnosed_tab.page.get_by_role("button", name=f"PNG: {PICTURE}").click()
    assert kept.value.path().read_bytes().startswith(b"\x89PNG")


def test_why_with_several_effects_is_accessible_in_light_and_dark(diagnosed_tab):
    pytest.importorskip("axe_playwright_python")
    drawn_why(diagnosed_tab)
    for scheme in diagnosed_tab.schemes():
        assert (scheme, diagnosed_tab.violations()) == (scheme, [])


def test_the_ranking_keeps_what_is_likely_and_its_values_are_those_of_the_file(
    diagnosed_tab, diagnosed
):
    ranking = {r.effect: r for r in Diagnosis.read(diagnosed[1]).ranking}
    page = drawn_why(diagnosed_tab)
    shown = diagnosed_tab.numbers("ranking/")
    for name, value in shown.items():
        _, effect, key = name.split("/")
        assert value == getattr(ranking[effect], key)
    assert shown["ranking/thrust_asymmetry/probability"] == 0.97
    row = page.get_by_role("row", name="quadratic_damping")
    assert row.get_by_role("cell").last.inner_text() == "below 0.001"
    for once in ("on top of those above it", ERROR_MEANING):
        assert page.get_by_text(once).count() == 1
    seen = re.compile("On your data: .* over .* thrust, without thrust_asymmetry and with it")
    assert page.get_by_role("img", name=seen).count() == 1


def type_value(page, effect, parameter, value):
    """Type the value of an effect, as on a keyboard."""
    number = page.get_by_label(f"{effect}, {parameter}, number")
    number.fill(value)
    number.press("Enter")


@pytest.mark.skipif(bool(PICTURES), reason="the run of the pictures does not diverge")
def test_what_is_wrong_with_a_draft_is_told_in_words_and_colour(diagnosed_tab):
    pytest.importorskip("axe_playwright_python")
    page = diagnosed_tab.page
    diagnosed_tab.go("add?run=3dof-1")
    page.wait_for_selector(READY["add"])
    page.get_by_role("checkbox", name="quadratic_damping").click()
    card = page.locator(".card", has=page.get_by_role("checkbox", name="quadratic_damping"))
    card.get_by_text("Warning: the diagnosis did not select it: probability below 0.001").wait_for()
    type_value(page, "quadratic_damping", "surge", "-230")
    card.get_by_text("Warning: water would push, not brake").wait_for()
    page.get_by_text("The replay of the new model diverges after").wait_for()
    colours = "all => new Set(all.map(e => getComputedStyle(e).color)).size"
    assert card.locator(".total .alarm, .total").evaluate_all(colours) > 1
    for scheme in diagnosed_tab.schemes():
        assert (scheme, diagnosed_tab.violations()) == (scheme, [])

    page.get_by_label("Model file").fill("wild.yaml")
    page.get_by_role("button", name="Save").click()
    page.get_by_text("On the test runs its replay diverges").wait_for()
    page.get_by_role("button", name="Undo").click()
    page.get_by_text("The replay of the new model diverges after").wait_for(state="hidden")
    page.get_by_role("button", name="Undo").click()


def test_without_a_diagnosis_add_shows_the_way_to_one_and_saves_nothing(
    chromium, campaign, tmp_path
):
    process, address = started(tmp_path, f"campaign={campaign}")
    try:
        tab = Tab(chromium.new_page(), address)
        tab.go("add")
        tab.page.wait_for_selector(READY["add"])
        save = tab.page.get_by_role("button", name="Save")
        assert save.is_disabled()
        tab.page.get_by_label("Another effect").click()
        tab.page.get_by_role("option", name="lift", exact=True).click()
        tab.page.wait_for_function("!document.querySelector('.left .onward').disabled")
        assert save.is_enabled()
        tab.page.get_by_role("link", name="find what is missing").click()
        tab.page.get_by_role("button", name="Find what is missing").wait_for()
        tab.page.close()
    finally:
        process.terminate()
        process.wait(20)
