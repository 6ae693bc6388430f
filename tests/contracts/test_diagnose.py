"""`rovsim diagnose`: everything it writes, and nothing for input that cannot be used."""

import json
import shutil

import pytest

from fuzz.entries import DiagnosisJson
from rovsim.application.configuration import compose
from rovsim.apps.cli.main import main
from rovsim.apps.workbench import tasks
from rovsim.core.axes import AXES
from rovsim.core.files import read_json
from rovsim.core.yaml_files import read_yaml, write_yaml
from rovsim.diagnosis.apply import add_effects
from rovsim.dynamics.catalogue import built_in
from rovsim.evaluation.ladder import score_step
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.ladder import Ladder, LadderStep
from said import unfolded


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Runs so short that nothing can be said: the quickest verdict there is."""
    out = tmp_path_factory.mktemp("tank") / "short"
    main(["tank", "tank=tiny", "tank.duration=4", f"out={out}"])
    return out


@pytest.fixture(scope="module")
def diagnosed(campaign, tmp_path_factory):
    """A folder in which `rovsim diagnose` ran."""
    folder = tmp_path_factory.mktemp("work")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        main(["diagnose", f"campaign={campaign}", "out=found"])
    return folder


def test_too_little_data_is_a_verdict_with_a_report(diagnosed):
    found = read_json(diagnosed / "found" / "diagnosis.json")
    assert found["verdict"] == "insufficient_data"
    assert found["selected"] == []
    assert found["error"]["nominal"] == found["error"]["with_effects"] > 0
    assert found["error"]["noise_floor"] is None
    page = (diagnosed / "found" / "report.html").read_text()
    assert page.index(">Verdict<") < page.index(">Where the models fail<")
    for name in ("ranking", "ladder"):
        assert (diagnosed / "found" / "figures" / f"{name}.png").stat().st_size > 3000


@pytest.mark.usefixtures("few_figures")
def test_a_model_that_runs_away_is_told_so_and_not_that_there_is_no_test_run(
    campaign, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    drag = dict.fromkeys(AXES, -900.0)
    bad = {"effects": [{"effect": "quadratic_damping", "parameters": drag}]}
    write_yaml(tmp_path / "bad.yaml", {"vehicle": "bluerov2_heavy", **bad})
    main(["diagnose", f"campaign={campaign}", "model=bad.yaml", "out=found"])
    said = unfolded(capsys.readouterr().out)
    found = read_json(tmp_path / "found" / "diagnosis.json")
    assert found["error"]["nominal"] is None
    assert found["runs_away_in"] == ["6dof-2"]
    assert "in 6dof-2 it runs away within 2 s" in said
    assert "No test run" not in said
    main(["compare", f"campaign={campaign}", "model=[nominal,bad.yaml]", "out=compared"])
    assert "No error of bad on the test runs" in unfolded(capsys.readouterr().out)


@pytest.mark.usefixtures("few_figures")
def test_neither_of_compare_and_diagnose_loses_the_other_ones_report(
    campaign, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    words = [f"campaign={campaign}", "out=both"]
    main(["compare", *words, "-q"])
    compared = (tmp_path / "both" / "report.html").read_bytes()
    main(["diagnose", *words])
    said = unfolded(capsys.readouterr().out)
    assert "was the report of compare: it is both/report_compare.html now" in said
    assert (tmp_path / "both" / "report_compare.html").read_bytes() == compared
    diagnosed = (tmp_path / "both" / "report.html").read_bytes()
    for _ in range(2):
        main(["compare", *words, "-q"])
        assert (tmp_path / "both" / "report_diagnose.html").read_bytes() == diagnosed
    assert 'id="compare"' in (tmp_path / "both" / "report.html").read_text()
    main(["diagnose", *words, "-q"])
    assert not (tmp_path / "both" / "report_diagnose.html").exists()  # the new one replaced it


@pytest.mark.usefixtures("few_figures")
@pytest.mark.parametrize("command", ["compare", "diagnose"])
def test_a_second_campaign_of_one_name_leaves_nothing_of_the_first_and_says_so(
    command, campaign, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(campaign, tmp_path / "other")
    described = tmp_path / "other" / "campaign.yaml"
    described.write_text(described.read_text().replace("id: 3dof-1", "id: renamed"))
    main([command, f"campaign={campaign}", "-q"])
    what = "diagnosis" if command == "diagnose" else command
    (figures,) = tmp_path.glob(f"results/*/{what}/figures")
    (figures / "mine.png").write_bytes(b"of the user")
    main([command, "campaign=other"])
    assert f"held the results of another campaign, {campaign}" in unfolded(capsys.readouterr().out)
    assert "mine" in {path.stem for path in figures.iterdir()}
    assert not list(figures.glob("*3dof-1*"))
    main([command, "campaign=other/campaign.yaml"])  # the same one
    assert "another campaign" not in unfolded(capsys.readouterr().out)


@pytest.mark.usefixtures("few_figures")
def test_without_a_train_run_the_role_of_each_run_is_told(campaign, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(campaign, tmp_path / "tests_alone")
    described = tmp_path / "tests_alone" / "campaign.yaml"
    described.write_text(described.read_text().replace("split: train", "split: test"))
    main(["diagnose", "campaign=tests_alone", "out=found"])
    said = unfolded(capsys.readouterr().out)
    assert "no train run could be used" in said
    assert "Next: Write `split: train` for a run in campaign.yaml" in said
    assert "3dof-1: test run 6dof-1: test run" in said
    assert "cannot be estimated: nothing was learned of the noise" in said


def test_its_ladder_is_that_of_the_contract(diagnosed):
    found = read_json(diagnosed / "found" / "diagnosis.json")
    ladder = found["ladder"]
    assert ladder["schema"] == "rovsim.ladder/1"
    assert [s["model"] for s in ladder["steps"]] == ["nominal", "noise_floor"]
    assert ladder["steps"][0]["windows_2s"] == pytest.approx(found["error"]["nominal"], rel=1e-5)


def test_a_diagnosis_is_a_run_and_every_step_a_run_in_it(diagnosed):
    from mlflow.tracking import MlflowClient

    client = MlflowClient(f"sqlite:///{diagnosed / 'results' / 'mlflow.db'}")
    experiment = client.get_experiment_by_name("tank-tiny")
    runs = {r.info.run_name: r for r in client.search_runs([experiment.experiment_id])}
    assert set(runs) == {"diagnosis", "nominal", "noise_floor"}
    whole = runs.pop("diagnosis")
    assert whole.data.tags["verdict"] == "insufficient_data"
    assert whole.data.params["search.false_alarm"] == "0.003"
    assert {"error/nominal", "error/with_effects"} <= set(whole.data.metrics)
    files = {f.path for f in client.list_artifacts(whole.info.run_id)}
    assert {"diagnosis.json", "report.html", "ladder.png"} <= files
    assert all(r.data.tags["mlflow.parentRunId"] == whole.info.run_id for r in runs.values())
    assert "windows_2s" in runs["nominal"].data.metrics


def test_nothing_selected_adds_nothing(diagnosed, capsys):
    source = diagnosed / "found" / "diagnosis.json"
    model, names, *_ = add_effects(Diagnosis.read(source), source, "nominal", None, built_in())
    assert names == []
    assert model.added == ()
    main(["add", f"diagnosis={source}", f"model={diagnosed / 'new.yaml'}"])
    assert "selected no effect" in capsys.readouterr().out
    assert read_yaml(diagnosed / "new.yaml")["effects"] == []


@pytest.fixture
def two_found(tmp_path, monkeypatch):
    """A diagnosis that selected a lag, and found that lift would do."""
    monkeypatch.chdir(tmp_path)
    door = DiagnosisJson(tmp_path)
    door.prepare()
    lift = {"effect": "lift", "parameters": {"coefficient": {"value": 20.0}}}
    door.written({**door.tree, "ranking": [*door.tree["ranking"], lift]})


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["effects=[lift,lift]", "model=new.yaml"], "'lift' is named twice"),
        (["to=first.yaml", "model=first.yaml"], "first.yaml: has thruster_lag at these values"),
        (["model=diagnosis.json"], "diagnosis.json: is the diagnosis itself"),
    ],
)
@pytest.mark.usefixtures("two_found")
def test_nothing_is_added_twice_or_over_its_source(words, message, tmp_path, capsys):
    main(["add", "diagnosis=diagnosis.json", "model=first.yaml"])
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(SystemExit) as ended:
        main(["add", "diagnosis=diagnosis.json", *words])
    assert ended.value.code == 2
    assert message in " ".join(capsys.readouterr().err.split())
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.usefixtures("two_found")
def test_a_drag_that_feeds_energy_in_is_told_when_it_is_added(tmp_path, capsys):
    found = read_json(tmp_path / "diagnosis.json")
    drag = {"effect": "quadratic_damping", "parameters": {"surge": {"value": -300.0}}}
    found["ranking"].append(drag)
    (tmp_path / "diagnosis.json").write_text(json.dumps(found))
    main(["add", "diagnosis=diagnosis.json", "model=new.yaml", "effects=[quadratic_damping]"])
    said = unfolded(capsys.readouterr().out)
    assert "In all, quadratic_damping is below zero in surge (−159): water would push" in said
    main(["add", "diagnosis=diagnosis.json", "model=lift.yaml", "effects=[lift]", "--json"])
    assert json.loads(capsys.readouterr().out)["warning"] == ""
    main(["export", "model=new.yaml", "to=fossen", "out=new.fossen.yaml"])
    assert "quadratic_damping is below zero in surge" in unfolded(capsys.readouterr().out)


@pytest.mark.usefixtures("two_found")
def test_an_effect_is_added_only_to_a_vehicle_on_which_it_can_act(tmp_path, capsys):
    found = read_json(tmp_path / "diagnosis.json")
    stiff = {"effect": "waterplane_stiffness", "parameters": {"roll": {"value": 50.0}}}
    found["ranking"].append(stiff)
    (tmp_path / "diagnosis.json").write_text(json.dumps(found))
    words = ["diagnosis=diagnosis.json", "model=new.yaml", "effects=[waterplane_stiffness]"]
    with pytest.raises(SystemExit, match="2"):
        main(["add", *words])
    assert "cannot act on a vehicle without a waterplane" in unfolded(capsys.readouterr().err)
    assert not (tmp_path / "new.yaml").exists()
    (tmp_path / "floating.yaml").write_text("vehicle: otter\n")
    main(["add", *words, "to=floating.yaml"])
    assert read_yaml(tmp_path / "new.yaml")["vehicle"] == "otter"


@pytest.mark.usefixtures("two_found")
def test_no_effects_are_no_effects(tmp_path, capsys):
    main(["add", "diagnosis=diagnosis.json", "model=new.yaml", "effects=[]"])
    assert "effects=[] names no effect" in unfolded(capsys.readouterr().out)
    assert read_yaml(tmp_path / "new.yaml")["effects"] == []


def test_what_mlflow_cannot_keep_is_no_error_of_a_diagnosis(campaign, tmp_path, capsys):
    (tmp_path / "broken.db").write_text("no database")
    uri = f"tracking.uri=sqlite:///{tmp_path / 'broken.db'}"
    main(["diagnose", f"campaign={campaign}", f"out={tmp_path / 'found'}", uri])
    said = capsys.readouterr()
    assert "The recordings cannot tell" in unfolded(said.out)
    assert "complete, but MLflow does not have it" in unfolded(said.err)
    assert (tmp_path / "found" / "report.html").is_file()


@pytest.mark.usefixtures("two_found")
def test_values_that_were_found_one_by_one_are_told(capsys):
    for effects, told in (("lift,thruster_lag", True), ("lift", False), ("thruster_lag", False)):
        main(["add", "diagnosis=diagnosis.json", "model=new.yaml", f"effects=[{effects}]"])
        said = " ".join(capsys.readouterr().out.split())
        assert ("found without the other effects" in said) == told


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["out=taken"], "taken: is not a folder"),
        (["out=taken/deeper"], "taken: is not a folder"),
        (["out=o", "model=[nominal,zero_acceleration]"], "2 models (nominal, zero_acceleration)"),
        (["out=o", "model=zero_acceleration"], "cannot diagnose zero_acceleration"),
        (["out=o", "model=corrected.yaml"], "without a trained residual"),
        (["out=o", "serach.draws=3"], "Did you mean 'search.draws'"),
        (["out=o", "search.drows=3"], "Did you mean 'search.draws'"),
        (["out=o", "search.false_alarm=2"], "search.false_alarm"),
    ],
)
def test_bad_input_is_one_message_and_nothing_written(
    campaign, corrected, tmp_path, monkeypatch, capsys, words, message
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").write_text("a file")
    for file in corrected:
        (tmp_path / file.name).symlink_to(file)
    before = sorted(tmp_path.iterdir())
    with pytest.raises(SystemExit) as ended:
        main(["diagnose", f"campaign={campaign}", *words])
    text = unfolded(capsys.readouterr().err)
    assert ended.value.code == 2
    assert text.startswith("rovsim: ")
    assert message in text
    assert sorted(tmp_path.iterdir()) == before


@pytest.fixture(scope="module")
def corrected(campaign, tmp_path_factory):
    """A model file with a trained residual, and the arrays beside it."""
    folder = tmp_path_factory.mktemp("corrected")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        main(["train", f"campaign={campaign}", "residual=knn", f"out={folder / 'knn'}"])
    (folder / "knn" / "model.yaml").rename(folder / "knn" / "corrected.yaml")
    return [folder / "knn" / name for name in ("corrected.yaml", "residual.npz")]


def test_the_ladder_of_a_study_puts_the_effects_where_their_model_stands():
    models = [LadderStep(model=m) for m in ("nominal", "refitted", "effects", "knn_6dof")]
    found = [LadderStep(model=m) for m in ("nominal", "+lift", "+payload", "noise_floor")]
    steps = [s.model for s in Ladder.with_diagnosis(models, found).steps]
    assert steps == ["nominal", "refitted", "+lift", "+payload", "knn_6dof", "noise_floor"]
    steps = [s.model for s in Ladder.with_diagnosis(models, [found[0], found[-1]]).steps]
    assert steps == ["nominal", "refitted", "knn_6dof", "noise_floor"]


def test_a_step_without_runs_has_every_key_and_no_number():
    empty = Ladder(steps=(score_step("nominal", []),)).to_json()["steps"][0]
    assert empty["windows_2s"] is None
    assert set(empty["velocity_mae"].values()) == {None}


def test_the_workbench_finds_what_the_command_finds(campaign, diagnosed, tmp_path):
    found = tasks.diagnose_into(compose([f"campaign='{campaign}'"]), tmp_path / "diagnosis.json")
    assert found.to_json() == read_json(tmp_path / "diagnosis.json")
    assert found.to_json() == read_json(diagnosed / "found" / "diagnosis.json")
