"""The command line: every argument arrives, every mistake is one message and exit code 2."""

import json
import os
import pickle
import shutil
import signal
import subprocess
import sys
import time

import pytest
import yaml
from mlflow.tracking import MlflowClient

from rovsim.application.configuration import compose
from rovsim.apps.cli import main as cli
from rovsim.apps.cli.completion import commands
from rovsim.apps.cli.main import listed, main, override, quoted
from rovsim.apps.cli.untaken import require_taken
from rovsim.core import extras
from rovsim.core.errors import unlisted
from rovsim.core.files import write_text
from rovsim.core.shipped import conf_names, shipped
from rovsim.core.yaml_files import read_yaml
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.reporting.html.picture import Drawn, Picture
from said import unfolded

AWKWARD = [
    "my tank, 2.5 m (a=b) é",
    "it's",
    'quote"d',
    "tilde~$HOME",
    "back\\slash",
    "${oops}",
    "a%b",
]


@pytest.fixture(scope="session")
def campaign(tmp_path_factory):
    """A tiny synthetic campaign in a folder with an awkward name."""
    out = tmp_path_factory.mktemp("tank") / "my tank, (a=b) é"
    main(["tank", "tank=tiny", "tank.duration=8", f"out={out}"])
    return out


@pytest.mark.parametrize("value", AWKWARD)
def test_plain_values_arrive_as_typed(value):
    assert compose([override(f"campaign={value}")]).campaign == value


def test_lists_of_models_keep_commas_that_belong_to_files(tmp_path):
    odd = tmp_path / "a,b.yaml"
    odd.write_text("vehicle: bluerov2_heavy")
    assert listed(f"nominal,{odd}") == ["nominal", str(odd)]
    assert compose([override(f"model=[nominal,{odd}]")]).model == ["nominal", str(odd)]
    assert quoted("null") == "null"


@pytest.mark.parametrize(
    ("command", "extra"),
    [
        ("train", "learn,tracking"),
        ("ui", "workbench"),
        ("fmu", "fmi"),
        ("bench", "benchmark,learn"),
        ("blind", "benchmark"),
    ],
)
def test_a_command_without_its_extra_says_what_to_install(command, extra, capsys, monkeypatch):
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    text = failing(capsys, command)
    assert text.count("rovsim: ") == 1
    assert f"pip install 'rovsim[{extra}]'" in text


@pytest.mark.parametrize(
    ("sent", "said", "code"),
    [(signal.SIGINT, "interrupted", 130), (signal.SIGTERM, "terminated", 143)],
)
def test_a_command_that_is_told_to_end_says_so(sent, said, code, capsys, monkeypatch):
    def work(_):
        os.kill(os.getpid(), sent)
        time.sleep(20)

    monkeypatch.setattr(cli, "_main", work)
    found = signal.getsignal(sent)
    usual = signal.default_int_handler if sent == signal.SIGINT else signal.SIG_DFL
    signal.signal(sent, usual)  # a shell's background job ignores SIGINT, and so would its tests
    try:
        with pytest.raises(SystemExit) as ended:
            main([])
        assert signal.getsignal(sent) == usual
    finally:
        signal.signal(sent, found)
    assert ended.value.code == code
    assert capsys.readouterr().err == f"rovsim: {said}; what was finished is kept.\n"


def test_files_of_the_working_folder_come_first(tmp_path, monkeypatch):
    own, shipped_names = tmp_path / "conf", conf_names("tank")
    for name in ("mine", "tiny"):
        write_text(own / "tank" / f"{name}.yaml", f"name: my-{name}\nduration: 7.0\n")
    monkeypatch.chdir(tmp_path)
    assert conf_names("tank") == sorted([*shipped_names, "mine"])
    assert compose(["tank=mine"]).tank.duration == 7.0
    assert compose(["tank=tiny"]).tank.name == "my-tiny"
    assert compose(["tank=lag"]).tank.name == "tank-lag"  # what is not here comes with rovsim
    shutil.copy(shipped("conf/vehicle") / "bluerov2_heavy.yaml", tmp_path)
    text = (tmp_path / "bluerov2_heavy.yaml").read_text().replace("name: ", "name: my_", 1)
    write_text(own / "vehicle" / "bluerov2_heavy.yaml", text)
    assert load_vehicle("bluerov2_heavy").name == "my_bluerov2_heavy"


