"""Every command of README and docs, in a fresh shell: `make commands [PAGES="README.md …"]`.

No test: the studies among them take minutes each. `.ci/weekly` runs it; of every command
tests/contracts/test_shell.py asks in seconds whether it is understood.

Every page begins in a new clone, in which lie recordings, a small campaign and a model, as its
reader has them, and goes from its first command to its last. Names that stand for the reader's own
are filled in (`OWN`); what serves is left once it answers; what is not run is told with the reason
(`LEFT_OUT`).
"""

import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.request import urlopen

from walk import ROOT, write_own

PAGES = ("README.md", *(f"docs/{path.name}" for path in sorted((ROOT / "docs").glob("*.md"))))
SHELL = re.compile(r"```sh\n(.*?)```", re.DOTALL)
PROGRAMS = r"rovsim|snakemake|mlflow|python -m rovsim\S*|gz"
INDENTED = re.compile(rf"(?:^    (?:(?:{PROGRAMS}) .*)\n)+", re.MULTILINE)
INLINE = re.compile(r"`((?:rovsim|snakemake|mlflow) [^`]*)`")
OWN = {  # what a page calls by a name of its own, and what it is here
    "FILE…": '"my recordings"/*',
    "FOLDER": '"my recordings"',
    "model=FILE": "model=NEW.yaml",
    "[a,b]": "[linear_damping,quadratic_damping]",
    "effect.parameter": "quadratic_damping.surge",
}
COPIES = ("paper.yaml", "mine.yaml", "model.yaml", "repaired.yaml")
LEFT_OUT = {  # begins with: why it is not run
    "make": "has a test or a page of its own",
    "gz ": "needs Gazebo",
    "python -m rovsim.benchmarks.designs": "takes 40 minutes",
    "rovsim blind": "takes hours; tests/contracts/test_blind.py",
    "snakemake -s workflow/blind.smk": "takes hours; tests/workflow/test_blind_workflow.py",
    "snakemake --profile workflow/profiles/slurm": "needs Slurm; make test-slurm",
    "rovsim train -m campaign=DIR residual=gp control=3dof,6dof hydra": "needs Slurm",
    'snakemake --cores 2 --config overrides="+experiment=kth': "needs the thesis' recordings",
    "pip install psycopg2": "needs a package index",
    "createdb": "needs PostgreSQL",
    "mlflow server": "needs PostgreSQL",
    "rovsim add 'effects": "names an option alone",
    "rovsim completion fish": "tests/contracts/test_completion.py",
}
TESTED = {  # pages whose files a test writes
    "docs/tutorial_equation.md": "tests/workflow/test_tutorial_equation.py",
}
PATIENCE = 120.0  # s for what serves to answer


def commands(page: str) -> list[str]:
    """Commands of a page, in their order: of shell and indented blocks, and whole ones in text."""
    text = (ROOT / page).read_text(encoding="utf-8")
    places = [place for kind in (SHELL, INDENTED, INLINE) for place in kind.finditer(text)]
    found = []
    for place in sorted(places, key=lambda m: m.start()):
        lines = place[place.lastindex or 0].replace("\\\n", " ").splitlines()
        found += [" ".join(line.partition(" #")[0].split()) for line in lines]
    return [line for line in dict.fromkeys(found) if line]


def left_out(page: str, line: str) -> str:
    """Why a command is not run; empty if it is."""
    if page in TESTED:
        return TESTED[page]
    if re.fullmatch(r"rovsim [a-z]+( -m)?", line):
        return "names the command alone"
    if "effects_file=" in line:
        return "tests/contracts/test_own_effects.py"
    if "…" in line.replace("FILE…", ""):
        return "leaves something out"
    return next((why for begin, why in LEFT_OUT.items() if line.startswith(begin)), "")


def prepare(folder: Path, described: bool) -> None:
    """A clone with what a reader has before the first command of a page.

    `described`: whether the recordings of DIR are a campaign already.
    """
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(folder)], check=True)
    (folder / ".venv").symlink_to(Path(sys.prefix))
    write_own(folder / "my recordings", folder / "raw")
    lines = [
        "rovsim tank tank=tiny out=tank-may --quiet",
        "rovsim diagnose campaign=tank-may out=prepared --quiet",
        "rovsim add diagnosis=prepared/diagnosis.json model=NEW.yaml --quiet",
        *(f"cp NEW.yaml {name}" for name in COPIES),
        *(["cp -r tank-may DIR"] if described else []),
    ]
    for line in lines:
        if said := run(line, folder):
            sys.exit(f"{line}\n{said}")


def run(line: str, folder: Path) -> str:
    """Type a command into a shell that has the environment alone; what it said, if it failed."""
    for name, own in OWN.items():
        line = line.replace(name, own)
    words = ["bash", "-c", f"source .venv/bin/activate && {line}"]
    known = {k: v for k, v in os.environ.items() if k in ("HOME", "PATH", "LANG", "ROVSIM_CACHE")}
    if line.startswith(("rovsim ui", "mlflow ui")):
        return serve(words, folder, known, 8501 if line.startswith("rovsim") else 5000)
    done = subprocess.run(
        words,
        cwd=folder,
        env=known,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    return done.stdout if done.returncode else ""


def serve(words: list[str], folder: Path, known: dict[str, str], port: int) -> str:
    """Start what serves, and end it once it answers."""
    process = subprocess.Popen(
        words,
        cwd=folder,
        env={**known, "BROWSER": "true"},
        start_new_session=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        begun = time.monotonic()
        while time.monotonic() - begun < PATIENCE:
            try:
                urlopen(f"http://127.0.0.1:{port}", timeout=5).close()
                return ""
            except OSError:
                if process.poll() is not None:
                    return "it ended"
                time.sleep(0.2)
        return "it does not answer"
    finally:
        os.killpg(process.pid, 15)
        process.wait(30)


def main(pages: list[str]) -> None:
    """Run them all, and count."""
    ran, failed = 0, []
    for page in pages or PAGES:
        lines = commands(page)
        if not lines:
            continue
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name) / "rovsim"
            if not all(left_out(page, line) for line in lines):
                prepare(folder, "out=DIR" not in " ".join(lines))
            for line in lines:
                if why := left_out(page, line):
                    print(f"{page}: not run ({why}): {line}", flush=True)
                    continue
                began = time.monotonic()
                said = run(line, folder)
                ran += 1
                print(f"{page}: {time.monotonic() - began:.0f} s: {line}", flush=True)
                if said:
                    failed.append(f"{page}: {line}")
                    print(f"FAILED\n{said}", flush=True)
    print(f"{ran} commands run, {len(failed)} failed", *failed, sep="\n")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main(sys.argv[1:])
