"""A newcomer's walk with a watch: `make walk` (no test: minutes, and it needs a package index).

From a fresh clone, with an empty folder of compiled code: the README's set-up, then the tutorial to
the line that says that the error fell; then csv files of one's own, from `rovsim init` to a first
verdict. The commands are those of README.md and docs/tutorial.md as they stand there.
"""

import os
import re
import resource
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from urllib.request import urlopen

import numpy as np

from rovsim.apps.cli.main import main as rovsim
from rovsim.core.files import read_json
from rovsim.core.rotations import to_euler
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording.run_files import read_run

ROOT = Path(__file__).parents[1]
PRACTICE, OWN = 600.0, 1200.0  # s, wanted: to "the error falls", and to a first verdict
SEED = 21  # of the tank that stands for the newcomer's own recordings
ADDRESS = "http://127.0.0.1:8501"


class Walk:
    """A newcomer in a terminal: every step is timed."""

    def __init__(self, folder: Path) -> None:
        self.clone, self.begun = folder / "rovsim", time.monotonic()
        cache = folder / "compiled"
        self.surroundings = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
        self.surroundings |= {"ROVSIM_CACHE": str(cache)}
        self.rows: list[tuple[str, float, float, float]] = []

    def step(self, line: str, where: Path | None = None) -> None:
        """Type one line, wait for it, and note how long it took."""
        began, worked = time.monotonic(), processor_time()
        if line.startswith("rovsim ui"):
            self._look(line)
        else:
            self._run(line, where or self.clone)
        now = time.monotonic()
        self.rows.append((line, now - began, processor_time() - worked, now - self.begun))
        print(f"{now - self.begun:7.0f} s  {now - began:6.1f} s  {line}", flush=True)

    def _run(self, line: str, where: Path) -> None:
        prompt = "source .venv/bin/activate && " if (self.clone / ".venv").exists() else ""
        done = subprocess.run(
            ["bash", "-c", prompt + line],
            cwd=where,
            env=self.surroundings,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        if done.returncode:
            sys.exit(f"{line}\n{done.stdout}")

    def _look(self, line: str) -> None:
        """Open the workbench, and leave it once its page is there."""
        words = [str(self.clone / ".venv/bin/rovsim"), *shlex.split(line)[1:], "open=false"]
        process = subprocess.Popen(
            words, cwd=self.clone, env=self.surroundings, stdout=subprocess.DEVNULL
        )
        try:
            while True:
                try:
                    urlopen(ADDRESS, timeout=5).close()
                    return
                except OSError:
                    if process.poll() is not None:
                        sys.exit(f"{line}: it ended")
                    time.sleep(0.1)
        finally:
            process.terminate()
            process.wait(20)


def processor_time() -> float:
    """Seconds that processors have worked for what was started here: the same on a busy machine."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def blocks(page: str) -> list[list[str]]:
    """Lines of the shell blocks of a page, without what is said behind them."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    return [[line.partition(" #")[0].strip() for line in block.splitlines()] for block in found]


def practice(walk: Walk) -> float:
    """To the error that falls on the practice tank; seconds since the start."""
    for block in blocks("docs/tutorial.md"):
        for line in block:
            walk.step(line)
            if line.startswith("rovsim diagnose"):
                error = read_json(walk.clone / "found" / "diagnosis.json")["error"]
                fell = f"{error['nominal']:.3g} to {error['with_effects']:.3g}"
                if not error["with_effects"] < 0.5 * error["nominal"]:
                    sys.exit(f"the error did not fall: {fell}")
                reached = walk.rows[-1][-1]
                print(f"           the error falls from {fell}", flush=True)
    return reached


def own_lines() -> Iterator[str]:
    """The README's lines on one's own recordings, the environment being there."""
    (block,) = (one for one in blocks("README.md") if any("rovsim init" in line for line in one))
    yield from (line for line in block if line.startswith("rovsim"))


def own(walk: Walk, files: Path) -> float:
    """From csv files to a first verdict; seconds since their first command."""
    began = time.monotonic()
    for line in own_lines():
        names = " ".join(shlex.quote(str(path)) for path in sorted(files.iterdir()))
        walk.step(line.replace("FILE…", names).replace("DIR", "OWN"))
        if line.startswith("rovsim diagnose"):
            found = read_json(walk.clone / "FOUND" / "diagnosis.json")
            names = ", ".join(one["effect"] for one in found["selected"])
            print(f"           {found['verdict']}: {names}", flush=True)
            return time.monotonic() - began
    sys.exit("README.md has no `rovsim diagnose` among its lines on one's own recordings")


def write_own(folder: Path, raw: Path) -> None:
    """Csv files of a tank, as a laboratory's own program might write them."""
    rovsim(["tank", "tank=default", f"tank.seed={SEED}", f"out={raw}", "--quiet"])
    campaign = load_campaign(raw)
    folder.mkdir()
    for run in campaign.runs:
        recording = read_run(campaign, run.id)[0]
        seen = recording.tracked
        roll, pitch, yaw = np.degrees(to_euler(recording.attitude[seen])).T
        x, y, z = recording.position[seen].T
        columns = {
            "Yaw (deg)": yaw,
            "Z (m)": z,
            "Time (s)": recording.time[seen],
            "X (m)": x,
            "Roll (deg)": roll,
            "Y (m)": y,
            "Pitch (deg)": pitch,
        }
        write_csv(folder / f"{run.id} motion.csv", list(columns), np.stack([*columns.values()], 1))
        log = campaign.commands_path(run)
        names = log.read_text(encoding="utf-8").splitlines()[0].split(",")
        turned = np.genfromtxt(log, delimiter=",", skip_header=1)[:, ::-1]
        write_csv(folder / f"{run.id} commands.csv", names[::-1], turned)


def write_csv(path: Path, names: list[str], rows: np.ndarray) -> None:
    """A csv file with a head line."""
    np.savetxt(path, rows, delimiter=",", header=",".join(names), comments="", fmt="%.6f")


def main() -> None:
    """Walk, and print the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_own(folder / "my recordings", folder / "raw")
        walk = Walk(folder)
        walk.step(f"git clone --quiet {shlex.quote(str(ROOT))} rovsim", folder)
        walk.step("make setup")
        first = practice(walk)
        second = own(walk, folder / "my recordings")
    print("\n| step | s | of a processor | since the start |\n|---|---|---|---|")
    for line, took, worked, since in walk.rows:
        shown = line.replace(str(folder), "…")
        print(f"| `{shown}` | {took:.1f} | {worked:.1f} | {since:.0f} |")
    print(f"\nThe error falls after {first:.0f} s (wanted: {PRACTICE:.0f} s), own csv files have a")
    print(f"verdict after {second:.0f} s (wanted: {OWN:.0f} s), on {os.cpu_count()} cores.")
    sys.exit(first > PRACTICE or second > OWN)


if __name__ == "__main__":
    main()
