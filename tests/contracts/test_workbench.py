"""The workbench shows what the commands write; long work reports, ends, can be cancelled."""

import csv
import logging
import shutil
import socket
import time
from dataclasses import replace
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from starlette.datastructures import QueryParams

import synthetic_study
from chores import counting, dying, failing
from rovsim.application.pipeline.comparison import compare
from rovsim.application.settings import compose
from rovsim.apps.cli.main import main
from rovsim.apps.workbench import app, charts, models, parts, path, runaway, tasks, why
from rovsim.apps.workbench.add_effects import tell_doubt
from rovsim.apps.workbench.charts import Panel
from rovsim.apps.workbench.draft import Draft, reach
from rovsim.apps.workbench.models import Models
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.totals import list_totals, tell_total
from rovsim.apps.workbench.traces import beside, panels
from rovsim.apps.workbench.work import LongWork, Work, reap
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.errors import BadInput
from rovsim.core.files import read_json
from rovsim.core.rotations import short_way, to_euler
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model_file import describe_model, read_model, write_model
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import Posterior
from rovsim.results.ladder import Ladder, Step
from rovsim.simulation.bands import Band
from said import unfolded
from worlds import model


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    """A workbench with a tiny campaign, in a folder of its own."""
    folder = tmp_path_factory.mktemp("desk")
    main(["tank", "tank=tiny", "tank.duration=8", f"out={folder / 'raw'}", "-q"])
    settings = compose([f"campaign='{folder / 'raw'}'", f"out='{folder / 'out'}'"])
    return Workbench.opened(settings, built_in())


def diagnosis():
    """A diagnosis that selects a lag with a fitted value."""
    lag = {"effect": "thruster_lag", "parameters": {"time_constant": {"value": 0.18, "std": 0.01}}}
    content = synthetic_study.diagnosis({"steps": []}) | {"selected": [lag], "ranking": []}
    return Diagnosis.model_validate(content)


@pytest.mark.parametrize("horizon", [0.5, 2.0, 5.0, None])
def test_its_errors_are_those_of_the_comparison(bench, horizon):
    found = compare(bench.data, [bench.base], bench.settings).comparison.models["nominal"]
    for run, scores in found.runs.items():
        told = scores.open_loop if horizon is None else scores.windows[f"{horizon:g}"]
        assert bench.replays.metrics(bench.base, run, horizon) == told


def test_its_ladder_holds_the_diagnosis_the_models_and_the_floor_last(bench, monkeypatch):
    found = (Step(model="+lag", windows_2s=0.1), Step(model="noise_floor", windows_2s=0.05))
    ladder = Ladder(steps=(bench.replays.step(bench.base), *found))
    monkeypatch.setattr(bench, "diagnosis", diagnosis().model_copy(update={"ladder": ladder}))
    names = [s.model for s in bench.ladder().steps]
    assert names == ["zero_acceleration", "nominal", "+lag", "noise_floor"]


def test_a_disturbance_is_drawn(tmp_path):
    found = synthetic_study.several_effects().unexplained.disturbance
    file = tmp_path / "pictures" / "disturbance.png"
    why.draw_disturbance(found, file)
    assert file.read_bytes().startswith(b"\x89PNG")


def test_likely_effects_are_shown_however_little_they_remove_alone():
    shown = [r.effect for r in why.list_worth_showing(synthetic_study.several_effects().ranking)]
    assert shown[:3] == ["thrust_asymmetry", "voltage_sag", "quadratic_damping"]
    assert len(shown) == why.SHOWN
    assert "input_delay" not in shown  # neither likely nor of any use


LAW = """
from rovsim.dynamics.effects.base import Parameter, Wrench


class ProposedEffect(Wrench):
    \"\"\"A law.\"\"\"

    id, equation, neglects, source = "proposed_effect", "Y = c v", "", ""
    parameters = (Parameter("sway", "N s/m", "c", scale=1.0),)

    @staticmethod
    def wrench(at, p):
        return 0.0, p.sway * at.nu_r[1], 0.0, 0.0, 0.0, 0.0
"""


