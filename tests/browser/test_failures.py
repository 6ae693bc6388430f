"""Why something failed stays on the page, beside the control that was used, until it works."""

import shutil

import pytest

from chromium import Tab, started
from rovsim.results.diagnosis import Diagnosis
from screens import READY
from synthetic_study import several_effects

pytestmark = pytest.mark.browser
NO_SUCH_BODY = "inertia matrix"
LAW = {
    "axis": "sway", "equation": "Y = c v", "file": "proposed_effect.py",
    "parameters": {"sway": {"value": -4.0, "std": 0.1, "unit": "N s/m"}},
    "error_reduction": 0.5, "effect": "proposed_effect", "meaning": "", "terms": [],
}  # fmt: skip


def told(tab, words):
    """The message, once it is there; a toast would have gone by the end of its time."""
    alert = tab.page.get_by_role("alert").filter(has_text=words)
    alert.wait_for()
    assert tab.page.locator(".q-notification").count() == 0
    return alert


@pytest.fixture
def impossible(diagnosed_tab):
    """*Add* with a draft that is no model, the field that is to blame, and the message."""
    page = diagnosed_tab.page
    diagnosed_tab.go("add")
    page.wait_for_selector(READY["add"])
    page.wait_for_selector(".chart canvas")  # ECharts complains of what goes before it is drawn
    page.get_by_label("Another effect").click()
    page.get_by_role("option", name="added_mass", exact=True).click()
    mass = page.get_by_label("added_mass, surge, number")
    mass.fill("-10000")
    mass.press("Enter")
    yield diagnosed_tab, mass, told(diagnosed_tab, NO_SUCH_BODY)
    page.get_by_role("checkbox", name="added_mass").click()
    mass.wait_for(state="hidden")  # the next test begins without it


def test_a_model_that_cannot_be_is_told_on_its_card_until_it_can(impossible):
    tab, _, alert = impossible
    card = tab.page.locator(".card", has=tab.page.get_by_role("checkbox", name="added_mass"))
    assert card.get_by_role("alert").filter(has_text=NO_SUCH_BODY).count() == 1
    tab.page.get_by_role("button", name="Undo").click()
    alert.wait_for(state="hidden")


def test_a_draft_that_could_not_be_when_the_page_was_opened_is_replayed_once_it_can(impossible):
    tab, mass, _ = impossible
    tab.go("add")
    alert = told(tab, NO_SUCH_BODY)
    assert tab.page.locator(READY["add"]).count() == 0
    mass.fill("1")
    mass.press("Enter")
    alert.wait_for(state="hidden")
    tab.page.wait_for_selector(READY["add"])


def test_why_a_model_was_not_saved_stays(diagnosed_tab, tmp_path):
    page = diagnosed_tab.page
    diagnosed_tab.go("add")
    page.wait_for_selector(READY["add"])
    page.get_by_label("Model file").fill(str(tmp_path / "elsewhere.yaml"))
    page.get_by_role("button", name="Save").click()
    told(diagnosed_tab, "outside the folder")


def test_why_another_model_was_not_opened_stays(diagnosed_tab, tmp_path):
    page = diagnosed_tab.page
    diagnosed_tab.go("models")
    page.get_by_label("Another model file").fill(str(tmp_path / "none.yaml"))
    page.get_by_role("button", name="Open it on the right").click()
    told(diagnosed_tab, "none.yaml")


def test_notes_that_could_not_be_kept_are_told_until_they_are(diagnosed_tab, campaign):
    page, notes = diagnosed_tab.page, campaign / "notes.md"
    notes.unlink(missing_ok=True)
    diagnosed_tab.go("data")
    (notes / "in the way").mkdir(parents=True)
    try:
        page.get_by_label("Kept in").fill("The tether was slack.")
        alert = told(diagnosed_tab, "notes.md")
    finally:
        shutil.rmtree(notes)
    page.get_by_label("Kept in").fill("The tether was slack!")
    alert.wait_for(state="hidden")
    assert notes.read_text() == "The tether was slack!"
    notes.unlink()


def test_a_law_whose_file_is_gone_says_so(chromium, campaign, tmp_path):
    content = several_effects().to_json()
    content["unexplained"]["proposal"] = LAW
    file = tmp_path / "diagnosis.json"
    Diagnosis.model_validate(content).write(file)
    process, address = started(tmp_path, f"campaign={campaign}", f"diagnosis={file}")
    try:
        tab = Tab(chromium.new_page(), address)
        tab.go("why")
        tab.page.get_by_role("button", name="Add the law").click()
        told(tab, "proposed_effect.py")
        tab.page.close()
    finally:
        process.terminate()
        process.wait(20)
