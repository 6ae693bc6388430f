"""Kill commands at random moments: the same command must then end as if nothing had happened.

python tests/kills.py [KILLS] [WORK …]      WORK: study diagnose compare train sweep blind

Each work is first done twice undisturbed; what these two agree on byte by byte (databases, and how
long an answer took, left out) must come out of a folder in which it was killed again and again.
"""

import hashlib
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rovsim.application.configuration import compose
from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.run import Benchmark
from small_study import ROOT, SMALL

SUITE = ["blind.suite=quick", "blind.seeds=development", "blind.methods=[stlsq]"]
ASKED = 3  # of its cases; the others are said to have been answered, which saves minutes
ROVSIM = [sys.executable, "-m", "rovsim"]
WORKS = {
    "study": [
        sys.executable,
        "-m",
        "snakemake",
        "--snakefile",
        str(ROOT / "Snakefile"),
        "--workflow-profile",
        str(ROOT / "profiles/default"),
        "--quiet",
        "all",
        "--config",
        f"overrides={SMALL}",
    ],
    "diagnose": [*ROVSIM, "diagnose", "campaign=raw", "out=results"],
    "compare": [*ROVSIM, "compare", "campaign=raw", "out=results"],
    "train": [*ROVSIM, "train", "campaign=raw", "residual=knn", "out=results"],
    "sweep": [
        *ROVSIM,
        "train",
        "-m",
        "campaign=raw",
        "residual=knn",
        "residual.k=5,9,15",
        "hydra.sweep.dir=results/sweep",
    ],
    "blind": [*ROVSIM, "blind", *SUITE, "blind.page=results/page.md", "out=results"],
}


TOOK = re.compile(rb'"(cpu_)?seconds(_95)?": [0-9.e+-]+')  # how long an answer of `blind` took


def start(command: list[str], folder: Path, log: str = "log.txt") -> subprocess.Popen:
    """A command in a process group of its own, so that all it started can be killed with it."""
    environment = os.environ | {
        "PYTHONPATH": str(ROOT / "src"),
        "PYTHONHASHSEED": "0",
        "SOURCE_DATE_EPOCH": "0",
    }
    with (folder / log).open("ab") as said:
        return subprocess.Popen(
            command, cwd=folder, env=environment, stdout=said, stderr=said, start_new_session=True
        )


def end(process: subprocess.Popen, log: Path) -> None:
    """It must be a good one."""
    if process.wait(timeout=1800):
        sys.exit(f"failed, {log}:\n{log.read_text()[-3000:]}")


def finish(work: str, folder: Path) -> float:
    """Seconds to the end."""
    begin = time.monotonic()
    end(start(WORKS[work], folder), folder / "log.txt")
    return time.monotonic() - begin


def fresh(work: str, scratch: Path, name: str) -> Path:
    """A folder in which the work has not begun."""
    folder = scratch / work / name
    folder.mkdir(parents=True)
    if work not in ("study", "blind"):
        shutil.copytree(scratch / "raw", folder / "raw")
    if work == "blind":
        answer_most(folder / "results")
    return folder


def answer_most(out: Path) -> None:
    """Answers to all cases but a few that hide nothing, as of a method that failed."""
    asked = Benchmark.of(compose(SUITE).blind, str(out)).pending()
    asked.sort(key=lambda job: not job.case.id.startswith("none/"))
    for job in asked[ASKED:]:
        for method, path, mark in job.methods:
            KeptAnswer(
                digest=mark,
                method=method.name,
                case=job.case,
                redrawn=False,
                seconds=0.0,
                cpu_seconds=0.0,
                diagnosis=None,
                bands=None,
                error="left out here",
            ).write(path)


def digests(folder: Path) -> dict[str, str]:
    """Of every result; what only the machine writes for itself is left out."""
    files = [
        p
        for p in sorted((folder / "results").rglob("*"))
        if p.is_file() and p.suffix not in (".db", ".log", ".lock") and "mlflow" not in p.parts
    ]
    content = {str(p.relative_to(folder)): TOOK.sub(b"", p.read_bytes()) for p in files}
    return {name: hashlib.sha256(one).hexdigest() for name, one in content.items()}


def disturb(work: str, kills: int, scratch: Path) -> tuple[int, int]:
    """Files compared, and files that differ, after so many kills."""
    alone = [fresh(work, scratch, name) for name in ("first", "second")]
    seconds = [finish(work, folder) for folder in alone]
    one, other = map(digests, alone)
    wanted = {name: one[name] for name in one if other.get(name) == one[name]}
    folder, done, wrong = fresh(work, scratch, "killed0"), 0, 0
    for k in range(kills):
        process = start(WORKS[work], folder)
        try:
            process.wait(timeout=random.uniform(0.0, 1.1 * seconds[1]))
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            done += 1
        if process.returncode == 0 or k == kills - 1:
            finish(work, folder)
            found = digests(folder)
            bad = [n for n in wanted if found.get(n) != wanted[n]]
            bad += [n for n in found if n not in one]  # what nobody asked for lies there
            for name in bad:
                print(f"  {work}: {name} differs after a kill ({folder})")
            wrong += len(bad)
            folder = fresh(work, scratch, f"killed{k + 1}")
    alike = f"{len(wanted)} files alike in two undisturbed runs of {seconds[1]:.0f} s"
    other = f"{len(one) - len(wanted)} differ there"
    print(f"{work}: {done} kills, {alike} ({other}), {wrong} wrong after kills", flush=True)
    return done, wrong


def main() -> None:
    kills = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    works = sys.argv[2:] or list(WORKS)
    random.seed(0)
    scratch = Path(tempfile.mkdtemp(prefix="kills-"))
    subprocess.run(
        [*ROVSIM, "tank", "tank=tiny", f"out={scratch / 'raw'}"],
        check=True,
        stdout=subprocess.DEVNULL,
        env=os.environ | {"PYTHONPATH": str(ROOT / "src")},
    )
    wrong = sum(disturb(work, kills, scratch)[1] for work in works)
    shutil.rmtree(scratch) if not wrong else print(f"left in {scratch}")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