def test_a_law_is_run_only_when_it_is_taken_in(bench):
    law = {
        "axis": "sway", "equation": "Y = c v", "file": "proposed_effect.py",
        "parameters": {"sway": {"value": -4.0, "std": 0.1, "unit": "N s/m"}},
        "error_reduction": 0.5, "effect": "proposed_effect", "meaning": "", "terms": [],
    }  # fmt: skip
    content = diagnosis().to_json()
    content["unexplained"] |= {"proposal": law}
    own = Workbench(bench.settings, bench.catalogue, bench.data, bench.models, bench.paths)
    own.found(Diagnosis.model_validate(content))
    assert own.draft.ticked == ["thruster_lag"]
    with pytest.raises(BadInput):
        own.take_law()
    own.law_path.parent.mkdir(parents=True, exist_ok=True)
    own.law_path.write_text(LAW, encoding="utf-8")
    own.take_law()
    assert own.draft.ticked == ["proposed_effect"]
    assert own.draft.model().added[-1].given() == {"sway": -4.0}
    assert own.settings.effect_files == [own.law_path]


def test_a_diagnosis_of_other_recordings_settings_or_models_is_not_shown(bench):
    path = bench.diagnosis_path
    other = bench.settings.model_copy(update={"seed": 7})
    assert (
        Workbench(other, built_in(), bench.data, bench.models, bench.paths).diagnosis_path != path
    )
    assert (
        Workbench(bench.settings, built_in(), bench.data, bench.models, bench.paths).diagnosis_path
        == path
    )
    lagging = {"nominal": Draft(bench.base, diagnosis(), built_in()).model()}
    assert (
        Workbench(bench.settings, built_in(), bench.data, lagging, bench.paths).diagnosis_path
        != path
    )


def test_a_campaign_that_cannot_be_read_is_one_message(tmp_path):
    with pytest.raises(BadInput, match="nowhere"):
        Workbench.opened(compose([f"campaign='{tmp_path / 'nowhere'}'"]), built_in())


def test_what_is_trained_is_a_model_of_its_own_name_and_the_report_has_all(bench, monkeypatch):
    drawn = []
    monkeypatch.setattr("rovsim.reporting.html.folder.present", lambda *given: drawn.append(given))
    here = Workbench(bench.settings, built_in(), bench.data, dict(bench.models), dict(bench.paths))
    file = tasks.train_into(here.only("nominal"), here.out / "knn_6dof.yaml")
    here.add(read_model(file, built_in()), file)
    page = tasks.report_into(here.only(*here.models), here.ladder(), None, here.out)
    assert page.name == "report.html"
    assert len(drawn) == 1
    comparison = read_json(here.out / "comparison.json")["models"]
    assert list(comparison) == ["nominal", "knn_6dof"]
    for name, one in here.models.items():
        for run, scores in comparison[name]["runs"].items():
            assert here.replays.metrics(one, run, 2.0).model_dump() == scores["windows"]["2"]
    steps = read_json(here.out / "ladder.json")["steps"]
    assert [s["model"] for s in steps] == ["zero_acceleration", "nominal", "knn_6dof"]


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


def test_a_replay_that_diverges_is_told_and_cut_beside_the_measurement(bench):
    draft = Draft(bench.base, None, built_in())
    draft.tick("quadratic_damping", True)
    draft.move("quadratic_damping", "surge", -230.0)
    motion = bench.data.motions["3dof-1"]
    wild = bench.replays.prediction(draft.model(), "3dof-1", 2.0)
    at = runaway.find_divergence(motion.time, wild)
    assert 0.0 < at < motion.time[-1] - motion.time[0]
    said = runaway.tell_divergence(motion.time, {"new": wild})
    assert said.startswith(f"The replay of new diverges after {at:.1f} s;")
    for quantity in ("nu", "nu_dot", "eta"):
        shown = panels(motion, {"new": wild}, ["surge", "yaw"], quantity)
        size = np.nanmax(np.abs(shown[0].curves["measured"]))
        assert np.nanmax(np.abs(shown[0].curves["new"])) < 5.0 * size
    lost = bench.replays.prediction(draft.model(), "3dof-1", None)
    assert "nothing of it can be shown" in runaway.tell_divergence(motion.time, {"new": lost})
    calm = bench.replays.prediction(bench.base, "3dof-1", 2.0)
    assert runaway.tell_divergence(motion.time, {"nominal": calm}) == ""


def test_an_effect_that_the_diagnosis_did_not_select_says_how_unlikely_it_is():
    draft = Draft(model(), synthetic_study.several_effects(), built_in())
    assert tell_doubt("thrust_asymmetry", draft) == ""
    assert "did not select it: probability below 0.001" in tell_doubt("thruster_gain", draft)
    assert "may fit noise" in tell_doubt("payload", draft)  # not in the ranking
    assert tell_doubt("payload", Draft(model(), None, built_in())) == ""


