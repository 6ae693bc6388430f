"""The workbench with a diagnosis that was given: several effects, and a push that has no law."""

import pytest

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
