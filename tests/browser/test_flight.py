"""Flight: the next one, planned, cancelled, shown."""

import pytest

pytestmark = pytest.mark.browser


def test_planning_a_flight_is_long_work_and_can_be_cancelled(tab, workbench):
    before = set(workbench[1].glob("results/*/ui/flights/*/*"))  # of other tests
    tab.go("flight?asked=between&one=thruster_lag&other=lift&seconds=30&model=nominal")
    plan = tab.page.get_by_role("button", name="Plan the flight")
    plan.click()
    tab.page.get_by_role("button", name="Cancel").click()
    tab.page.get_by_text("cancelled, nothing was changed").wait_for()
    plan.wait_for()
    assert set(workbench[1].glob("results/*/ui/flights/*/*")) == before


def test_a_planned_flight_is_shown_with_what_it_promises_and_what_to_do(tab, phone, planned):
    address, folder = planned
    for one in (tab, phone):
        one.go(address)
        one.page.get_by_role("heading", name="A flight of 20 s").wait_for()
        picture = one.page.get_by_role("img", name="The predicted path")
        assert picture.evaluate("e => e.decode().then(() => e.naturalWidth)") > 500
        assert one.numbers() == {
            "thruster_lag.time_constant/now": 0.02,
            "thruster_lag.time_constant/then": 0.005,
        }
        assert one.page.get_by_text("over a million").count() == 1
        steps = one.page.locator(".text > div > ol > li, .text > ol > li")
        assert steps.nth(1).inner_text() == "Send experiment.csv."
        assert steps.count() == 3  # what is done by hand stands under the third
        assert one.page.locator("ol ul > li").all_inner_texts()[-1] == "Leave alone: sway."
        assert one.page.evaluate("document.scrollingElement.scrollWidth - innerWidth") <= 0
    tab.picture("flight", height=1250)
    with tab.page.expect_download() as log:
        tab.page.get_by_role("button", name="Commands (experiment.csv)").click()
    assert log.value.path().read_bytes() == (folder / "experiment.csv").read_bytes()
    tab.page.get_by_role("spinbutton", name="Length (s)").fill("25")
    tab.page.get_by_role("button", name="Plan the flight").wait_for()  # another question
    tab.page.wait_for_function("location.search.includes('seconds=25')")
