"""Screens of the workbench: when each is drawn, and what tests of several of them do."""

import csv

READY = {  # what is there once a screen is drawn
    "compare": ".chart canvas", "where": ".chart canvas", "why": ".verdict",
    "add": "[data-name='run/now'][data-value]", "ladder": ".chart canvas",
    "models": ".chart canvas", "flight": "h1", "data": ".chart canvas", "gallery": "h1",
    "open": "h1",
}  # fmt: skip
# The number of this name is another than that.
CHANGED = (
    "([name, v]) => Number(document.querySelector(`[data-name='${name}']`).dataset.value) != v"
)


def have_diagnosed(tab) -> None:
    """Have the campaign diagnosed, unless it is already."""
    tab.go("why")
    tab.page.wait_for_selector(".verdict, .onward")
    ask = tab.page.get_by_role("button", name="Find what is missing")
    if ask.count():
        ask.click()
        tab.page.get_by_role("button", name="Cancel").wait_for()
    tab.page.wait_for_selector(".verdict", timeout=180_000)


def read_csv(download) -> list[dict[str, str]]:
    """The rows of a table that was saved, by the names of its columns."""
    with download.value.path().open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