def failing(capsys, *words):
    """The one message of a command that must end with exit code 2."""
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    text = unfolded(capsys.readouterr().err)
    assert ended.value.code == 2
    assert text.startswith("rovsim: ")
    assert "Traceback" not in text
    return text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["compar"], "Did you mean 'compare'"),
        (["--quiet", "compare"], "no campaign was given"),
        (
            [
                "tank",
                "out=x",
                "tank.effects=[{effect: thruster_lag, parameters: {time_constant: -1}}]",
            ],
            "Expected a number of at least 0 s",
        ),
        (["compare"], "no campaign was given"),
        (["compare", "campaign=/nowhere"], "/nowhere"),
        (["compare", "campaigm=x"], "campaigm"),
        (["add", "diagnosis=x.json", "model=new"], "Did you mean model=new.yaml"),
        (["add", "diagnosis=x.json", "out=new.yaml"], "does not use 'out'"),
        (["compare", "campaign=x", "model=nominal", "model=a.yaml"], "'model' is given 2 times"),
        (["compare", "campaign=x", "seed=1", "seed=1"], "Leave one of them out"),
        (["compare", "model=nominal,zero_acceleration"], r"model=\[nominal,zero_acceleration\]"),
        (["compare", "campaign=/,/"], "For a run with each, add -m"),
        (["compare", "oops"], "has no '='"),
        (["compare", "filter=savgoll", "campaign=x"], "Did you mean 'savgol'"),
        (["compare", "replay.stepp=1", "campaign=x"], "Did you mean 'replay.step'"),
        (["train", "residual=knnn", "campaign=x"], "Did you mean 'knn'"),
        (["tank", "tank.seed=-1", "out=x"], "tank.seed"),
        (["tank", "tank.effects=[{effect: lag}]", "out=x"], "unknown effect 'lag'"),
        (["train", "residual.k=0", "campaign=x"], "no such file|k"),
    ],
)
def test_mistakes_are_explained(capsys, words, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    import re

    assert re.search(message, failing(capsys, *words))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["diagnose", "effects=[lift]"], "does not use 'effects'. Expected keys that it takes"),
        (["diagnose", "effects=[lift]"], "did you mean `rovsim add`?"),
        (["compare", "search.draws=9"], "does not use 'search.draws'"),
        (["compare", "residual=gp"], "did you mean `rovsim train`?"),
        (["add", "filter=savgol"], "`rovsim add` does not use 'filter'"),
        (["add", "campaign=x"], "Leave it out."),
        (["diagnose", "-m", "effects=[lift],[drag]"], "did you mean `rovsim add`?"),
    ],
)
def test_a_key_that_a_command_would_ignore_is_refused(words, said, capsys):
    assert said in failing(capsys, *words)


def test_what_stands_beside_any_command_is_not_refused():
    words = ["seed=1", "+experiment=kth_tank_2025", "hydra/launcher=joblib", "tracking.name=a"]
    for command in commands():
        require_taken(command, [*words, "output=quiet", "effects_file=e.py"])
    require_taken("diagnose", ["filter=savgol", "signals.filter.kind=none", "replay.step=0.1"])


def broken(campaign, tmp_path, change):
    """A copy of the campaign with one thing wrong in its campaign.yaml."""
    content = read_yaml(campaign / "campaign.yaml")
    change(content)
    folder = tmp_path / "broken"
    folder.mkdir()
    for file in campaign.iterdir():
        (folder / file.name).symlink_to(file)
    (folder / "campaign.yaml").unlink()
    (folder / "campaign.yaml").write_text(yaml.safe_dump(content))
    return folder


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: c["mocap"].update(body="vehicles"), "'vehicle'"),
        (lambda c: c.update(vehicle="bluerov"), "Did you mean 'bluerov2'"),
        (lambda c: c.update(vehicle="bluerov"), "campaign.yaml, key 'vehicle': unknown vehicle"),
        (lambda c: c.update(tnak={}), "Did you mean 'tank'"),
        (lambda c: c["commands"].update(columns=[f"u{i}" for i in range(8)]), "u0"),
        (lambda c: c["runs"][0].update(mocap="gone.tsv"), "gone.tsv"),
    ],
)
def test_bad_campaigns_leave_nothing_behind(capsys, campaign, tmp_path, change, message):
    folder, out = broken(campaign, tmp_path, change), tmp_path / "out"
    text = failing(capsys, "compare", f"campaign={folder}", f"out={out}")
    assert message in text
    assert not out.exists()


def test_an_unknown_model_names_the_nearest(capsys, campaign, tmp_path):
    text = failing(capsys, "compare", f"campaign={campaign}", "model=nominl", f"out={tmp_path}/o")
    assert "Did you mean 'nominal'" in text


@pytest.mark.usefixtures("few_figures")
def test_compare_writes_the_contract(campaign, tmp_path, capsys):
    words = [f"campaign={campaign}", "model=[nominal,zero_acceleration]", f"out={tmp_path}"]
    main(["compare", *words, "--json"])
    found = json.loads((tmp_path / "comparison.json").read_text())
    assert json.loads(capsys.readouterr().out) == found
    assert found["schema"] == "rovsim.comparison/1"
    assert set(found["models"]) == {"nominal", "zero_acceleration"}
    run = found["models"]["nominal"]["runs"]["6dof-2"]
    assert set(run) == {"split", "control", "open_loop", "windows"}
    assert set(run["windows"]) == {"0.5", "2", "5"}
    assert set(run["open_loop"]) == {
        "acceleration_rmse",
        "velocity_mae",
        "velocity_rmse",
        "position_rmse_m",
        "attitude_rmse_rad",
    }
    assert "http" not in (tmp_path / "report.html").read_text().split("<body")[0]
    zero = found["models"]["zero_acceleration"]["runs"]["6dof-2"]["windows"]["2"]
    assert run["windows"]["2"]["velocity_rmse"]["surge"] < zero["velocity_rmse"]["surge"]


