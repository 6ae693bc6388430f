"""Models put together in the workbench: ticked, moved, undone, saved, and never over another."""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import synthetic_study
from rovsim.apps.workbench.add_effects import tell_doubt
from rovsim.apps.workbench.draft import Draft, reach
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model_file import describe_model, read_model, write_model
from rovsim.reporting.words.totals import list_totals, tell_total
from rovsim.results.fitted import Posterior
from worlds import model


@pytest.mark.parametrize(
    ("name", "found"),
    [("nominal.yaml", "as another"), ("new.json", "yaml"), ("campaign.yaml", "there already")],
)
def test_saving_never_destroys_or_shadows_anything(bench, tmp_path, monkeypatch, name, found):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / name
    path.write_text("name: mine\n")
    with pytest.raises(BadInput, match=found):
        bench.save(path)
    assert path.read_text() == "name: mine\n"


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (3.0, ("in all 13.7 + 3.00 = 16.7 kg/s", "")),
        (-20.0, ("in all 13.7 − 20.0 = −6.30 kg/s", "water would push, not brake")),
    ],
)
def test_a_coefficient_is_told_with_what_it_comes_to(bench, value, told):
    body = replace(bench.base.body, linear=np.array([13.7, 0, 33, 0, 0.8, 0]))
    assert tell_total(body, "linear_damping", "surge", value, "kg/s") == told
    assert tell_total(body, "thruster_lag", "time_constant", value) == ("", "")


def test_an_effect_that_the_diagnosis_did_not_select_says_how_unlikely_it_is():
    draft = Draft(model(), synthetic_study.several_effects(), built_in())
    assert tell_doubt("thrust_asymmetry", draft) == ""
    assert "did not select it: probability below 0.001" in tell_doubt("thruster_gain", draft)
    assert "may fit noise" in tell_doubt("payload", draft)  # not in the ranking
    assert tell_doubt("payload", Draft(model(), None, built_in())) == ""


def test_how_sure_a_draft_is_goes_with_what_was_found():
    fitted = synthetic_study.a_lag().model_copy(
        update={"posterior": Posterior(), "base": describe_model(model())}
    )
    draft = Draft(model(), fitted, built_in())
    assert draft.model().uncertainty is not None
    draft.move("thruster_lag", "time_constant", 0.3)
    assert draft.model().uncertainty is None
    draft.undo()
    draft.tick("lift", True)
    assert draft.model().uncertainty is None


def test_a_change_is_undone_and_a_drag_of_a_slider_is_one():
    draft = Draft(model(), synthetic_study.a_lag(), built_in())
    assert not draft.changed
    for value in (0.2, 0.3, 0.4):
        draft.move("thruster_lag", "time_constant", value)
    draft.tick("lift", True)
    assert draft.ticked == ["thruster_lag", "lift"]
    draft.undo()
    assert draft.ticked == ["thruster_lag"]
    assert draft.entry("thruster_lag").values == {"time_constant": 0.4}
    draft.undo()
    assert draft.entry("thruster_lag").values == {"time_constant": 0.18}
    draft.move("thruster_lag", "time_constant", 0.5)
    draft.reset("thruster_lag", "time_constant")
    assert draft.entry("thruster_lag").values == {"time_constant": 0.18}
    draft.undo()
    assert draft.entry("thruster_lag").values == {"time_constant": 0.5}


def test_what_was_found_stays_whatever_is_ticked_or_moved():
    draft = Draft(model(), synthetic_study.a_lag(), built_in())
    draft.move("thruster_lag", "time_constant", 0.9)
    draft.tick("thruster_lag", False)
    (lag,) = draft.fitted_model().added
    assert lag.id == "thruster_lag"
    assert lag["time_constant"] != 0.9
    assert not draft.fitted_model(but="thruster_lag").added
    assert draft.fitted_model() is draft.fitted_model()  # what is computed of it is found again


def test_a_value_moved_again_later_is_another_change(monkeypatch):
    draft = Draft(model(), synthetic_study.a_lag(), built_in())
    draft.move("thruster_lag", "time_constant", 0.2)
    now = time.monotonic()
    monkeypatch.setattr("time.monotonic", lambda: now + 60.0)
    draft.move("thruster_lag", "time_constant", 0.3)
    draft.undo()
    assert draft.entry("thruster_lag").values == {"time_constant": 0.2}


