"""Each run held out once: what it asks for, and what it says when something is not there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from recordings import write_campaign, write_lines
from rovsim.application.configuration import compose
from rovsim.application.pipeline.held_out import measure_pitfalls_by_run
from rovsim.application.study.leave_one_run_out import LeaveOneRunOut
from rovsim.application.study.study import Study
from rovsim.apps.cli.main import main
from rovsim.core.bounded_cache import ReadAgain
from rovsim.core.errors import BadInput
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.signals.chain import SignalSettings, clean
from rovsim.reporting.figures import find_figure
from rovsim.simulation.settings import SimulationSettings
from said import unfolded

ROOT = Path(__file__).parents[2]
KTH = ROOT / "campaigns" / "kth_tank_2025"
NAMES = "u_m_s,v_m_s,w_m_s,p_rad_s,q_rad_s,r_rad_s"
SURGE = "time_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad," + NAMES + ",surge"
QUICK = SignalSettings()
CONTROLS = {"one": "3dof", "two": "6dof", "three": "6dof"}


@pytest.fixture
def folder(tmp_path):
    """Three short runs in uneven bins, straight ahead, and what was published for one of them."""
    folder = tmp_path / "bins"
    for k, run in enumerate(CONTROLS):
        time = np.cumsum(np.tile([0.1, 0.2, 0.15], 40))
        u, zero = 0.3 * np.sin(time + k), 0.0 * time
        columns = [time, -0.3 * np.cos(time + k), *[zero] * 5, u, *[zero] * 5, np.cos(time + k)]
        rows = np.column_stack(columns)
        lines = [SURGE, *(",".join(f"{x:.5f}" for x in row) for row in rows)]
        write_lines(folder / f"{run}.csv", lines)
    head = "run,variant,model,axis,acceleration_rmse,velocity_mae,velocity_rmse"
    write_lines(folder / "published.csv", [head, "one,a,knn,surge,0.2,0.1,0.1"])
    runs = [
        {"id": r, "control": c, "split": "train", "mocap": f"{r}.csv", "commands": f"{r}.csv"}
        for r, c in CONTROLS.items()
    ]
    runs[-1]["split"] = "test"
    mocap = {"format": "csv", "world_axes": "ned", "body_axes": "frd"}
    commands = {"format": "csv", "kind": "demand", "columns": ["surge"]}
    content = {"name": "bins", "vehicle": "bluerov2_heavy", "mocap": mocap, "commands": commands}
    return write_campaign(folder, content | {"runs": runs, "source": "Ask the harbour master."})


def folds_of(folder, *words):
    overrides = ["folds.leave_one_run_out=true", "folds.published=published.csv", *words]
    return LeaveOneRunOut(Study({"campaign": str(folder), "overrides": overrides}))


def test_every_run_is_held_out_once_and_learners_have_runs_to_learn_from(folder):
    found = folds_of(folder, "folds.controls=[3dof,6dof]", "folds.residuals=[knn]")
    assert found.runs == list(CONTROLS)
    assert found.train_runs("three", "6dof") == ["two"]
    physics = ["refitted", "effects"]
    assert found.models("one") == [*physics, "knn_6dof", "effects+knn_6dof"]
    assert found.models("two") == [
        *physics,
        "knn_3dof",
        "knn_6dof",
        "effects+knn_3dof",
        "effects+knn_6dof",
    ]
    assert found.published == folder / "published.csv"
    assert find_figure("against_published") in found.figures


def test_a_run_held_out_is_not_learned_from(folder, monkeypatch):
    """Also where runs are read from their files each time they are asked for."""
    campaign = load_campaign(folder)
    motions = ReadAgain([*campaign.runs], lambda run: clean(read_run(campaign, run.id)[0], QUICK))
    asked = {}

    def noted(model, train, test, *rest):
        asked[test.run.id] = [motion.run.id for motion in train]
        return {}

    monkeypatch.setattr("rovsim.application.pipeline.held_out.measure_pitfalls", noted)
    measure_pitfalls_by_run(motions, [None] * 3, {}, SimulationSettings(signals=QUICK))
    assert asked == {run: [one for one in CONTROLS if one != run] for run in CONTROLS}


def test_a_study_without_folds_has_none(folder):
    found = LeaveOneRunOut(Study({"campaign": str(folder)}))
    assert (found.runs, found.published, found.targets) == ([], None, [])
    assert find_figure("against_published") not in found.figures


def test_what_folds_lack_is_said(folder):
    (folder / "published.csv").unlink()
    with pytest.raises(BadInput, match=r"published\.csv: no such file.*Ask the harbour master"):
        folds_of(folder).check()
    for word in ("folds.published=published.csv", "folds.pitfalls=true"):
        with pytest.raises(BadInput, match="only with leave_one_run_out=true"):
            compose([word])


def test_the_experiment_names_campaign_published_numbers_and_learners():
    settings = compose(["+experiment=kth_tank_2025"])
    assert settings.campaign == "campaigns/kth_tank_2025"
    assert settings.folds.leave_one_run_out
    assert settings.folds.published == "published.csv"
    assert settings.folds.residuals == ("knn", "gp")
    with pytest.raises(BadInput, match="Did you mean 'kth_tank_2025'"):
        compose(["+experiment=kth_tank"])


def complete(message):
    """Whether one message says what is missing, where to get it and in which form."""
    runs = [f"run_{run}.csv" for run in ("115750", "114038", "120945", "114603")]
    source = [
        "SAABmarine-MEX/saabmarineMEX_learning",
        "dda3f3d",
        "dictfiles_plot/*.npz",
        "ROVSIM_DATA",
    ]
    words = [*runs, *source, "one csv a run", "time_s", "yaw_rad", "r_rad_s"]
    return [word for word in words if word not in message] == []


@pytest.mark.parametrize("command", ["compare", "diagnose", "train"])
def test_commands_say_where_recordings_that_are_not_here_can_be_got(
    command, tmp_path, monkeypatch, capsys
):
    monkeypatch.setenv("ROVSIM_DATA", str(tmp_path / "nowhere"))
    with pytest.raises(SystemExit) as ended:
        main([command, f"campaign={KTH}", f"out={tmp_path / 'out'}"])
    assert ended.value.code == 2
    text = unfolded(capsys.readouterr().err)
    assert text.count("rovsim: ") == 1
    assert complete(text)
    assert not list(tmp_path.iterdir())


def snakemake(folder, overrides, **environment):
    """A dry run of the study in a folder, with this package."""
    for name in ("Snakefile", "workflow", "campaigns"):
        (folder / name).symlink_to(ROOT / name)
    command = [sys.executable, "-m", "snakemake", "-n", "--cores", "1", "--config"]
    return subprocess.run(
        [*command, f"overrides={overrides}"],
        cwd=folder,
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT / "src")} | environment,
    )


def test_the_workflow_says_it_too(tmp_path):
    done = snakemake(tmp_path, "+experiment=kth_tank_2025", ROVSIM_DATA=str(tmp_path / "nowhere"))
    assert done.returncode == 2
    assert complete(done.stderr)
    assert "Traceback" not in done.stderr


def test_the_workflow_plans_every_fold_with_its_learners(folder, tmp_path):
    words = [
        f"campaign={folder.name}",
        "folds.leave_one_run_out=true",
        "folds.published=published.csv",
        "folds.pitfalls=true",
    ]
    done = snakemake(tmp_path, " ".join(words))
    assert done.returncode == 0, done.stderr
    planned = re.findall(r"^rule (\w+):", done.stdout + done.stderr, re.MULTILINE)
    each = ("split", "diagnose_fold", "add_fold", "refit_fold", "fold")
    assert {name: planned.count(name) for name in each} == dict.fromkeys(each, 3)
    assert planned.count("train_fold") == 3 * 4  # knn and gp, on nominal and on effects
    assert planned.count("against_published") == planned.count("figure_against_published") == 1
    assert planned.count("pitfalls") == 1
