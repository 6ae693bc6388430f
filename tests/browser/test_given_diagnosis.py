"""The workbench with a diagnosis that was given: several effects, and a push that has no law."""

import pytest

from rovsim.results.diagnosis import Diagnosis

pytestmark = pytest.mark.browser
PICTURE = "What pushes and follows no law, on the path and in time"


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
    assert row.get_by_role("cell").last.inner_text() == "< 0.001"
    assert page.get_by_text("on top of those above it").count() == 1
