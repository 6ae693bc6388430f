"""Addresses: what they keep, and those that are none."""

import pytest

from screens import READY

pytestmark = pytest.mark.browser


def test_a_link_keeps_what_a_screen_shows_through_reload_and_back(tab):
    asked = "run=3dof-1&beside=6dof-1&axes=surge&axes=yaw&horizon=5.0&from=2.0&to=6.0"
    tab.go(f"compare?{asked}")
    tab.page.wait_for_selector(READY["compare"])

    def shown() -> None:
        tab.page.get_by_role("img", name="Measured and simulated, run 3dof-1, 6dof-1").wait_for()
        tab.page.get_by_text("Horizon, restarted every 5 s").wait_for()
        tab.page.get_by_role("rowheader", name="nominal, 6dof-1").wait_for()
        tab.page.wait_for_function("location.search.includes('from=2.0&to=6.0')")
        assert "6dof-1/velocity_rmse/surge" in tab.numbers()

    shown()
    tab.picture("compare-runs")
    tab.page.reload()
    shown()
    tab.page.get_by_role("link", name="Where").click()
    tab.page.get_by_role("heading", name="Where").wait_for()
    tab.page.wait_for_function("location.search.includes('condition=')")
    tab.page.go_back()
    shown()


def test_an_address_of_another_day_is_no_error(tab):
    tab.go("compare?run=gone&models=gone&axes=warp&horizon=x&from=y")
    tab.page.wait_for_selector(READY["compare"])
    assert tab.page.get_by_role("rowheader", name="nominal").count() == 1


def test_an_address_that_is_none_shows_a_way_on(tab):
    tab.page.goto(f"{tab.address}/nowhere")
    tab.page.get_by_role("heading", name="No such screen").wait_for()
    tab.page.wait_for_timeout(1000)  # for a screen that ought not to come
    assert tab.page.get_by_role("heading").all_inner_texts() == ["No such screen"]
    tab.complaints.clear()  # of the browser, about the status 404
    tab.page.locator(".screen").get_by_role("link", name="Compare").click()
    tab.page.wait_for_selector(READY["compare"])


def test_a_screen_may_be_left_while_it_is_drawn(tab):
    """What was to be drawn is dropped; no traceback is in the log of the workbench (conftest)."""
    tab.go("compare?run=6dof-1")
    tab.page.wait_for_selector(READY["compare"])
    for _ in range(3):
        tab.page.get_by_role("link", name="Where").click()
        tab.page.get_by_role("link", name="Models").click()
        tab.page.goto(f"{tab.address}/add")
        tab.page.goto(f"{tab.address}/compare")
    tab.page.wait_for_selector(READY["compare"])