def test_saving_stays_where_the_workbench_is(bench, tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    (tmp_path / "here" / "link").symlink_to(tmp_path)
    for name in ("../out.yaml", str(tmp_path / "out.yaml"), "link/out.yaml"):
        with pytest.raises(BadInput, match="outside"):
            bench.save(Path(name))
    assert not (tmp_path / "out.yaml").exists()


def test_a_saved_draft_is_one_of_the_models_and_no_other_goes_over_it(bench, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    here = Workbench(bench.settings, built_in(), bench.data, dict(bench.models), dict(bench.paths))
    here.draft.tick("thruster_lag", True)
    for name, value in (("lagging", 0.1), ("more", 0.2)):
        here.draft.move("thruster_lag", "time_constant", value)
        saved = here.save(tmp_path / f"{name}.yaml")
        assert here.models[name] is saved
        assert saved.added[0]["time_constant"] == value
        with pytest.raises(BadInput, match="there already"):
            here.save(tmp_path / "lagging.yaml")
    assert here.models["lagging"].added[0]["time_constant"] == 0.1
    assert here.base.name == "nominal"


def test_a_diagnosis_of_effects_that_are_not_known_here_can_be_looked_at():
    found = synthetic_study.a_lag()
    own = found.selected[0].model_copy(update={"effect": "own_effect"})
    draft = Draft(
        model(), found.model_copy(update={"selected": (own, *found.selected)}), built_in()
    )
    assert draft.unknown == ["own_effect"]
    assert draft.ticked == [one.effect for one in found.selected]
    assert "own_effect" not in draft.fitted
    draft.model()


def test_a_model_without_forces_is_no_base(bench):
    inert = bench.settings.model_copy(update={"model": "zero_acceleration"})
    with pytest.raises(BadInput, match="no forces"):
        Workbench.opened(inert, built_in())


def test_totals_are_the_vehicle_file_and_what_was_added(bench):
    draft = Draft(bench.base, None, built_in())
    draft.tick("linear_damping", True)
    draft.move("linear_damping", "sway", -30.0)
    before, after = list_totals(bench.base.body), list_totals(draft.model().body)
    changed = {key: after[key] - before[key] for key in before if after[key] != before[key]}
    assert changed.pop(("linear_damping", "sway")) == pytest.approx(-30.0)
    assert changed == {}


def test_each_saved_model_that_opens_the_test_runs_is_counted(bench, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    own = bench.settings.model_copy(update={"out": str(tmp_path / "out")})
    here = Workbench(own, built_in(), bench.data, dict(bench.models), dict(bench.paths))
    for opened, name in enumerate(("with_effects.yaml", "with_effects_2.yaml"), 1):
        path = here.free_path()
        assert path.name == name  # never the one before
        assert here.note_opening(here.save(path)) == opened
    kept = (tmp_path / "out" / "test_runs_opened.csv").read_text().splitlines()
    assert [line.split(",")[0] for line in kept] == ["model", "with_effects", "with_effects_2"]


def test_a_draft_begins_as_the_diagnosis_and_what_is_saved_is_read_back(tmp_path):
    draft = Draft(model(), synthetic_study.a_lag(), built_in())
    write_model(draft.model(), tmp_path / "new.yaml")
    (lag,) = read_model(tmp_path / "new.yaml", built_in()).added
    assert (lag["time_constant"], lag.std) == (0.18, {"time_constant": 0.01})
    draft.move("thruster_lag", "time_constant", 0.25)
    moved = draft.entry("thruster_lag").parameters["time_constant"]
    assert (moved.value, moved.std) == (0.25, None)  # the interval was that of the fit
    draft.tick("thruster_lag", False)
    assert describe_model(draft.model())["effects"] == []


@pytest.mark.parametrize("effect", built_in())
def test_every_effect_can_be_added_and_moved_within_its_sliders(effect):
    draft = Draft(model(), None, built_in())
    draft.tick(effect, True)
    known = {p.name: p for p in built_in()[effect].parameters}
    for name, value in draft.entry(effect).parameters.items():
        low, high = reach(known[name], value.value)
        assert known[name].low <= low <= value.value <= high <= known[name].high
        assert low < high
        draft.move(effect, name, high)
    assert draft.model().added[0].id == effect


def test_values_no_model_can_have_are_refused():
    draft = Draft(model(), None, built_in())
    draft.tick("added_mass", True)
    draft.move("added_mass", "surge", -1e4)
    with pytest.raises(BadInput):
        draft.model()
