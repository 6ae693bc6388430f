"""What is tracked: a database that is whole, whoever is killed; runs that can be ranked."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from mlflow.store.tracking import sqlalchemy_store
from mlflow.tracking import MlflowClient

from rovsim.application.configuration import compose
from rovsim.application.settings import TrackingSettings
from rovsim.application.tracking.mlflow_run import TrackedRun, ranking, tell_ranking, track
from rovsim.application.tracking.study import StudyFiles, track_study
from rovsim.apps.cli.main import override
from rovsim.apps.cli.sweep import (
    check_campaigns,
    check_launcher,
    check_sweep,
    choose_out,
    choose_sweep_folder,
    name_run,
)
from rovsim.core.errors import BadInput
from rovsim.results.ladder import Ladder, LadderStep
from said import unfolded
from synthetic_study import study


def tracked(name):
    settings = TrackingSettings(uri="sqlite:///results/mlflow.db", artifacts="results/mlflow")
    run = TrackedRun(experiment="tank", name=name, tags={}, params={"k": 5}, files=[])
    track(settings, run)
    return settings


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("residual.kk=1,3", "no key 'residual.kk'.*Did you mean 'residual.k'"),
        ("contrl=3dof,6dof", "no key 'contrl'.*Did you mean 'control'"),
        ("residual=knn,gpp", "no residual 'gpp'"),
        ("residual.k=1,abc", "'k' is 'abc'"),
        ("residual.k=range(0,2)", "'k' is 0"),
    ],
)
def test_a_sweep_is_checked_before_its_first_run(word, said):
    with pytest.raises(BadInput, match=said):
        check_sweep(["command=train", word, "seed=1,2"])


def test_campaigns_of_a_sweep_are_looked_at_first():
    with pytest.raises(BadInput, match="nowhere: no such file or folder"):
        check_campaigns(check_sweep(["command=train", "seed=1,2", "campaign='nowhere'"]))


def test_a_sweep_over_slurm_asks_for_one_first(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(BadInput, match="no Slurm is on this machine"):
        check_launcher(["command=train", "seed=1,2", "hydra/launcher=submitit_slurm"])


def test_several_values_without_a_sweep_say_how_to_begin_one():
    with pytest.raises(BadInput, match=r"several values \(residual.k=1,3\).*Add -m"):
        compose(["command=train", "residual.k=1,3"])


def test_keys_are_those_of_the_chosen_option():
    with pytest.raises(BadInput, match=r"Did you mean 'residual.iterations'"):
        compose(["residual=gp", "residual.iteration=3"])


def test_a_database_that_was_being_made_is_made_anew(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def killed(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as half:
        half.setattr(sqlalchemy_store.SqlAlchemyStore, "__init__", killed)
        with pytest.raises(KeyboardInterrupt):
            tracked("first")
    assert not (tmp_path / "results" / "mlflow.db").exists()
    settings = tracked("second")
    client = MlflowClient(tracking_uri=f"sqlite:///{tmp_path / 'results' / 'mlflow.db'}")
    experiment = client.get_experiment_by_name("tank")
    (run,) = client.search_runs([experiment.experiment_id])
    assert (run.info.run_name, run.data.params) == ("second", {"k": "5"})
    assert settings.artifacts in experiment.artifact_location
    assert experiment.tags["mlflow.experimentKind"] == "custom_model_development"


def test_an_experiment_has_a_view_that_ranks_its_models_and_says_where(tmp_path, monkeypatch):
    """Opened in a browser, this view shows the runs with the error, the lowest first."""
    monkeypatch.chdir(tmp_path)
    settings = tracked("first")
    client = MlflowClient(tracking_uri=f"sqlite:///{tmp_path / 'results' / 'mlflow.db'}")
    experiment = client.get_experiment_by_name("tank")
    view = json.loads(experiment.tags["mlflow.sharedViewState.ranking"])
    number, key = experiment.experiment_id, "mlflow.note.content"
    assert (view["orderByKey"], view["orderByAsc"]) == ("metrics.`windows_2s`", True)
    assert "metrics.`windows_2s`" in view["selectedColumns"]
    found = client.search_runs([number], view["searchFilter"])
    assert [run.info.run_name for run in found] == []  # the first has no error
    there = f"#/experiments/{number}/runs?viewStateShareKey=ranking"
    assert there in experiment.tags[key]
    assert f"http://127.0.0.1:5000/{there}" in tell_ranking(settings, "tank")
    client.set_experiment_tag(number, key, "In May the tether was slack.")
    tracked("second")  # leaves what people wrote
    assert client.get_experiment(number).tags[key] == "In May the tether was slack."


@pytest.mark.parametrize("uri", ["http://127.0.0.1:9", "sqlite:///text.db", "file:mlruns"])
def test_a_place_that_keeps_nothing_is_one_message(uri, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MLFLOW_HTTP_REQUEST_MAX_RETRIES", "0")
    (tmp_path / "text.db").write_text("no database\n" * 100)
    settings = TrackingSettings(uri=uri, artifacts="results/mlflow")
    with pytest.raises(BadInput, match="MLflow cannot keep"):
        track(settings, TrackedRun(experiment="a", name="b", tags={}, files=[]))


def test_an_experiment_that_another_machine_makes_meanwhile_is_taken(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tracked("first")
    known, asked = MlflowClient.get_experiment_by_name, []

    def unknown_at_first(self, name):
        asked.append(name)
        return known(self, name) if len(asked) > 1 else None

    monkeypatch.setattr(MlflowClient, "get_experiment_by_name", unknown_at_first)
    tracked("second")
    assert len(asked) == 2


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["residual=knn", "control=3dof"], None),
        (["residual=knn", "residual.k=3", "control=3dof"], "knn_3dof residual.k=3"),
        (["residual=gp", "filter=savgol", "+a=1"], "gp_6dof filter=savgol +a=1"),
        (["residual.k=3", "tracking.name=mine"], "mine"),
    ],
)
def test_a_run_of_a_sweep_is_called_after_what_was_set(words, name):
    settings = compose(["campaign=DIR", *(word for word in words if not word.startswith("+"))])
    named = name_run(settings, ["command=train", "campaign='DIR'", *words])
    assert named.tracking.name == name


def test_models_are_ranked_where_there_is_a_test_run():
    errors = {"nominal": 0.2, "model": 0.05, "untested": None}
    assert ranking(errors, "model", "nominal") == {"windows_2s": 0.05, "windows_2s/of_base": 0.25}
    assert ranking(errors, "untested", "nominal") == {}


@pytest.mark.parametrize(
    ("added", "error"),
    [({"+thruster_lag": 0.3, "+lift": 0.2}, 0.2), ({}, 0.6)],
    ids=["two", "none"],
)
def test_the_model_with_all_effects_is_ranked_though_it_is_no_step_of_the_ladder(
    added, error, tmp_path
):
    made = study(models=("nominal", "effects", "knn_6dof"))
    found = [LadderStep(model=name, windows_2s=value) for name, value in added.items()]
    scored = [LadderStep(model=m, windows_2s=v) for m, v in [("nominal", 0.6), ("effects", error)]]
    names = {name: tmp_path / f"{name}.json" for name in ("comparison", "ladder", "diagnosis")}
    made["ladder"] = Ladder.with_diagnosis(scored, found)
    for name, path in names.items():
        made[name].write(path)
    uri = f"sqlite:///{tmp_path / 'mlflow.db'}"
    settings = TrackingSettings(uri=uri, artifacts=str(tmp_path / "kept"))
    report = tmp_path / "report.html"
    report.touch()
    files = StudyFiles(models=[], figures=[], report=report, **names)
    runs = track_study(settings, "tank", files, {})
    logged = MlflowClient(tracking_uri=uri).get_run(runs["effects"]).data.metrics
    assert logged["windows_2s"] == error


def test_jobs_of_a_sweep_have_folders_of_their_own_in_one_that_is_given():
    assert choose_out(None, "/r/multirun/now/3", "3") == "/r/multirun/now/3"
    assert choose_out("mine", "/r/multirun/now/3", "3") == str(Path("mine", "3"))


def test_a_sweep_overwrites_nothing(tmp_path):
    words = ["tank", "-m", "tank=tiny", "tank.duration=3", "tank.seed=1,2", "out=mine"]
    subprocess.run([sys.executable, "-m", "rovsim", *words], cwd=tmp_path, check=True)
    assert {p.parent.name for p in (tmp_path / "mine").rglob("campaign.yaml")} == {"0", "1"}


def test_a_run_that_fails_is_named_and_the_others_go_on(tmp_path):
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "0").write_text("in the way of the first run")
    words = ["tank", "-m", "tank=tiny", "tank.duration=3", "tank.seed=1,2", "out=mine"]
    command = [sys.executable, "-m", "rovsim", *words]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    said = unfolded(done.stderr)
    assert (
        f"run 0 of the sweep (tank=tiny tank.duration=3 tank.seed=1 out='mine'): {mine}/0" in said
    )
    assert "1 of the runs failed (0)" in said
    assert (mine / "1" / "campaign.yaml").is_file()
    (noted,) = (tmp_path / "results" / "multirun").rglob("failed.txt")
    assert "tank.seed=1" in noted.read_text()


def test_sweeps_that_begin_in_the_same_second_have_folders_of_their_own(tmp_path):
    wanted = tmp_path / "multirun" / "now"
    found = [choose_sweep_folder(wanted, given=False).name for _ in range(3)]
    assert found == ["now", "now_2", "now_3"]
    assert choose_sweep_folder(wanted, given=True) == wanted


def test_a_sweep_over_campaigns_takes_one_by_one_where_any_is_there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("first", "a, b=c é"):
        Path(name).mkdir()
    several = override("campaign=first,a, b=c é", sweep=True)
    assert several == "campaign='first','a, b=c é'"
    assert override("campaign=a, b=c é", sweep=True) == "campaign='a, b=c é'"
    assert override("campaign=first,third", sweep=True) == "campaign='first','third'"
    assert override("campaign=second,third", sweep=True) == "campaign='second,third'"
    assert override("model=nominal,first", sweep=True) == "model='nominal','first'"
    assert override("campaign=a, b=c é") == "campaign='a, b=c é'"
    with pytest.raises(BadInput, match="For a run with each, add -m"):
        override("campaign=first,a, b=c é")


MODEL = """vehicle: bluerov2_heavy
residual: {kind: knn, control: 6dof, file: residual.npz, features: [velocity, wrench],
  scaling: standard, settings: {max_points: null, k: 30, weights: distance}}
