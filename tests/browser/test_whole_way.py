"""The way of a user, from the recordings to a model in which the error fell."""

import json
import re
import shutil

import pytest

from rovsim.apps.cli.main import main
from rovsim.core.axes import AXES
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import describe_effect
from rovsim.dynamics.model_file import read_model
from screens import READY, have_diagnosed, read_csv

pytestmark = pytest.mark.browser


@pytest.mark.usefixtures("few_figures")
def test_a_hidden_lag_is_found_added_and_saved_and_the_error_falls(tab, workbench, campaign):
    folder = workbench[1]
    tab.go("compare")
    tab.page.wait_for_selector("table")
    tab.picture("compare")
    compared = tab.numbers()

    have_diagnosed(tab)
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
    tab.page.wait_for_selector(READY["add"])
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
