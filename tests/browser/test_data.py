"""Data: notes beside the campaign."""

import pytest

pytestmark = pytest.mark.browser


def test_notes_lie_beside_the_campaign(tab, campaign):
    tab.go("data")
    tab.page.get_by_label("Kept in").fill("Run 6dof-1: the tether was slack.")
    tab.page.get_by_role("link", name="Compare").click()
    tab.page.get_by_role("heading", name="Compare").wait_for()
    tab.go("data")
    assert tab.page.get_by_label("Kept in").input_value() == "Run 6dof-1: the tether was slack."
    tab.picture("data")
    assert (campaign / "notes.md").read_text() == "Run 6dof-1: the tether was slack."