provenance: {base: nominal, seed: 4}
"""


def test_every_run_of_a_study_has_figures_and_trained_models_what_they_were_trained_with(tmp_path):
    made = study()
    for name in ("comparison", "ladder", "diagnosis"):
        made[name].write(tmp_path / f"{name}.json")
    learned = tmp_path / "knn_6dof" / "model.yaml"
    learned.parent.mkdir()
    learned.write_text(MODEL)
    kept = [tmp_path / name for name in ("ladder.png", "where.png")]
    report = tmp_path / "report.html"
    for path in (*kept, report, learned.with_name("residual.npz")):
        path.write_bytes(b"made up")
    names = {name: tmp_path / f"{name}.json" for name in ("comparison", "ladder", "diagnosis")}
    uri = f"sqlite:///{tmp_path / 'mlflow.db'}"
    settings = TrackingSettings(uri=uri, artifacts=str(tmp_path / "kept"))
    written = StudyFiles(models=[learned], figures=kept, report=report, **names)
    runs = track_study(settings, "tank", written, {})
    client = MlflowClient(tracking_uri=uri)

    def files(number):
        return {one.path for one in client.list_artifacts(number)}

    steps = {name: n for name, n in runs.pop("diagnosis").items() if name != "diagnosis"}
    assert steps
    assert all(files(number) == {"diagnosis.json", "ladder.png"} for number in steps.values())
    assert files(runs["study"]) == {"ladder.png", "where.png", "report.html"}
    assert files(runs["nominal"]) == {"ladder.png"}
    assert files(runs["knn_6dof"]) == {"model.yaml", "residual.npz", "ladder.png"}
    logged = client.get_run(runs["knn_6dof"]).data.params
    trained = compose(["residual=knn", "seed=4"])
    assert logged.keys() == (trained.residual | {"seed": trained.seed}).keys()
    assert (logged["kind"], logged["k"], logged["seed"]) == ("knn", "30", "4")
