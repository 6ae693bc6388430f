"""The workbench and a real Chromium that looks at it, once for all tests."""

from pathlib import Path

import pytest

from chromium import DESK, FLAGS, PHONE, PICTURES, Tab, installed, started
from rovsim.apps.cli.main import main


@pytest.fixture(scope="session")
def chromium():
    """A running Chromium; the test is skipped, with the reason, where there is none."""
    api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    found = installed()
    with api.sync_playwright() as driver:
        if found is None and not Path(driver.chromium.executable_path).exists():
            pytest.skip("no Chromium is installed: `make test-ui` installs one")
        browser = driver.chromium.launch(executable_path=found, args=list(FLAGS))
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def campaign(chromium, tmp_path_factory):
    """A tank that hides a thruster lag."""
    out = tmp_path_factory.mktemp("hidden") / "raw"
    main(["tank", f"tank={'practice' if PICTURES else 'tiny'}", f"out={out}", "--quiet"])
    return out


@pytest.fixture(scope="session")
def workbench(campaign, tmp_path_factory):
    """Address and folder of a workbench with that campaign."""
    folder = tmp_path_factory.mktemp("desk")
    process, address = started(folder, f"campaign={campaign}")
    yield address, folder
    process.terminate()
    process.wait(20)


@pytest.fixture
def tab(chromium, workbench):
    """A tab of a desk's size; in the end there is nothing to complain about."""
    yield from _tab(chromium, workbench[0], DESK)


@pytest.fixture
def phone(chromium, workbench):
    """The same on a phone."""
    yield from _tab(chromium, workbench[0], PHONE)


def _tab(chromium, address, size):
    page = chromium.new_page(viewport={"width": size[0], "height": size[1]})
    page.set_default_timeout(60_000)
    found = Tab(page, address)
    yield found
    page.close()
    assert found.complaints == []
