"""Study, folds, thesis, blind benchmark and a sweep through a real Slurm, all on this machine.

`make test-slurm` runs it, as root: Slurm's own job steps read nothing but /etc/slurm/slurm.conf.
`make test-slurm CHAPTER=whole` takes all of the thesis chapter, an hour of two cores.
"""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rovsim.application.configuration import compose
from rovsim.benchmarks.blind.run import Benchmark, file_name
from rovsim.core.yaml_files import read_yaml, write_yaml
from small_study import ROOT, SMALL, copy_of
from worlds import SHARED, needed

CONF = Path("/etc/slurm/slurm.conf")
DAEMONS = ("munged", "slurmctld", "slurmd")
WRITTEN = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPort=16817
SlurmdPort=16818
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc={folder}/completed.txt
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory=6000
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP PriorityTier=1
PartitionName=urgent Nodes={host} MaxTime=INFINITE State=UP PriorityTier=2
"""

pytestmark = [
    pytest.mark.skipif("ROVSIM_SLURM" not in os.environ, reason="make test-slurm runs it"),
]


@pytest.fixture(scope="module")
def slurm():
    """A cluster of one node; yields the file that lists its finished jobs."""
    lacking = [name for name in DAEMONS if shutil.which(name) is None]
    if lacking or os.geteuid() != 0:
        pytest.skip(f"needs root, and {', '.join(lacking) or 'nothing else'} (Debian: slurm-wlm)")
    if CONF.exists():
        pytest.skip(f"{CONF} is there: this machine is part of a cluster")
    folder = Path(os.environ.get("TMPDIR", "/tmp")) / f"slurm-{os.getpid()}"  # short: sockets
    for name in ("munge", "state", "spool"):
        (folder / name).mkdir(parents=True, mode=0o700)
    host = os.uname().nodename.partition(".")[0]
    CONF.parent.mkdir(exist_ok=True)
    CONF.write_text(WRITTEN.format(host=host, folder=folder, cores=os.cpu_count()))
    daemons = [
        subprocess.Popen(command)
        for command in (
            _munge(folder / "munge"),
            ["slurmctld", "-D"],
            ["slurmd", "-D"],
        )
    ]
    try:
        _wait(_idle, 300)  # on a machine that may be busy
        yield folder / "completed.txt"
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
            daemon.wait(30)
        print((folder / "completed.txt").read_text())
        CONF.unlink()
        shutil.rmtree(folder)


def _munge(folder: Path) -> list[str]:
    key = folder / "key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o600)
    names = {"key-file": key, "socket": folder / "socket", "pid-file": folder / "pid"}
    names |= {"log-file": folder / "log", "seed-file": folder / "seed"}
    return ["munged", "--foreground", "--force", *(f"--{k}={v}" for k, v in names.items())]


def _idle() -> bool:
    return "idle" in subprocess.run(["sinfo"], capture_output=True, text=True).stdout


def _wait(ready, seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not ready():
        assert time.monotonic() < end, "Slurm does not answer"
        time.sleep(0.5)


def call(folder: Path, *command: str) -> subprocess.Popen:
    paths = {"PYTHONPATH": str(ROOT / "src"), "ROVSIM_DATA": str(SHARED / "data")}
    environment = os.environ | paths
    with (folder / "log.txt").open("ab") as log:
        return subprocess.Popen(command, cwd=folder, stdout=log, stderr=log, env=environment)


def jobs(completed: Path, state: str) -> int:
    return completed.read_text().count(f"JobState={state}") if completed.exists() else 0


def cancelled(completed: Path) -> bool:
    """Cancel what runs; whether anything did."""
    subprocess.run(["scancel", "--state=RUNNING"], check=True)
    return jobs(completed, "CANCELLED") > 0


def preempted(completed: Path) -> bool:
    """Let an urgent job take the node of what runs; whether anything did."""
    urgent = ["sbatch", "--wait", "--partition=urgent", "--exclusive", "--output=/dev/null"]
    subprocess.run([*urgent, "--wrap=true"], check=True)
    return jobs(completed, "PREEMPTED") > 0


def snakemake(folder: Path, overrides: str, *words: str) -> subprocess.Popen:
    """A workflow over the cluster, which is asked more often than a large one would be."""
    return call(
        folder,
        sys.executable,
        "-m",
        "snakemake",
        "--profile",
        "workflow/profiles/slurm",
        "--slurm-status-command",
        "squeue",
        "--slurm-init-seconds-before-status-checks",
        "3",
        "--seconds-between-status-checks",
        "3",
        "--default-resources",
        "mem_mb=1500",
        "runtime=60",
        *words,
        "--config",
        f"overrides={overrides}",
    )


@pytest.fixture(scope="module")
def clone(tmp_path_factory) -> Path:
    """A working copy, whose results the tests add to."""
    folder = copy_of(ROOT, tmp_path_factory.mktemp("clone"))
    for name in ("profiles", "campaigns"):
        shutil.copytree(ROOT / name, folder / name)
    return folder


def ended_well(workflow: subprocess.Popen, folder: Path) -> None:
    assert workflow.wait(3 * 3600 if WHOLE else 3600) == 0, (folder / "log.txt").read_text()[-3000:]


def test_the_study_runs_job_by_job_and_a_cancelled_job_is_tried_again(slurm, clone):
    study = snakemake(clone, SMALL)
    _wait(lambda: jobs(slurm, "COMPLETED") > 3 or study.poll() is not None, 600)
    _wait(lambda: cancelled(slurm) or study.poll() is not None)
    ended_well(study, clone)
    results = clone / "results" / "tank-tiny"
    found = json.loads((results / "diagnosis.json").read_text())
    assert [one["effect"] for one in found["selected"]] == ["thruster_lag"]
    assert (results / "report.html").stat().st_size > 500
    assert jobs(slurm, "CANCELLED") >= 1
    assert jobs(slurm, "COMPLETED") > 40
    assert list((clone / ".snakemake" / "slurm_logs").rglob("*.log"))


def test_every_run_is_held_out_once(slurm, clone):
    """What `make thesis` does, on the runs of the study."""
    before = jobs(slurm, "COMPLETED")
    held_out = "folds.leave_one_run_out=true folds.residuals=[knn] folds.controls=[all]"
    ended_well(snakemake(clone, f"{SMALL} {held_out}"), clone)
    folds = clone / "results" / "tank-tiny" / "folds"
    runs = [folder.name for folder in sorted(folds.iterdir()) if folder.is_dir()]
    scored = [json.loads((folds / run / "comparison.json").read_text())["models"] for run in runs]
    assert runs == ["3dof-1", "6dof-1", "6dof-2"]
    for run, models in zip(runs, scored, strict=True):
        assert all(list(model["runs"]) == [run] for model in models.values())
        assert {"nominal", "effects", "knn_all"} <= set(models)
    assert jobs(slurm, "COMPLETED") >= before + len(runs)


# Unless the whole of it is asked for: all its rules, two of its runs, each held out once; a minute
# is looked at, for one effect.
WHOLE = os.environ.get("ROVSIM_SLURM") == "whole"
RUNS = ("114603", "120945")
EXPERIMENT = "+experiment=kth_tank_2025"
CHAPTER = (
    EXPERIMENT
    if WHOLE
    else (
        f"{EXPERIMENT} search.most_seconds=60 search.most_effects=1 search.trials=1 "
        "folds.residuals=[knn] folds.controls=[all] study.residuals=[knn] study.controls=[6dof] "
        "study.on_effects=[] timing.calls=50"
    )
)


def test_the_thesis_chapter_runs_and_a_preempted_job_is_queued_again(slurm, clone):
    needed(SHARED / "data" / "kth_tank_2025")
    file = clone / "campaigns" / "kth_tank_2025" / "campaign.yaml"
    content = read_yaml(file)
    held_out = {str(run["id"]) for run in content["runs"]} if WHOLE else set(RUNS)
    content["runs"] = [run for run in content["runs"] if str(run["id"]) in held_out]
    write_yaml(file, content)
    before = jobs(slurm, "COMPLETED")
    chapter = snakemake(clone, CHAPTER)
    _wait(lambda: jobs(slurm, "COMPLETED") > before + 3 or chapter.poll() is not None, 600)
    _wait(lambda: preempted(slurm) or chapter.poll() is not None)
    ended_well(chapter, clone)
    results = clone / "results" / "kth_tank_2025"
    cells = json.loads((results / "published_errors.json").read_text())["cells"]
    assert {cell["run"] for cell in cells} == held_out
    assert (results / "pitfalls.json").is_file()
    for rule in ("diagnose", "add", "refit", "fold", "split", "train/knn_all"):
        assert len(list(results.glob(f"folds/*/logs/{rule}.log"))) == len(held_out), rule
    assert jobs(slurm, "PREEMPTED") >= 1
    assert jobs(slurm, "COMPLETED") > before + 40


def test_cases_of_the_blind_benchmark_are_jobs(slurm, clone):
    words = ["blind.suite=quick", "blind.seeds=development", "blind.methods=[diagnosis]"]
    out = clone / "answers"
    benchmark = Benchmark.of(compose(words).blind, str(out))
    chosen = [job for job in benchmark.pending() if job.case.id.startswith("none/")][:2]
    asked = [f"{out}/.asked/{file_name(job.case)}.{job.mark}" for job in chosen]
    before = jobs(slurm, "COMPLETED")
    overrides = " ".join([*words, f"out={out}"])
    ended_well(snakemake(clone, overrides, "-s", "workflow/blind.smk", *asked), clone)
    left = {job.case.id for job in benchmark.pending()}
    assert len(chosen) == 2
    assert not left & {job.case.id for job in chosen}
    assert jobs(slurm, "COMPLETED") == before + 2


def test_a_sweep_runs_over_submitit(slurm, tmp_path):
    rovsim = (sys.executable, "-m", "rovsim")
    assert call(tmp_path, *rovsim, "tank", "tank=tiny", "out=raw").wait(600) == 0
    before = jobs(slurm, "COMPLETED")
    sweep = call(
        tmp_path,
        *rovsim,
        "train",
        "-m",
        "hydra/launcher=submitit_slurm",
        "hydra.launcher.partition=main",
        "hydra.launcher.mem_gb=2",
        "hydra.launcher.timeout_min=20",
        "campaign=raw",
        "residual=knn",
        "residual.k=5,9",
    )
    assert sweep.wait(1800) == 0, (tmp_path / "log.txt").read_text()[-3000:]
    _wait(lambda: jobs(slurm, "COMPLETED") >= before + 2)
    assert len(list((tmp_path / "results" / "multirun").rglob("model.yaml"))) == 2
