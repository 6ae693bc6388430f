"""The workbench as its users meet it: from the recordings to a model in which the error fell."""

import csv
import json
import re
import shutil
from xml.etree import ElementTree

import pytest

from chromium import DARK
from rovsim import AXES
from rovsim.apps.cli.main import main
from rovsim.apps.workbench.traces import HORIZONS
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model_file import describe_effect, read_model
from rovsim.reporting.wording import rounded

pytestmark = pytest.mark.browser
READY = {  # what is there once a screen is drawn
    "compare": ".chart canvas", "where": ".chart canvas", "why": ".verdict",
    "add": "[data-name='run/now'][data-value]", "ladder": ".chart canvas",
    "models": ".chart canvas", "flight": "h1", "data": ".chart canvas", "gallery": "h1",
    "open": "h1",
}  # fmt: skip
SCREENS = tuple(READY)


CHANGED = (
    "([name, v]) => Number(document.querySelector(`[data-name='${name}']`).dataset.value) != v"
)
SAME = """() => {
  const [now, before] = ["now", "before"].map(
    name => Number(document.querySelector(`[data-name="run/${name}"]`).dataset.value));
  return Math.abs(now / before - 1) < 1e-3;
}"""
WHEEL = """document.querySelector('.path canvas').dispatchEvent(
  new WheelEvent('wheel', {deltaY: 100, bubbles: true, cancelable: true}))"""
# Another axis and another condition are told than at first.
MOVED = """first => {
  const named = told => told.split(':')[0].split(' over ');
  const now = named(document.querySelector('.half [role=status]').innerText);
  return named(first).every((part, k) => part != now[k]);
}"""
NUMBER = "document.querySelector(\"input[aria-label='thruster_lag, time_constant, number']\")"
# Least distance in px between the lower edge of a chart's legend and its icons, once all is drawn.
APART = """() => {
  const charts = [...document.querySelectorAll('.chart')].map(
    div => getElement(div.id.slice(1))?.chart?._componentsViews);
  if (charts.includes(undefined)) return null;  // what draws them is loaded on first use
  const box = view => {
    const rect = view.group.getBoundingRect().clone();
    rect.applyTransform(view.group.transform ?? [1, 0, 0, 1, 0, 0]);
    return rect;
  };
  return {px: Math.min(1e6, ...charts.flatMap(views => {
    const of = type => views.find(v => v.type == type);
    const [legend, icons] = [of("legend.scroll"), of("toolbox")];
    const middle = icons && box(icons).y + 0.5 * box(icons).height;  // room for labels is around
    return legend && icons ? [middle - 8 - box(legend).y - box(legend).height] : [];
  }))};
}"""
LATER = (
    "([name, v]) => Number(document.querySelector(`[role=slider][aria-label='${name}']`)"
    ".getAttribute('aria-valuenow')) > v"
)


def found(tab) -> None:
    """Have the campaign diagnosed, unless it is already."""
    tab.go("why")
    tab.page.wait_for_selector(".verdict, .onward")
    ask = tab.page.get_by_role("button", name="Find what is missing")
    if ask.count():
        ask.click()
        tab.page.get_by_role("button", name="Cancel").wait_for()
    tab.page.wait_for_selector(".verdict", timeout=180_000)


