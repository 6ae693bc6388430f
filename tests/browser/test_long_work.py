"""Long work: cancelled, or failed."""

import pytest

from screens import have_diagnosed

pytestmark = pytest.mark.browser


def test_long_work_can_be_cancelled_and_changes_nothing(tab, workbench):
    have_diagnosed(tab)
    before = tab.numbers()
    tab.page.get_by_role("button", name="Diagnose again").click()
    tab.page.locator(
        "button:disabled[title*='Finding what is missing'][aria-description]"
    ).wait_for()
    tab.page.get_by_role("button", name="Cancel").click()
    tab.page.get_by_text("cancelled, nothing was changed").wait_for()
    tab.page.wait_for_selector(".verdict")
    tab.page.locator("button:enabled:not([title])", has_text="Diagnose again").wait_for()
    assert tab.numbers() == before
    (path,) = workbench[1].glob("results/*/ui/*/*.*")  # flights lie a folder deeper
    assert path.name == "diagnosis.json"


def test_why_long_work_failed_stays_until_it_was_read(tab):
    tab.go("flight?asked=between&one=lift&other=lift&model=nominal")
    tab.page.get_by_role("button", name="Plan the flight").click()
    told = tab.page.get_by_role("alert").get_by_text("two different effects")
    told.wait_for()
    tab.go("data")
    told.wait_for()
    tab.page.get_by_role("button", name="Close").click()
    told.wait_for(state="hidden")
