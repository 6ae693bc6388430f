"""Campaigns are opened, found, described and practised on; each tab keeps its own."""

import itertools
import re
import shutil

import pytest
import yaml

from chromium import DESK, Tab, started
from rovsim.apps.workbench.folders import MAX_FOLDERS

pytestmark = pytest.mark.browser
DATA = ".chart canvas"  # there once the Data screen is drawn
# All folders that are listed, at least one, have this in their names.
ONLY = """part => { const all = [...document.querySelectorAll('.entry .block')];
  return all.length && all.every(e => e.innerText.includes(part)); }"""


def test_another_campaign_is_opened_and_a_bad_one_explained(tab, campaign, tmp_path):
    tab.go("data")
    tab.page.wait_for_selector(DATA)
    opened = tab.page.locator("header .campaign").inner_text()
    tab.go("open")
    tab.page.get_by_label("Folder of a campaign, or of recordings").fill(str(tmp_path / "nowhere"))
    tab.page.get_by_role("button", name="Open", exact=True).click()
    tab.page.get_by_text("no such file").wait_for()
    tab.page.get_by_role("alert").get_by_text("look for the folder below").wait_for()
    typed = tab.page.get_by_label("Folder of a campaign, or of recordings")
    assert typed.input_value() == str(tmp_path / "nowhere")  # to be corrected
    assert tab.page.locator("header .campaign").inner_text() == opened != "nowhere"
    tab.page.get_by_role("link", name="Data").click()  # what was open still is
    tab.page.wait_for_selector(DATA)
    tab.go("open")
    typed.fill("")
    tab.page.get_by_role("button", name="Open", exact=True).click()
    tab.page.get_by_text("Type a folder first").wait_for()
    (tmp_path / "empty").mkdir()  # looked into, in vain
    typed.fill(str(tmp_path / "empty"))
    tab.page.get_by_role("button", name="Open", exact=True).click()
    tab.page.locator(".screen").get_by_role("alert").get_by_text("empty").wait_for()
    tab.page.locator(".progress", has_text="empty").wait_for(state="hidden")  # told once
    assert typed.input_value() == str(tmp_path / "empty")
    tab.page.get_by_label("Folder of a campaign, or of recordings").fill(str(campaign))
    tab.page.get_by_role("button", name="Open", exact=True).click()
    tab.page.get_by_role("heading", name="Compare").wait_for()


def test_a_campaign_is_found_by_walking_through_folders(tab, campaign, tmp_path):
    page = tab.page
    own = tmp_path / "lab" / "hidden lag"
    shutil.copytree(campaign, own)
    for number in range(MAX_FOLDERS):  # a crowd that comes before it by name
        (own.parent / f"run {number}").mkdir()
        (own.parent / f"a{number}").mkdir()
    tab.go("compare")  # read, and so among those opened last
    page.get_by_role("heading", name="Compare").wait_for()
    tab.go("open")
    page.get_by_role("button", name="/", exact=True).click()
    for parent, part in itertools.pairwise(own.parts):
        reached = re.compile(f"^{re.escape(parent)}$")
        page.locator(".way button:last-child", has_text=reached).wait_for()
        page.get_by_label("Only names with").fill(part)
        page.wait_for_function(ONLY, arg=part)
        if parent == own.parent.name:
            tab.picture("open", home=tmp_path)
        wanted = re.compile(f"^{re.escape(part)}( .campaign.)?$")
        page.locator(".entry").get_by_text(wanted).click()
    page.get_by_role("heading", name="Compare").wait_for()
    tab.go("open")
    page.get_by_role("heading", name="Opened last").wait_for()
    assert page.get_by_role("button", name=str(own), exact=True).count() >= 1
    page.get_by_role("button", name=str(campaign), exact=True).first.click()
    page.get_by_role("heading", name="Compare").wait_for()