@pytest.mark.usefixtures("few_figures")
def test_a_hidden_lag_is_found_added_and_saved_and_the_error_falls(tab, workbench, campaign):
    folder = workbench[1]
    tab.go("compare")
    tab.page.wait_for_selector("table")
    tab.picture("compare")
    compared = tab.numbers()

    found(tab)
    (path,) = folder.glob("results/*/ui/*/diagnosis.json")
    diagnosis = json.loads(path.read_text())
    assert "lacks physics" in tab.page.locator(".verdict").inner_text()
    assert tab.page.locator(".effect h2").all_inner_texts() == ["thruster_lag"]
    shown = tab.numbers()
    for name, value in diagnosis["error"].items():
        assert shown[f"error/{name}"] == value
    for one in diagnosis["ranking"]:
        if (name := f"ranking/{one['effect']}/probability") in shown:
            assert shown[name] == one["probability"]
    here = re.compile("On your data: .*error over .*, without thruster_lag and with it")
    tab.page.get_by_role("img", name=here).wait_for()
    tab.picture("why")

    tab.page.get_by_role("button", name="Add what is missing").click()
    tab.page.wait_for_selector("[data-name='run/now'][data-value]")
    assert tab.page.get_by_role("checkbox", name="thruster_lag").is_checked()
    shown = tab.numbers("run/")
    assert shown["run/now"] < 0.3 * shown["run/before"]
    tab.picture("add")

    tab.page.get_by_label("Model file").fill("my models/repaired.yaml")
    tab.page.get_by_role("button", name="Save").click()
    tab.page.wait_for_selector("[data-name='saved/after']")
    saved = tab.numbers("saved/")
    assert saved["saved/before"] == pytest.approx(diagnosis["error"]["nominal"], rel=1e-5)
    assert saved["saved/after"] == pytest.approx(diagnosis["error"]["with_effects"], rel=1e-5)
    assert saved["saved/after"] < 0.3 * saved["saved/before"]
    file = folder / "my models" / "repaired.yaml"
    entry = describe_effect(read_model(file, built_in()).added[0]).plain()
    assert entry["parameters"] == diagnosis["selected"][0]["parameters"]

    assert tab.page.get_by_text("opened for one saved model").count() == 1
    assert tab.page.get_by_label("Model file").input_value().endswith("with_effects.yaml")

    tab.page.get_by_role("button", name="See the whole ladder").click()
    tab.page.wait_for_selector("table")
    steps = tab.numbers()
    for step in diagnosis["ladder"]["steps"]:
        assert steps[f"{step['model']}/windows_2s"] == step["windows_2s"]
    assert steps["repaired/windows_2s"] == saved["saved/after"]
    tab.picture("ladder")

    out = folder / "compared"
    main(["compare", f"campaign={campaign}", f"model=[nominal,{file}]", f"out={out}", "--quiet"])
    comparison = json.loads((out / "comparison.json").read_text())["models"]
    runs = comparison["nominal"]["runs"]
    shown = next(run for run, found in runs.items() if found["split"] == "train")
    run = comparison["nominal"]["runs"][shown]["windows"]["2"]
    for axis in AXES:
        assert compared[f"velocity_rmse/{axis}"] == run["velocity_rmse"][axis]
    assert compared["position_rmse_m"] == run["position_rmse_m"]
    errors = comparison["repaired"]["runs"][shown]["windows"]["2"]["velocity_rmse"]
    assert errors["surge"] < 0.5 * run["velocity_rmse"]["surge"]
    both_models_stand_beside_each_other(tab, comparison, shown, file)
    bands_are_drawn_where_they_are_known(tab)


def read_csv(download) -> list[dict[str, str]]:
    """The rows of a table that was saved, by the names of its columns."""
    with download.value.path().open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def bands_are_drawn_where_they_are_known(tab) -> None:
    """Of a model that a diagnosis ended with, open loop too; of others it says why not."""
    models = "models=repaired&models=nominal"
    tab.go(f"compare?{models}&quantity=eta&axes=surge&axes=yaw&horizon=None&bands=True")
    tab.page.wait_for_selector(READY["compare"])
    tab.page.wait_for_selector("text=No band for nominal")
    assert tab.page.get_by_role("switch", name="90% bands").is_checked()
    tab.picture("bands")
    with tab.page.expect_download() as values:
        tab.page.get_by_role("button", name="CSV: ").first.click()
    table = read_csv(values)
    width = next(name for name in table[0] if "north, repaired, width of the band (m)" in name)
    known = [float(row[width]) for row in table if row[width]]
    assert len(known) > 100
    assert min(known) >= 0.0
    assert known[-1] > 5.0 * known[10]
    tab.page.get_by_role("switch", name="90% bands").click()
    tab.page.wait_for_selector("text=No band for nominal", state="detached")