def test_a_pose_is_shown_in_the_tank_and_turns_the_short_way(bench):
    motion = bench.data.motions["6dof-1"]
    shown = panels(
        motion, {"m": bench.replays.prediction(bench.base, "6dof-1", 2.0)}, ["heave", "yaw"], "eta"
    )
    titles = ["down", "down: measured − model", "yaw", "yaw: measured − model"]
    assert [panel.title for panel in shown] == titles
    usable = motion.usable
    np.testing.assert_allclose(shown[0].curves["measured"][usable], motion.eta[usable, 2])
    missed = shown[3].curves["m"]
    assert np.nanmax(np.abs(missed)) <= np.pi


def test_under_each_axis_is_what_the_commands_push_along_it(bench):
    motion = bench.data.motions["6dof-1"]
    thrust = bench.replays.thrust(bench.base, "6dof-1")
    assert thrust.shape == (len(motion.time), 6)
    shown = panels(motion, {}, ["sway", "yaw"], "nu", thrust)
    assert [(panel.title, panel.unit) for panel in shown[2::3]] == [
        ("sway: thrust by the commands", "N"), ("yaw: thrust by the commands", "N m"),
    ]  # fmt: skip
    np.testing.assert_array_equal(shown[5].curves["commanded"], thrust[:, 5])


def test_a_band_lies_about_its_curve_and_about_the_difference(bench):
    motion, predicted = (
        bench.data.motions["6dof-1"],
        bench.replays.prediction(bench.base, "6dof-1", 2.0),
    )
    nu, angle = predicted.nu, to_euler(predicted.eta[:, 3:])
    place = np.hstack([predicted.eta[:, :3], angle])
    band = Band(np.stack([nu - 0.1, nu + 0.3]), np.stack([place - 0.1, place + 0.3]))
    for quantity in ("nu", "eta"):
        shown = panels(motion, {"m": predicted}, ["yaw"], quantity, bands={"m": band})
        low, high = shown[1].bands["m"]
        known = np.isfinite(low)
        assert known.sum() > 100
        np.testing.assert_allclose(short_way(low[known]), -0.1, atol=1e-9)
        np.testing.assert_allclose(high - low, np.where(known, 0.4, np.nan), atol=1e-9)
    low, wide = charts.series_data(motion.time, shown[:1], ("measured", "m"))
    assert (low["id"], wide["id"]) == (
        "0/m/low end of the band", "0/m/width of the band",
    )  # fmt: skip
    options = charts.time_series(motion.time, shown, charts.styles(["measured", "m"]))
    drawn = {one["id"]: one for one in options["series"]}
    assert drawn[low["id"]]["stack"] == drawn[wide["id"]]["stack"] != drawn["0/m"].get("stack")
    assert (
        drawn[low["id"]]["areaStyle"]["opacity"] == 0.0 < drawn[wide["id"]]["areaStyle"]["opacity"]
    )


