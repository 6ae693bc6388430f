"""The workbench shows what the commands write; long work reports, ends, can be cancelled."""

import logging
import shutil
import socket
import time
from pathlib import Path

import pytest
from starlette.datastructures import QueryParams

import synthetic_study
from chores import counting, dying, failing
from rovsim.application.configuration import compose
from rovsim.application.pipeline.comparison import compare
from rovsim.apps.cli.main import main
from rovsim.apps.workbench import app, data, models, parts, tasks, why
from rovsim.apps.workbench.draft import Draft
from rovsim.apps.workbench.models import Models
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.work import LongWork, Work, reap
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.errors import BadInput
from rovsim.core.files import read_json
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model_file import read_model, write_model
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.error_conditions import ConditionShare
from rovsim.results.ladder import Ladder, LadderStep
from said import unfolded


@pytest.mark.parametrize("horizon", [0.5, 2.0, 5.0, None])
def test_its_errors_are_those_of_the_comparison(bench, horizon):
    found = compare(bench.data, [bench.base], bench.settings).comparison.models["nominal"]
    for run, scores in found.runs.items():
        told = scores.open_loop if horizon is None else scores.windows[f"{horizon:g}"]
        assert bench.replays.metrics(bench.base, run, horizon) == told


def test_its_ladder_holds_the_diagnosis_the_models_and_the_floor_last(bench, monkeypatch):
    found = (
        LadderStep(model="+lag", windows_2s=0.1),
        LadderStep(model="noise_floor", windows_2s=0.05),
    )
    ladder = Ladder(steps=(bench.replays.step(bench.base), *found))
    monkeypatch.setattr(
        bench, "diagnosis", synthetic_study.a_lag().model_copy(update={"ladder": ladder})
    )
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
    assert len(shown) == why.MAX_RANKED_EFFECTS
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
    content = synthetic_study.a_lag().to_json()
    content["unexplained"] |= {"proposal": law}
    own = Workbench(bench.settings, bench.catalogue, bench.data, bench.models, bench.paths)
    own.replace_diagnosis(Diagnosis.model_validate(content))
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
    lagging = {"nominal": Draft(bench.base, synthetic_study.a_lag(), built_in()).model()}
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
    write_model(
        Draft(bench.base, synthetic_study.a_lag(), built_in()).model(),
        here.saved_in / "before.yaml",
    )
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
    write_model(
        Draft(bench.base, synthetic_study.a_lag(), built_in()).model(),
        bench.saved_in / "other.yaml",
    )
    assert Models(bench, Place("models")).chosen["right"] == "other"


@pytest.mark.parametrize(
    ("after", "told"), [(0.1001, "0 %"), (0.0999, "0 %"), (0.12, "+20 %"), (0.05, "−50 %")]
)
def test_a_change_of_nothing_has_no_sign(after, told):
    assert models.tell_change(0.1, after) == told


def test_what_one_types_is_set_apart_and_nothing_of_a_message_is_run():
    told = parts.marked("Write `rovsim init <b>`, or `nothing")
    assert told == "Write <code>rovsim init &lt;b&gt;</code>, or `nothing"


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
    assert (state, busy.outcome) == ("done", 40)
    assert len(shares) > 5
    poor, gone = Work.start("failing", print, failing), Work.start("dying", print, dying)
    assert ended(poor)[0] == "failed"
    assert "Mend it" in poor.outcome
    assert ended(gone)[0] == "failed"
    assert "unexpectedly" in gone.outcome


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


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["campaign=nowhere"], "nowhere: no such file or folder"),
        (["campaign={raw}", "model=[nominal,no.yaml]"], "no.yaml: no such file"),
        (["campaign={raw}", "diagnosis={raw}/campaign.yaml"], "not JSON"),
    ],
)
def test_what_is_named_and_cannot_be_opened_is_one_message(bench, words, said, capsys):
    raw = bench.settings.campaign
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with pytest.raises(SystemExit) as refused:
        main(["ui", f"port={port}", "open=false", *(word.format(raw=raw) for word in words)])
    assert refused.value.code == 2
    assert said in unfolded(capsys.readouterr().err)


def test_a_page_that_is_closed_while_it_asks_is_no_fault():
    def told(error):
        return app.was_answered(
            logging.LogRecord("", 40, "", 0, "", (), (type(error), error, None))
        )

    assert not told(RuntimeError("No response returned."))
    assert told(RuntimeError("another"))
    assert told(ValueError("No response returned."))
    assert app.was_answered(logging.LogRecord("", 40, "", 0, "", (), None))


def test_long_names_at_the_head_of_a_column_go_on_in_the_next_line():
    assert parts.head("effects+gp_6dof <b>") == "effects+<wbr>gp_<wbr>6dof &lt;b&gt;"


def test_no_heading_stands_over_nothing(monkeypatch):
    told = []
    for name in ("section", "text"):
        monkeypatch.setattr(parts, name, told.append)
    sound = synthetic_study.study()["quality"]["3dof-1"].model_copy(update={"remarks": ()})
    doubted = {"a": sound.doubted("The vehicle hangs upside down.")}
    parts.paragraphs("Remarks", data.list_remarks(doubted))
    assert told == []  # the doubt stands above
    parts.paragraphs("Remarks", data.list_remarks({"a": sound}))
    noisy = sound.model_copy(update={"remarks": ("The poses are noisy.",)})
    parts.paragraphs("Remarks", data.list_remarks({"a": noisy}))
    assert told == ["Remarks", "Nothing to remark on.", "Remarks", "a: The poses are noisy."]


def test_a_constant_error_is_told_as_a_push():
    share = {"axis": "heave", "condition": "throughout", "share_of_error": 0.4}
    assert why.tell_share(ConditionShare(**share)) == "40\u202f%"
    assert why.tell_share(ConditionShare(**share, push=-3.04)) == "40\u202f%: a push of 3.0 N"
    share["axis"] = "yaw"
    assert why.tell_share(ConditionShare(**share, push=0.2)).endswith("0.20 N m")