def both_models_stand_beside_each_other(tab, comparison, run, file) -> None:
    """The numbers of the comparison, after a reload too; a link may name what is gone."""
    tab.go(f"models?left=nominal&right=repaired&run={run}&axes=surge&horizon=5.0&from=1.0&to=4.0")
    for again in (False, True):
        if again:
            tab.page.reload()
        tab.page.wait_for_selector(READY["models"])
        tab.page.wait_for_function("location.search.includes('from=1.0&to=4.0')")
        numbers = tab.numbers()
        for name, found in comparison.items():
            scores = found["runs"][run]
            for at, metrics in {**scores["windows"], "open_loop": scores["open_loop"]}.items():
                for axis in AXES:
                    shown = numbers.get(f"{name}/{at}/{axis}")  # none: nothing to compare
                    assert shown == metrics["velocity_rmse"][axis]
    assert tab.page.get_by_role("rowheader", name="thruster_lag, time_constant").count() == 1
    tab.picture("models")
    other = file.with_name("other.yaml")
    shutil.copy(file, other)
    tab.page.get_by_label("Another model file").fill(str(other))
    tab.page.get_by_role("button", name="Open it on the right").click()
    tab.page.get_by_role("columnheader", name="other").first.wait_for()
    tab.go("models?left=nominal&right=gone")
    tab.page.wait_for_selector(READY["models"])


def test_a_slider_moves_the_replay_and_keys_alone_suffice(tab):
    found(tab)
    tab.page.keyboard.press("4")
    tab.page.wait_for_selector("[data-name='run/now'][data-value]")
    before = tab.numbers("run/now")["run/now"]
    tab.page.locator(".slider .q-slider__track-container").first.focus()
    for _ in range(40):
        tab.page.keyboard.press("PageDown")
    tab.page.wait_for_function(CHANGED, arg=["run/now", before])
    tab.page.wait_for_function(SAME)  # a busy machine follows the last key later
    tab.page.keyboard.press("1")
    tab.page.get_by_role("heading", name="Compare").wait_for()
    tab.page.keyboard.press("Tab")
    assert tab.page.evaluate("document.activeElement !== document.body")


def test_the_horizon_changes_the_errors_and_a_run_plays(tab):
    tab.go("compare")
    tab.page.wait_for_selector("table")
    before = tab.numbers()["velocity_rmse/surge"]
    tab.page.locator(".horizon .q-slider__track-container").focus()
    ends = (("ArrowLeft", "restarted every 0.5 s"), ("ArrowRight", "open loop"))
    for key, reached in 4 * ends:
        for _ in range(len(HORIZONS) - 1):  # no key of a fast hand is lost
            tab.page.keyboard.press(key)
        tab.page.get_by_text(f"Horizon, {reached}").wait_for()
    tab.page.wait_for_function(CHANGED, arg=["velocity_rmse/surge", before])
    tab.page.get_by_role("button", name="Play").click()
    tab.page.wait_for_function(LATER, arg=["Time in the run, seconds", 0.5])
    # Without a graphics card a click of the mouse waits for pictures of the tank: press at once.
    tab.page.get_by_role("button", name="Pause").dispatch_event("click")
    tab.page.get_by_role("button", name="Play").wait_for()


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


@pytest.mark.parametrize("screen", ["compare", "where", "add", "models"])
def test_where_axes_are_shown_it_says_which_way_they_point(tab, screen):
    tab.go(screen)
    tab.page.get_by_text("heave down").wait_for()


def test_a_wide_window_is_used(tab):
    tab.page.set_viewport_size({"width": 1920, "height": 1080})
    tab.go("compare")
    for one in (READY["compare"], ".path canvas"):
        tab.page.wait_for_selector(one)
        assert tab.page.locator(one).first.bounding_box()["width"] > 0.75 * 1920


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


def test_over_the_curves_the_wheel_moves_the_page_and_the_time_is_told_once(tab):
    tab.go("compare?axes=surge&axes=yaw")
    tab.page.wait_for_selector("table")
    curves = tab.page.locator(".chart canvas").first.bounding_box()
    at = (curves["x"] + 0.5 * curves["width"], curves["y"] + 100.0)
    tab.page.mouse.move(*at)
    tip = tab.page.locator(".chart").get_by_text("surge (m/s):")
    tip.wait_for()
    told = tip.locator("..").inner_text()
    assert len(re.findall(r"\d\.\d\d s$", told, re.MULTILINE)) == 1
    assert "yaw (rad/s): measured" in told
    tab.page.mouse.wheel(0, 200)
    tab.page.wait_for_function("scrollY > 50")
    tab.page.wait_for_selector(".path canvas")
    assert tab.page.evaluate(WHEEL)  # left to the page


