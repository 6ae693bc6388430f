"""The study on a tiny campaign: it ends, its numbers hold, edits re-run what they touch."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from rovsim.application.provenance import find_modules, imports_of
from rovsim.application.study.dependencies import SURROUNDING_MODULES
from small_study import ROOT, SMALL, copy_of

COMMENT = {".css": "\n/* edited */\n", ".json": "\n"}  # by ending; else "# edited"


def snakemake(folder: Path, *words: str, source: Path = ROOT / "src") -> str:
    """Output of one Snakemake call in the copy.

    The package is the repository's, of which other tests compile the same parts, or an edited one:
    what Snakemake compares is content.
    """
    command = [sys.executable, "-m", "snakemake", "--cores", "2", *words]
    environment = os.environ | {"PYTHONPATH": str(source)}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=500
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
    return done.stdout + done.stderr


def to_run(folder: Path) -> set[str]:
    """Rules a dry run would run."""
    text = snakemake(folder, "-n", "--config", f"overrides={SMALL}", source=folder / "src")
    return set(re.findall(r"^(?:local)?rule (\w+):", text, re.MULTILINE))


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A finished study."""
    folder = copy_of(ROOT, tmp_path_factory.mktemp("study"))
    snakemake(folder, "--config", f"overrides={SMALL}")
    return folder


def test_the_study_ends_in_results_and_edits_rerun_what_they_touch(study):
    results = study / "results" / "tank-tiny"
    ladder = json.loads((results / "ladder.json").read_text())
    steps = {step["model"]: step["windows_2s"] for step in ladder["steps"]}
    assert list(steps) == [
        "zero_acceleration",
        "nominal",
        "refitted",
        "+thruster_lag",
        "knn_6dof",
        "effects+knn_6dof",
        "noise_floor",
    ]
    assert steps["+thruster_lag"] < 0.2 * steps["nominal"] < steps["zero_acceleration"]
    assert steps["+thruster_lag"] < steps["refitted"] < steps["nominal"]
    assert 0.5 < steps["+thruster_lag"] / steps["noise_floor"] < 1.5
    for name in ("report.html", "comparison.json", "tables/ladder.tex", "figures/ladder.pdf"):
        assert (results / name).stat().st_size > 500
    assert ">Verdict<" in (results / "report.html").read_text()

    found = json.loads((results / "diagnosis.json").read_text())
    assert [one["effect"] for one in found["selected"]] == ["thruster_lag"]
    assert steps["+thruster_lag"] == pytest.approx(found["error"]["with_effects"], rel=1e-5)
    scored = json.loads((results / "comparison.json").read_text())["models"]
    assert set(scored) == {
        "zero_acceleration",
        "nominal",
        "refitted",
        "effects",
        "knn_6dof",
        "effects+knn_6dof",
    }
    assert set(tracked(study, results / "tracked.json")) == {*steps, "study", "diagnosis"} | set(
        scored
    )

    assert to_run(study) == set()

    reading = {"tank", "read", "judge", "resample", "filter", "differentiate"}
    touched = _edited(study, "src/rovsim/dynamics/effects/damping.py")
    assert {"replay", "diagnose", "add", "compare"} <= touched
    assert not reading & touched
    touched = _edited(study, "src/rovsim/dynamics/engine/equation.py")
    assert {"judge", "replay", "diagnose"} <= touched
    assert not {"tank", "read", "resample", "filter"} & touched
    touched = _edited(study, "src/rovsim/reporting/figures/ladder.py")
    assert "figure_ladder" in touched
    assert touched <= {"figure_ladder", "report", "track", "all"}
    touched = _edited(study, "src/rovsim/reporting/html/report.css")
    assert touched == {"report", "track", "all"}
    touched = _edited(study, "results/tank-tiny/timing.json")
    assert touched == {"figure_inference_time", "report", "track", "all"}
    assert _edited(study, "src/rovsim/intake/pairing.py") == set()
    touched = _edited(study, "conf/vehicle/bluerov2_heavy.yaml")
    assert {"tank", "read", "replay", "diagnose", "train"} <= touched
    touched = _edited(study, "src/rovsim/measurement/signals/filter.py")
    assert {"filter", "replay"} <= touched
    assert "read" not in touched


@pytest.mark.thorough
def test_a_fold_that_holds_out_the_test_run_finds_what_the_study_found(study):
    results = study / "results" / "tank-tiny"
    folds = f"{SMALL} folds.leave_one_run_out=true folds.residuals=[knn] folds.controls=[6dof]"
    held_out = results / "folds" / "6dof-2"
    target = str((held_out / "comparison.json").relative_to(study))
    snakemake(study, target, "--config", f"overrides={folds}")
    assert (held_out / "diagnosis.json").read_text() == (results / "diagnosis.json").read_text()
    whole, fold = (
        json.loads((folder / "comparison.json").read_text())["models"]
        for folder in (results, held_out)
    )
    assert list(fold) == list(whole)
    for name, model in fold.items():
        assert model["runs"] == {"6dof-2": whole[name]["runs"]["6dof-2"]}, name


def tracked(folder: Path, path: Path) -> list[str]:
    """Names of the study's MLflow runs; all of them exist."""
    from mlflow.tracking import MlflowClient

    client = MlflowClient(f"sqlite:///{folder / 'results' / 'mlflow.db'}")
    runs = json.loads(path.read_text())
    flat = {**runs, **runs["diagnosis"]}
    return [client.get_run(number).info.run_name for number in flat.values()]


def _edited(folder: Path, name: str) -> set[str]:
    """Rules that an edit of one file would run; the edit is taken back."""
    path = folder / name
    before = path.read_text()
    try:
        path.write_text(before + COMMENT.get(path.suffix, "\n# edited\n"))
        return to_run(folder)
    finally:
        path.write_text(before)


RULE = re.compile(r'(own_code|code_of)\("([\w.]+)".*?script:\s*"\.\./scripts/(\w+)\.py"', re.DOTALL)


def test_a_rule_depends_on_what_its_own_script_imports():
    rules = "".join(path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk"))
    found = RULE.findall(rules)
    assert len(found) == rules.count("script:\n") > 15
    for kind, name, script in found:
        assert name == ("simulation.synthetic_tank" if kind == "own_code" else script)


def _depends_on(script: str) -> set[str]:
    """Modules of rovsim whose edits run a script again."""
    path = ROOT / "workflow" / "scripts" / f"{script}.py"
    return find_modules(*imports_of(path), aside=SURROUNDING_MODULES)


def test_what_tells_of_results_depends_on_nothing_that_computes_them():
    report, tracked = _depends_on("report"), _depends_on("track")
    assert {"rovsim.reporting.words.verdict", "rovsim.dynamics.effects.damping"} <= report
    assert not {"rovsim.dynamics.engine.equation", "rovsim.simulation.replay"} & report
    assert "rovsim.application.tracking.mlflow_run" in tracked
    assert {name.split(".")[1] for name in tracked} == {"application", "core", "results"}
    assert "rovsim.reporting.html.report" not in _depends_on("tables")


def test_a_bad_campaign_is_one_message(tmp_path):
    folder = copy_of(ROOT, tmp_path)
    done = subprocess.run(
        [sys.executable, "-m", "snakemake", "--cores", "1", "--config", "campaign=nowhere"],
        cwd=folder,
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": str(folder / "src")},
    )
    assert done.returncode == 2
    assert "nowhere" in done.stderr
    assert "Traceback" not in done.stderr
