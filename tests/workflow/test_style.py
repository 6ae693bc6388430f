"""The workflow is formatted, and as Snakemake recommends, but for one thing decided otherwise."""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
# One environment.lock for all: commands, workbench and workflow are one package.
DECIDED = "Specify a conda environment or container for each rule."


def test_the_workflow_is_formatted():
    command = [sys.executable, "-m", "snakefmt", "--check", "Snakefile", "workflow"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_snakemake_has_nothing_else_to_recommend():
    overrides = "folds.leave_one_run_out=true folds.pitfalls=true"
    command = [sys.executable, "-m", "snakemake", "--lint", "--config"]
    done = subprocess.run(
        [*command, f"overrides={overrides}"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT / "src")},
    )
    titles = re.findall(r"^ +\* (.*):$", done.stderr, re.MULTILINE)
    assert set(titles) == {DECIDED}, done.stderr