def test_why_long_work_failed_stays_until_it_was_read(tab):
    tab.go("flight?asked=between&one=lift&other=lift&model=nominal")
    tab.page.get_by_role("button", name="Plan the flight").click()
    told = tab.page.get_by_role("alert").get_by_text("two different effects")
    told.wait_for()
    tab.go("data")
    told.wait_for()
    tab.page.get_by_role("button", name="Close").click()
    told.wait_for(state="hidden")


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


def test_what_was_added_is_typed_undone_and_put_back(tab, workbench):
    found(tab)
    (path,) = workbench[1].glob("results/*/ui/*/diagnosis.json")
    (fitted,) = json.loads(path.read_text())["selected"]
    tab.go("add")
    tab.page.wait_for_selector("[data-name='run/now'][data-value]")
    first = tab.numbers("run/now")["run/now"]
    number = tab.page.get_by_label("thruster_lag, time_constant, number")
    kept = number.input_value()
    number.fill("0.9")
    number.press("Enter")
    tab.page.wait_for_function(CHANGED, arg=["run/now", first])
    tab.page.get_by_role("button", name="Undo").click()
    tab.page.wait_for_function(f"!({CHANGED})({json.dumps(['run/now', first])})")
    assert number.input_value() == kept
    number.fill("0.9")
    number.press("Enter")
    tab.page.wait_for_function(CHANGED, arg=["run/now", first])
    tab.page.get_by_role("button", name="back to where it began").click()
    begun = rounded(fitted["parameters"]["time_constant"]["value"])
    tab.page.wait_for_function(f"Number({NUMBER}.value) == {begun}")


def test_notes_lie_beside_the_campaign(tab, campaign):
    tab.go("data")
    tab.page.get_by_label("Kept in").fill("Run 6dof-1: the tether was slack.")
    tab.page.get_by_role("link", name="Compare").click()
    tab.page.get_by_role("heading", name="Compare").wait_for()
    tab.go("data")
    assert tab.page.get_by_label("Kept in").input_value() == "Run 6dof-1: the tether was slack."
    tab.picture("data")
    assert (campaign / "notes.md").read_text() == "Run 6dof-1: the tether was slack."


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


def test_long_work_can_be_cancelled_and_changes_nothing(tab, workbench):
    found(tab)
    before = tab.numbers()
    tab.page.get_by_role("button", name="Diagnose again").click()
    tab.page.get_by_role("button", name="Cancel").click()
    tab.page.get_by_text("cancelled, nothing was changed").wait_for()
    tab.page.wait_for_selector(".verdict")
    assert tab.numbers() == before
    (path,) = workbench[1].glob("results/*/ui/*/*.*")
    assert path.name == "diagnosis.json"


def test_planning_a_flight_is_long_work_and_can_be_cancelled(tab, workbench):
    tab.go("flight?asked=between&one=thruster_lag&other=lift&seconds=30&model=nominal")
    plan = tab.page.get_by_role("button", name="Plan the flight")
    plan.click()
    tab.page.get_by_role("button", name="Cancel").click()
    tab.page.get_by_text("cancelled, nothing was changed").wait_for()
    plan.wait_for()
    assert not list(workbench[1].glob("results/*/ui/flights/*/*"))


def test_a_planned_flight_is_shown_with_what_it_promises_and_what_to_do(tab, phone, planned):
    address, folder = planned
    for one in (tab, phone):
        one.go(address)
        one.page.get_by_role("heading", name="A flight of 20 s").wait_for()
        picture = one.page.get_by_role("img", name="The predicted path")
        assert picture.evaluate("e => e.decode().then(() => e.naturalWidth)") > 500
        assert one.numbers() == {"thruster_lag.time_constant/now": 0.02,
                                 "thruster_lag.time_constant/then": 0.005}  # fmt: skip
        assert one.page.get_by_text("over a million").count() == 1
        assert one.page.get_by_role("listitem").all_inner_texts()[-1] == "Send experiment.csv."
        assert one.page.evaluate("document.scrollingElement.scrollWidth - innerWidth") <= 0
    tab.picture("flight")
    with tab.page.expect_download() as log:
        tab.page.get_by_role("button", name="Commands (experiment.csv)").click()
    assert log.value.path().read_bytes() == (folder / "experiment.csv").read_bytes()
    tab.page.get_by_role("spinbutton", name="Seconds").fill("25")
    tab.page.get_by_role("button", name="Plan the flight").wait_for()  # another question
    tab.page.wait_for_function("location.search.includes('seconds=25')")