def test_each_tab_looks_at_its_own_campaign(chromium, campaign, tmp_path):
    other = tmp_path / "other"
    shutil.copytree(campaign, other)
    described = yaml.safe_load((other / "campaign.yaml").read_text())
    (other / "campaign.yaml").write_text(yaml.safe_dump({**described, "name": "the other"}))
    process, address = started(tmp_path, f"campaign={campaign}")
    try:
        tabs = [Tab(chromium.new_page(), address) for _ in range(3)]
        first, second, third = tabs
        for tab in (first, second):
            tab.go("compare")
            tab.page.get_by_role("heading", name="Compare").wait_for()
        second.go("open")
        second.page.get_by_label("Folder of a campaign, or of recordings").fill(str(other))
        second.page.get_by_role("button", name="Open", exact=True).click()
        second.page.locator("header", has_text="the other").wait_for()
        second.page.get_by_role("heading", name="Compare").wait_for()
        third.go("data")  # begins with what was opened last
        third.page.locator("header", has_text="the other").wait_for()
        for tab, name in ((first, described["name"]), (second, "the other")):
            for screen in ("data", "compare"):  # a new page of the same tab, as after a reload
                tab.go(screen)
                tab.page.locator("header", has_text=name).wait_for()
        for tab in tabs:
            assert tab.complaints == []
            tab.page.close()
    finally:
        process.terminate()
        process.wait(20)


def test_recordings_without_a_description_are_looked_into_asked_about_and_opened(
    chromium, campaign, tmp_path
):
    """Motions alone: the vehicle and the axes have to be asked; then compare has nothing to say."""
    raw = tmp_path / "own recordings"
    raw.mkdir()
    for path in campaign.glob("*_6D.tsv"):
        shutil.copy(path, raw)
    process, address = started(tmp_path)
    try:
        tab = Tab(chromium.new_page(viewport={"width": DESK[0], "height": DESK[1]}), address)
        page = tab.page
        page.goto(f"{address}/open")
        page.get_by_label("Folder of a campaign, or of recordings").fill(str(raw))
        page.get_by_role("button", name="Open", exact=True).click()
        page.get_by_role("heading", name="New campaign").wait_for(timeout=60_000)
        tab.picture("new-campaign", home=tmp_path)
        write = page.get_by_role("button", name="Write campaign.yaml and open it")
        write.click()
        page.get_by_text("No answer yet: Vehicle, Axes of the world").wait_for()
        fields = page.locator(".screen .control")
        assert max(box["height"] for box in map(lambda f: f.bounding_box(), fields.all())) < 60
        assert not (raw / "campaign.yaml").exists()
        page.get_by_role("button", name="bluerov2_heavy", exact=True).click()
        for label, answer in (("world", "z_up"), ("rigid body", "flu")):
            page.get_by_label(f"Axes of the {label}").click()
            page.get_by_role("option", name=f"{answer}: ").click()
        write.click()
        page.get_by_role("heading", name="Compare").wait_for(timeout=60_000)
        content = yaml.safe_load((raw / "campaign.yaml").read_text())
        assert (content["vehicle"], content["mocap"]["body_axes"]) == ("bluerov2_heavy", "flu")
        assert {f"{run['id']}_6D.tsv" for run in content["runs"]} == {
            p.name for p in raw.glob("*.tsv")
        }
        assert tab.complaints == []
        page.close()
    finally:
        process.terminate()
        process.wait(20)


def test_a_newcomer_without_recordings_gets_some_to_practise_on(chromium, tmp_path):
    """From `make ui` to the first replay; the rest of the way is tested above."""
    process, address = started(tmp_path)
    try:
        page = chromium.new_page(viewport={"width": DESK[0], "height": DESK[1]})
        page.goto(address)
        page.get_by_role("button", name="Practise on a campaign").click()
        page.get_by_role("heading", name="Compare").wait_for(timeout=120_000)
        assert (tmp_path / "results" / "practice" / "raw" / "campaign.yaml").exists()
        page.close()
    finally:
        process.terminate()
        process.wait(20)