@pytest.mark.usefixtures("few_figures")
def test_a_trained_model_is_accepted_wherever_a_model_is(campaign, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    arguments = [f"campaign={campaign}", "residual=knn", "control=6dof", f"out={tmp_path / 'knn'}"]
    (tmp_path / "knn").mkdir()
    (tmp_path / "knn" / "of_others.db").touch()
    main(["train", *arguments])
    said = capsys.readouterr().out
    assert "  KNN (6-DoF)" in said
    assert "  model " not in said
    main(["train", *arguments, "--json"])
    told = json.loads(capsys.readouterr().out)["errors"]
    kept = {p.name for p in (tmp_path / "results" / "mlflow").rglob("*") if p.is_file()}
    assert kept > {"model.yaml", "residual.npz", "comparison.json"}
    assert {name for name in kept if name.endswith(".png")}
    client = MlflowClient(tracking_uri="sqlite:///results/mlflow.db")
    (experiment,) = client.search_experiments(filter_string="name != 'Default'")
    run, *_ = client.search_runs([experiment.experiment_id])
    assert run.info.run_name == "knn_6dof"
    assert run.data.metrics["windows_2s"] == told["model"] > 0
    model = tmp_path / "knn" / "model.yaml"
    first = (tmp_path / "knn" / "residual.npz").read_bytes()
    main(["compare", f"campaign={campaign}", f"model=[nominal,{model}]", f"out={tmp_path / 'c'}"])
    found = json.loads((tmp_path / "c" / "comparison.json").read_text())
    alone = json.loads((tmp_path / "knn" / "comparison.json").read_text())
    assert found["models"]["model"] == alone["models"]["model"]
    main(["train", *arguments])
    assert (tmp_path / "knn" / "residual.npz").read_bytes() == first


def test_a_figure_that_another_process_drew_is_read_without_what_drew_it(tmp_path):
    """Results of a second process are unpacked while the first one computes, and hold it up."""
    drawn = Drawn(("where", ""), Picture("where", b"\x89PNG"), [tmp_path / "where.png"])
    (tmp_path / "drawn").write_bytes(pickle.dumps(drawn))
    code = (
        f"import pickle, sys; pickle.load(open({str(tmp_path / 'drawn')!r}, 'rb'));"
        "print(sorted({'matplotlib','jinja2','scipy','mlflow'} & set(sys.modules)))"
    )
    assert subprocess.check_output([sys.executable, "-c", code], text=True).strip() == "[]"


def test_names_that_are_listed_are_not_listed_again_as_a_remedy():
    told = [str(unlisted(n, ["gz", "mss"], found=f"no '{n}'", where="to")) for n in ("?", "mas")]
    assert told[0] == "to: no '?'. Expected one of gz, mss."
    assert told[1] == "to: no 'mas'. Expected one of gz, mss. Did you mean 'mss'?"


@pytest.mark.usefixtures("few_figures")
def test_without_a_campaign_that_of_the_study_is_learned_from(
    campaign, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit):
        main(["train", "residual=knn", "-q"])
    assert "no campaign was given. Expected" in unfolded(capsys.readouterr().err)
    shutil.copytree(campaign, tmp_path / "results" / "tank-default" / "raw")
    main(["train", "residual=knn", "out=knn", "--json"])
    ended = capsys.readouterr()
    assert json.loads(ended.out)["model"] == os.path.join("knn", "model.yaml")
    assert "that of the study is taken, results/tank-default/raw" in unfolded(ended.err)


def test_a_base_that_is_called_as_what_is_trained_is_refused(campaign, tmp_path, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["train", f"campaign={campaign}", f"model={tmp_path / 'model.yaml'}", "residual=knn"])
    assert ended.value.code == 2
    assert "the base is called 'model'" in unfolded(capsys.readouterr().err)


@pytest.mark.parametrize("words", [["--help"], ["diagnose", "--help"]])
def test_help_is_quick_because_it_imports_nothing_heavy(words):
    code = (
        f"import sys; from rovsim.apps.cli.main import main; main({words});"
        "print(sorted({'hydra','matplotlib','mlflow','nicegui','numba','pymavlink',"
        "'rosbags','scipy','torch'}"
        " & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip().endswith("[]")


@pytest.mark.parametrize(
    "module", ["application.configuration", "application.settings", "apps.cli.commands.ui"]
)
def test_settings_are_read_before_the_compiler_is_loaded(module):
    """What is asked wrongly is refused at once, and the first page is there at once."""
    code = (
        f"import sys, rovsim.{module};"
        "print(sorted({'hydra', 'numba', 'scipy.sparse', 'torch'} & set(sys.modules)))"
    )
    assert subprocess.check_output([sys.executable, "-c", code], text=True).strip() == "[]"