@pytest.mark.parametrize("screen", SCREENS)
def test_every_screen_fits_a_desk_and_a_phone(tab, phone, screen):
    for one in (tab, phone):
        if screen in ("why", "add", "ladder"):
            found(one)
        one.go(screen)
        page = one.page
        page.wait_for_selector(READY[screen])
        apart = page.wait_for_function(APART).json_value()["px"]
        assert apart > 0, f"{screen}: icons cover the legend by {-apart} px"
        wide = page.evaluate("document.scrollingElement.scrollWidth - innerWidth")
        assert wide <= 0, f"{screen} is {wide} px too wide"
        small = page.evaluate(
            "Math.min(...[...document.querySelectorAll('.screen *')].filter(e => e.offsetWidth"
            " && [...e.childNodes].some(n => n.nodeType == 3 && n.data.trim()))"
            ".map(e => parseFloat(getComputedStyle(e).fontSize)))"
        )
        assert small >= 11
    if screen == "why":
        phone.picture("phone-why")


def test_every_screen_is_accessible_in_light_and_dark(tab, planned):
    pytest.importorskip("axe_playwright_python")
    found(tab)
    broken, shades = [], set()
    for screen, ready in {
        **READY,
        "open": "h1",
        "gallery/thruster_lag": "h1",
        "gallery/onboard_control": "h1",  # the widest equation
        planned[0]: "ol",
    }.items():
        tab.go(screen)
        tab.page.wait_for_selector(ready)
        for scheme in tab.schemes():
            shades.add(tab.page.evaluate("getComputedStyle(document.body).backgroundColor"))
            broken += [f"{screen}, {scheme}: {one}" for one in tab.violations()]
    assert broken == []
    assert len(shades) == 2


def test_light_and_dark_turn_and_are_remembered(tab):
    tab.page.emulate_media(color_scheme="light")
    tab.go("gallery")
    assert not tab.page.evaluate(DARK)
    tab.picture("effects")
    tab.page.get_by_role("button", name="Light or dark").click()
    tab.page.wait_for_function(DARK)
    tab.go("gallery")
    tab.page.wait_for_function(DARK)


def test_a_chart_is_kept_as_a_picture_and_as_values(tab):
    tab.go("compare?run=3dof-1")
    tab.page.wait_for_selector(READY["compare"])
    with tab.page.expect_download() as picture:
        tab.page.get_by_role("button", name="PNG: ").first.click()
    assert picture.value.path().read_bytes().startswith(b"\x89PNG")
    with tab.page.expect_download() as lines:
        tab.page.get_by_role("button", name="SVG: ").click()
    drawn = ElementTree.fromstring(lines.value.path().read_text())
    assert drawn.tag.endswith("svg")
    words = {"".join(text.itertext()) for text in drawn.iter() if text.tag.endswith("text")}
    assert any("measured" in word for word in words)
    assert len([one for one in drawn.iter() if one.tag.endswith("path")]) > 10
    with tab.page.expect_download() as values:
        tab.page.get_by_role("button", name="CSV: ").first.click()
    table = read_csv(values)
    named = "3dof-1 surge velocity, {} (m/s)"
    assert {"time (s)", *map(named.format, ("measured", "nominal", "measured − nominal"))} <= set(
        table[0]
    )
    known = [row for row in table if all(row[named.format(n)] for n in ("measured", "nominal"))]
    assert len(known) > 100
    missed = [float(row[named.format("measured − nominal")]) for row in known]
    for row, one in zip(known, missed, strict=True):
        apart = float(row[named.format("measured")]) - float(row[named.format("nominal")])
        assert one == pytest.approx(apart, abs=2e-5)
    with tab.page.expect_download() as values:
        tab.page.get_by_role("button", name="CSV: Path in the tank").click()
    table = read_csv(values)
    assert list(table[0])[:3] == [
        "time (s)",
        "3dof-1 measured, north (m)",
        "3dof-1 measured, east (m)",
    ]
    assert len([row for row in table if row["3dof-1 nominal, down (m)"]]) > 100
