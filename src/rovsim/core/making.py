"""When, from which commit and on which machine something is made.

Only pages for people say it: a file that programs read is equal for equal inputs.
"""

import os
import platform
import subprocess
import time
from contextlib import suppress
from pathlib import Path

import rovsim

SOURCES = Path(rovsim.__file__).parents[2]  # of a clone; of an installed package a folder of others
PATIENCE = 5.0  # s, for git


def tell_making() -> str:
    """Date, version, commit where it is known, and machine, as a sentence."""
    commit = describe_commit()
    version = f"rovsim {rovsim.__version__}" + (f" (commit {commit})" if commit else "")
    when = time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime(_now()))
    return f"Made {when} by {version}, on {describe_machine()}."


def describe_machine() -> str:
    """Processor, cores and Python."""
    name = platform.processor() or platform.machine()
    with suppress(OSError, StopIteration), open("/proc/cpuinfo", encoding="utf-8") as info:
        name = next(line.split(":")[1].strip() for line in info if "model name" in line)
    return f"{name}, {os.cpu_count()} cores, Python {platform.python_version()}"


def describe_commit(sources: Path = SOURCES) -> str:
    """The commit of the sources that run, and whether they were changed since; empty: no clone."""
    if not (sources / ".git").exists():
        return ""
    commit = _git(sources, "rev-parse", "--short=12", "HEAD")
    changed = _git(sources, "status", "--porcelain", "--untracked-files=no", "src", "conf")
    return f"{commit}, changed since" if commit and changed else commit


def _git(folder: Path, *words: str) -> str:
    """What git says; nothing where it is not installed, or does not answer."""
    quiet = os.environ | {"GIT_OPTIONAL_LOCKS": "0"}  # another git may be at work there
    with suppress(OSError, subprocess.SubprocessError):
        done = subprocess.run(
            ["git", "-C", str(folder), *words],
            capture_output=True,
            text=True,
            check=True,
            timeout=PATIENCE,
            env=quiet,
        )
        return done.stdout.strip()
    return ""


def _now() -> float:
    """Seconds since 1970; SOURCE_DATE_EPOCH (reproducible-builds.org) takes the clock's place."""
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    return float(given) if given.isdigit() else time.time()
