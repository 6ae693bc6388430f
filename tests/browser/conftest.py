"""The workbench and a real Chromium that looks at it, once for all tests."""

from pathlib import Path

import numpy as np
import pytest

from chromium import DESK, FLAGS, LOG, PHONE, PICTURES, Tab, installed, started
from rovsim.application.configuration import compose
from rovsim.application.pipeline.design import Designed, write_flight
from rovsim.application.settings import select
from rovsim.apps.cli.main import main
from rovsim.apps.workbench.workbench import Workbench
from rovsim.design.settings import Question
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.reporting.figures.planned_flight import PlannedFlight
from rovsim.results.experiment import Experiment, Keeps, RivalOdds, Start, Surer, UsualManoeuvre
from synthetic_study import several_effects

RIVALS = ("thruster_lag", "input_delay")


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
    # of ours: a page that leaves in the middle of an answer may end in one of the server's own
    assert "src/rovsim/" not in (folder / LOG).read_text()


@pytest.fixture(scope="session")
def diagnosed(campaign, tmp_path_factory):
    """Address of a workbench that was given a diagnosis, and its file; nothing is searched."""
    folder = tmp_path_factory.mktemp("diagnosed")
    file = folder / "diagnosis.json"
    several_effects().write(file)
    process, address = started(folder, f"campaign={campaign}", f"diagnosis={file}")
    yield address, file
    process.terminate()
    process.wait(20)
    assert "src/rovsim/" not in (folder / LOG).read_text()


@pytest.fixture(scope="session")
def planned(workbench, campaign):
    """Address of a flight that was planned before, as `rovsim design` writes one, and its folder.

    The search itself takes a minute; tests/workflow/test_tutorial_next_flight.py runs it.
    """
    settings = compose([f"campaign='{campaign}'", "seconds=20"])
    bench = Workbench.opened(settings, built_in())
    chosen = select(settings, DiagnosisSettings)
    question = Question.of(chosen, settings.design, "the test", between=RIVALS, seconds=20.0)
    folder = workbench[1] / bench.flight_folder("nominal", question)
    write_flight(folder, flight())
    one, other = RIVALS
    return f"flight?asked=between&one={one}&other={other}&seconds=20&model=nominal", folder


def flight() -> Designed:
    """A flight of few numbers."""
    odds = RivalOdds(now=2.0, then=1e9, log_odds_now=0.69, log_odds_then=20.7)
    std = Surer(now=0.02, then=0.005, unit="s", gained=15.0)
    expected = {"odds": {RIVALS[0]: odds}, "std": {f"{RIVALS[0]}.time_constant": std}}
    usual = UsualManoeuvre(**expected, amplitude=(0.5, 0.2), designed_is_better=4.0)
    known = Experiment(
        seconds=20.0,
        model="nominal",
        between=RIVALS,
        start=Start(x_m=5, y_m=2, z_m=1, yaw_rad=0),
        manoeuvre="designed",
        expects=expected,
        baselines={"zigzag": usual},
        keeps=Keeps(nearest_wall_m=0.8, speed_m_s=0.5, turn_rate_rad_s=0.4, tilt_rad=0.1),
        instructions=(
            "Put the vehicle where it starts.",
            "Send experiment.csv.",
            "By hand, instead of step 2:",
            "Surge: swing it.",
            "Leave alone: sway.",
        ),
    )
    time = np.linspace(0.0, 20.0, 101)
    turn = 0.2 * np.pi * time
    path = np.stack(
        [5.0 + 3.0 * np.sin(turn), -2.5 + 1.2 * np.sin(2.0 * turn), -1.5 + 0.5 * np.cos(turn)], 1
    )
    tank = np.array([[0.0, 10.0], [-5.0, 0.0], [-3.0, 0.0]])
    values = 1500.0 + 100.0 * np.sin(time)[:, None]
    picture = PlannedFlight(np.stack([path, path + 0.1]), tank, time, values, ("t1",), "µs")
    return Designed(known, "time_s,t1\n0.00,1500\n", picture)


@pytest.fixture(scope="session")
def profile(chromium):
    """One for all tests, as a user has: scripts that were loaded and compiled once stay so."""
    with chromium.new_context() as context:
        yield context


@pytest.fixture
def tab(profile, workbench):
    """A tab of a desk's size; in the end there is nothing to complain about."""
    yield from _tab(profile, workbench[0], DESK)


@pytest.fixture
def diagnosed_tab(profile, diagnosed):
    """The same on the workbench with that diagnosis."""
    yield from _tab(profile, diagnosed[0], DESK)


@pytest.fixture
def phone(profile, workbench):
    """The same on a phone."""
    yield from _tab(profile, workbench[0], PHONE)


def _tab(profile, address, size):
    page = profile.new_page()
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.set_default_timeout(60_000)
    found = Tab(page, address)
    yield found
    page.evaluate("localStorage.clear()")  # what one test remembered is not the next one's
    page.close()
    profile.clear_cookies()
    assert found.complaints == []
