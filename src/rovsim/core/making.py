"""Say when, from which commit and on which machine a page is made.

Only pages for people contain this: files that programs read are equal for equal inputs.
"""

import os
import platform
import subprocess
import time
from contextlib import suppress
from pathlib import Path

import rovsim

SOURCES = Path(rovsim.__file__).parents[2]  # top of a clone; unrelated for an installed package
GIT_PATIENCE_S = 5.0


def describe_making() -> str:
    """Sentence with date, version, commit (where known) and machine."""
    commit = describe_commit()
    version = f"rovsim {rovsim.__version__}" + (f" (commit {commit})" if commit else "")
    date = time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime(_now()))
    return f"Made {date} by {version}, on {describe_machine()}."


def describe_machine() -> str:
    """Name the processor, the number of cores, and the version of Python."""
    name = platform.processor() or platform.machine()
    with suppress(OSError, StopIteration), open("/proc/cpuinfo", encoding="utf-8") as info:
        name = next(line.split(":")[1].strip() for line in info if "model name" in line)
    return f"{name}, {os.cpu_count()} cores, Python {platform.python_version()}"


def describe_commit(sources: Path = SOURCES) -> str:
    """Name the commit of the running sources, and say if they were changed; empty if no clone."""
    if not (sources / ".git").exists():
        return ""
    commit = _git(sources, "rev-parse", "--short=12", "HEAD")
    changed = _git(sources, "status", "--porcelain", "--untracked-files=no", "src", "conf")
    return f"{commit}, changed since" if commit and changed else commit


def _git(folder: Path, *words: str) -> str:
    """Run git in a folder and return its output; empty where git is missing or does not answer."""
    env = os.environ | {"GIT_OPTIONAL_LOCKS": "0"}  # do not disturb another git at work there
    with suppress(OSError, subprocess.SubprocessError):
        process = subprocess.run(
            ["git", "-C", str(folder), *words],
            capture_output=True,
            text=True,
            check=True,
            timeout=GIT_PATIENCE_S,
            env=env,
        )
        return process.stdout.strip()
    return ""


def _now() -> float:
    """Seconds since 1970; SOURCE_DATE_EPOCH (reproducible-builds.org) takes the clock's place."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    return float(epoch) if epoch.isdigit() else time.time()
