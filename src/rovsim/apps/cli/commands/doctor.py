"""Say what this machine has of what rovsim can use: a look before a question.

rovsim doctor

Python and packages, cores, the folder of compiled code, settings, extras, and what extras need: a
browser for pictures of the workbench, Slurm for clusters. Nothing is changed; what is missing is
marked with a dash and how to get it.
"""

import os
import platform
import shutil
import sys
from typing import Callable

from rovsim import __version__
from rovsim.application.conf_search import first_folder
from rovsim.application.settings import CommandSettings, TrackingSettings
from rovsim.apps.cli.output import say
from rovsim.core.extras import EXTRA_PACKAGES, installed
from rovsim.core.second_process import usable_cores
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.compilation.cache import cache_folder

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
Line = tuple[str, bool, str]  # what, whether it is there, and more of it


class Settings(CommandSettings):
    """What `rovsim doctor` takes."""

    tracking: TrackingSettings


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Look, and say it."""
    checks: tuple[Callable[[], list[Line]], ...] = (
        _environment,
        _cores,
        _compiled,
        _settings,
        _extras,
        lambda: _services(settings.tracking),
    )
    lines = [line for check in checks for line in check()]
    text = "\n".join(
        f"  {'ok' if ok else '-':<3} {item:<10} {detail}" for item, ok, detail in lines
    )
    content = [{"what": item, "ok": ok, "told": detail} for item, ok, detail in lines]
    say(settings, text, content)


def _environment() -> list[Line]:
    inside = "a virtual environment" if sys.prefix != sys.base_prefix else "no virtual environment"
    return [
        ("rovsim", True, f"{__version__}, {len(EXTRA_PACKAGES)} extras known"),
        ("python", True, f"{platform.python_version()} in {sys.prefix} ({inside})"),
    ]


def _cores() -> list[Line]:
    return [("cores", True, f"{usable_cores()} usable of {os.cpu_count()}")]


def _compiled() -> list[Line]:
    folder = cache_folder()
    if not os.access(folder, os.W_OK):
        return [("compiled", False, f"{folder} cannot be written: set ROVSIM_CACHE to a folder")]
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    note = f"{size / 1e6:.0f} MB" if size else "empty: the first run compiles, up to a minute"
    return [("compiled", True, f"{note}, in {folder}")]


def _settings() -> list[Line]:
    return [("settings", True, first_folder())]


def _extras() -> list[Line]:
    return [
        (name, True, "installed")
        if installed(name)
        else (name, False, f"pip install 'rovsim[{name}]'")
        for name in EXTRA_PACKAGES
    ]


def _services(tracking: TrackingSettings) -> list[Line]:
    browser = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    slurm = shutil.which("sbatch")
    file = tracking.uri.removeprefix("sqlite:///")
    status = "a server" if file == tracking.uri else "no run was logged yet"
    status = "runs are kept there" if os.path.exists(file) else status
    return [
        ("browser", browser is not None, browser or "no Chromium: `playwright install chromium`"),
        ("slurm", slurm is not None, slurm or "no sbatch here; only clusters need it"),
        ("mlflow", True, f"{tracking.uri} ({status})"),
    ]