def test_how_sure_a_draft_is_goes_with_what_was_found():
    fitted = diagnosis().model_copy(
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
    draft = Draft(model(), diagnosis(), built_in())
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
    draft = Draft(model(), diagnosis(), built_in())
    draft.move("thruster_lag", "time_constant", 0.9)
    draft.tick("thruster_lag", False)
    (lag,) = draft.found().added
    assert lag.id == "thruster_lag"
    assert lag["time_constant"] != 0.9
    assert not draft.found(but="thruster_lag").added
    assert draft.found() is draft.found()  # what is computed of it is found again


def test_a_value_moved_again_later_is_another_change(monkeypatch):
    draft = Draft(model(), diagnosis(), built_in())
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
    found = diagnosis()
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


def test_an_address_holds_what_is_chosen_also_where_that_is_none(monkeypatch):
    told = []
    monkeypatch.setattr("nicegui.ui.navigate.history.replace", told.append)
    place = Place("compare", QueryParams("horizon=None"))
    chosen = place.choose({"horizon": 2.0, "axis": None}, {"horizon": (2.0, None)})
    assert chosen["horizon"] is None
    place.tell(chosen)
    assert told == ["/compare?horizon=None"]
    assert Place("compare", QueryParams(told[0].partition("?")[2])).choose(
        {"horizon": 2.0}, {"horizon": (2.0, None)}
    ) == {"horizon": None}


def test_long_work_is_not_ended_by_other_work():
    works = LongWork()
    works.begin("one", print, time.sleep, 60.0)
    with pytest.raises(BadInput, match="'one' goes on"):
        works.begin("two", print, time.sleep, 60.0)
    assert works.now.state == "running"
    works.now.cancel()


def test_models_saved_before_are_known_and_no_two_share_a_name(bench, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    here = Workbench(bench.settings, built_in(), bench.data, dict(bench.models), dict(bench.paths))
    write_model(Draft(bench.base, diagnosis(), built_in()).model(), here.saved_in / "before.yaml")
    assert list(here.known_models()) == ["nominal", "before"]
    found = here.known_model("before")
    assert found.added[0].id == "thruster_lag"
    assert here.open_model(here.saved_in / "before.yaml") is found  # its replays are kept
    assert here.known_model("nominal") is here.base
    shutil.copy(here.saved_in / "before.yaml", tmp_path / "before.yaml")
    for taken in (tmp_path / "before.yaml", tmp_path / "zero_acceleration.yaml"):
        with pytest.raises(BadInput, match="another model is called"):
            here.open_model(taken)


def test_one_model_alone_stands_beside_no_other(bench, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert Models(bench, Place("models")).chosen["right"] is None
    write_model(Draft(bench.base, diagnosis(), built_in()).model(), bench.saved_in / "other.yaml")
    assert Models(bench, Place("models")).chosen["right"] == "other"


@pytest.mark.parametrize(
    ("after", "told"), [(0.1001, "0 %"), (0.0999, "0 %"), (0.12, "+20 %"), (0.05, "−50 %")]
)
def test_a_change_of_nothing_has_no_sign(after, told):
    assert models.tell_change(0.1, after) == told


def test_what_one_types_is_set_apart_and_nothing_of_a_message_is_run():
    told = parts.marked("Write `rovsim init <b>`, or `nothing")
    assert told == "Write <code>rovsim init &lt;b&gt;</code>, or `nothing"


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
    draft = Draft(model(), diagnosis(), built_in())
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


def ended(work):
    """The state in which work ends, all that it said on the way."""
    shares = set()
    while work.look() == "running" and work.elapsed < 60:
        shares.add(work.share)
        time.sleep(0.005)
    return work.state, shares


def test_work_tells_how_far_it_is_and_ends_as_it_should():
    busy = Work.start("counting", print, counting, 40, 0.02)
    state, shares = ended(busy)
    assert (state, busy.said) == ("done", 40)
    assert len(shares) > 5
    poor, gone = Work.start("failing", print, failing), Work.start("dying", print, dying)
    assert ended(poor)[0] == "failed"
    assert "Mend it" in poor.said
    assert ended(gone)[0] == "failed"
    assert "unexpectedly" in gone.said


def test_a_process_that_has_ended_is_let_go():
    work = Work.start("counting", print, counting, 1, 0.0)
    assert ended(work)[0] == "done"
    for _ in range(200):  # it says that it is done a moment before it ends
        reap()
        if not Path(f"/proc/{work.process.pid}").exists():
            return
        time.sleep(0.02)
    raise AssertionError("it is still there")


def test_work_that_is_cancelled_ends_at_once():
    work = Work.start("counting", print, counting, 1000, 0.1)
    work.cancel()
    work.process.join(10)
    assert not work.process.is_alive()
    assert work.look() == "cancelled"


def test_a_path_is_drawn_through_its_points_and_keeps_its_gaps():
    time = np.linspace(0.0, 10.0, 1001)
    points = np.stack([np.cos(time), np.sin(time), 0.1 * time], axis=1)
    curves = np.array(path.bends(np.where(time[:, None] > 5.0, np.nan, points)))
    assert 0.4 * path.PIECES < len(curves) <= 0.5 * path.PIECES
    middle = 0.25 * curves[:, 0] + 0.5 * curves[:, 1] + 0.25 * curves[:, 2]
    for drawn in (curves[:, 0], middle, curves[:, 2]):
        away = np.linalg.norm(drawn[:, None] - points, axis=2).min(axis=1)
        np.testing.assert_allclose(away, 0.0, atol=1e-12)
    np.testing.assert_array_equal(curves[1:, 0], curves[:-1, 2])


def test_the_tank_is_named_north_east_and_down_in_metres():
    tank = np.array([[0.0, 10.0], [-5.0, 0.5], [0.0, 3.0]])  # NED
    low, high = path.room(np.zeros((1, 3)), tank)
    assert path.directions(low, high) == {
        "north 0 to 10 m": [10.0, 5.0, 0.0],
        "east −5 to 0.5 m": [0.0, -0.5, 0.0],
        "down 0 to 3 m": [0.0, -0.5, -3.0],
    }


def test_a_replay_that_leaves_the_tank_is_told():
    time = np.linspace(100.0, 110.0, 11)
    tank = np.array([[0.0, 10.0], [np.nan, np.nan], [0.0, 3.0]])
    still = np.tile([5.0, 0.0, 1.0], (11, 1))
    flown = still + np.outer(time - 100.0, [0.0, -9.0, 0.5])  # no wall is known in the west
    paths = {"measured": flown, "lost": flown, "good": still}
    assert path.tell_leaving(time, paths, tank) == [
        "The replay of lost leaves the tank after 5.0 s."
    ]


def test_a_path_is_saved_by_run_model_and_direction():
    time = np.array([0.0, 0.5])
    paths = {"measured": np.array([[1.0, 2.0, 3.0], [np.nan] * 3]), "a, b": np.ones((2, 3))}
    head, *rows = csv.reader(StringIO(path.path_table("6dof-1", time, paths)))
    assert head[:2] == ["time (s)", "6dof-1 measured, north (m)"]
    assert head[-1] == "6dof-1 a, b, down (m)"
    assert rows == [["0", "1", "2", "3", "1", "1", "1"], ["0.5", "", "", "", "1", "1", "1"]]


def test_columns_of_a_table_say_run_axis_quantity_and_unit(bench):
    predicted = bench.replays.prediction(bench.base, "6dof-1", 2.0)
    band = Band(np.stack([predicted.nu, predicted.nu]), np.zeros((2, len(predicted.nu), 6)))
    motion = bench.data.motions["6dof-1"]
    thrust = bench.replays.thrust(bench.base, "6dof-1")
    shown = panels(motion, {"m": predicted}, ["yaw"], "nu", thrust, {"m": band})
    push = bench.replays.thrust(bench.base, "3dof-1")
    other = panels(bench.data.motions["3dof-1"], {}, ["yaw"], "nu", push)
    both = beside((motion, shown), [(bench.data.motions["3dof-1"], other)])
    named = charts.columns(both)
    assert named["x"] == "time (s)"
    assert {
        "0/m": "6dof-1 yaw velocity, m (rad/s)",
        "0/m/width of the band": "6dof-1 yaw velocity, m, width of the band (rad/s)",
        "0/measured, 3dof-1": "3dof-1 yaw velocity, measured (rad/s)",
        "1/m": "6dof-1 yaw velocity, measured − m (rad/s)",
        "2/commanded": "6dof-1 yaw thrust, commanded (N m)",
    }.items() <= named["curves"].items()
    ids = {one["id"] for one in charts.series_data(motion.time, both)}
    assert set(named["curves"]) == ids


def test_the_room_is_the_tank_and_where_that_is_unknown_what_was_seen():
    seen = np.array([[0.5, 1.0, -1.0], [np.nan] * 3, [1.5, 2.0, -2.0]])
    tank = np.array([[0.0, 3.0], [np.nan, np.nan], [0.0, 4.0]])  # NED
    low, high = path.room(seen, tank)
    np.testing.assert_array_equal(low, [0.0, 1.0, -4.0])
    np.testing.assert_array_equal(high, [3.0, 2.0, 0.0])


def test_whatever_a_model_is_called_its_new_curve_travels_and_the_measured_one_stays():
    time = np.arange(3.0)
    shown = [Panel("surge", "m/s", {"measured": time, "m": time, "sure": time})]
    sent = [one["id"] for one in charts.series_data(time, shown, ("measured",))]
    assert sent == ["0/m", "0/sure"]


def test_curves_are_thinned_and_keep_their_gaps():
    time = np.linspace(0, 60, 6001)
    values = np.where(time > 30, np.nan, time)
    found = np.array(charts.points(time, values))
    assert len(found) <= 2 * charts.POINTS
    np.testing.assert_array_equal(np.isnan(found[:, 1]), found[:, 0] > 30)


def test_a_file_that_is_no_diagnosis_is_explained(bench, tmp_path):
    (tmp_path / "other.json").write_text("{}")
    settings = bench.settings.model_copy(update={"diagnosis": str(tmp_path / "other.json")})
    with pytest.raises(BadInput, match="not a diagnosis"):
        Workbench.opened(settings, built_in())


def test_a_port_in_use_is_one_message(capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(SystemExit) as refused:
            main(["ui", f"port={taken.getsockname()[1]}", "open=false"])
    assert refused.value.code == 2
    assert "cannot be used" in unfolded(capsys.readouterr().err)


def test_a_page_that_is_closed_while_it_asks_is_no_fault():
    def told(error):
        return app._stayed(logging.LogRecord("", 40, "", 0, "", (), (type(error), error, None)))

    assert not told(RuntimeError("No response returned."))
    assert told(RuntimeError("another"))
    assert told(ValueError("No response returned."))
    assert app._stayed(logging.LogRecord("", 40, "", 0, "", (), None))
