"""Where: its bins and its map of conditions."""

import pytest

pytestmark = pytest.mark.browser
# Another axis and another condition are told than at first.
MOVED = """first => {
  const named = told => told.split(':')[0].split(' over ');
  const now = named(document.querySelector('.half [role=status]').innerText);
  return named(first).every((part, k) => part != now[k]);
}"""


def test_a_bin_shows_its_samples_in_time(tab):
    tab.go("where")
    bins = tab.page.locator(".bins button")
    bins.first.wait_for()
    bins.last.click()
    tab.page.get_by_role("img", name="Samples of run").first.wait_for()
    assert "samples, " in tab.page.locator(".side").inner_text()
    tab.picture("where")


def test_the_fields_of_the_map_are_reached_and_chosen_with_the_keyboard(tab):
    tab.go("where")
    tab.page.locator(".bins button").first.wait_for()
    tab.page.get_by_role("combobox", name="Model").focus()
    for _ in range(30):
        tab.page.keyboard.press("Tab")
        if tab.page.evaluate("document.activeElement.getAttribute('role') == 'application'"):
            break
    told = tab.page.get_by_role("status").filter(has_text="of the error")
    told.wait_for()
    first = told.inner_text()
    tab.page.keyboard.press("ArrowRight")
    tab.page.keyboard.press("ArrowDown")
    tab.page.wait_for_function(MOVED, arg=first)
    axis, condition = told.inner_text().partition(":")[0].split(" over ")
    tab.page.keyboard.press("Enter")
    tab.page.get_by_role("heading", name=f"{axis.capitalize()} error over {condition}").wait_for()
