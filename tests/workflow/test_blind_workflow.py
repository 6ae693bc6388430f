"""The blind benchmark as a workflow: a case is a job, and what is answered is none."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from rovsim.application.configuration import compose
from rovsim.benchmarks.blind.run import Benchmark, file_name

pytest.importorskip("pysindy")
ROOT = Path(__file__).parents[2]
WORDS = ["blind.suite=quick", "blind.seeds=development", "blind.methods=[stlsq]"]


def snakemake(
    folder: Path, overrides: str, *words: str, told: tuple[str, ...] = ()
) -> subprocess.CompletedProcess[str]:
    """One call of the workflow."""
    command = [sys.executable, "-m", "snakemake", "-s", str(ROOT / "workflow/blind.smk")]
    return subprocess.run(
        [*command, "--cores", "1", *words, "--config", f"overrides={overrides}", *told],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=500,
        env=os.environ | {"PYTHONPATH": str(ROOT / "src")},
    )


@pytest.mark.thorough
def test_a_case_is_a_job_and_is_not_asked_again(tmp_path):
    out = tmp_path / "answers"
    benchmark = Benchmark.of(compose(WORDS).blind, str(out))
    jobs = benchmark.pending()
    assert len(jobs) == len(benchmark.cases)
    one = next(job for job in jobs if job.case.id.startswith("none/"))
    asked = f"{out}/.asked/{file_name(one.case)}.{one.mark}"
    done = snakemake(tmp_path, " ".join([*WORDS, f"out={out}"]), asked)
    assert done.returncode == 0, done.stderr[-3000:]
    left = benchmark.pending()
    assert {job.case.id for job in jobs} - {job.case.id for job in left} == {one.case.id}


def test_a_suite_that_is_not_there_is_one_message(tmp_path):
    done = snakemake(tmp_path, "blind.suite=hidden", "-n")
    assert done.returncode == 2
    assert "blind.suite" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_key_that_the_benchmark_does_not_know_is_one_message(tmp_path):
    done = snakemake(tmp_path, "blind.suite=quick", "-n", told=("campaign=mine",))
    assert done.returncode == 2
    assert "unknown key 'campaign'" in done.stderr
