"""The study at its smallest, and a working copy of the repository to run it in."""

import shutil
from pathlib import Path

ROOT = Path(__file__).parents[1]
SMALL = "tank=tiny study.residuals=[knn] study.controls=[6dof] timing.calls=50"


def copy_of(repository: Path, folder: Path) -> Path:
    """A working copy without results, so that a test may edit it."""
    for name in ("Snakefile", "conf", "workflow", "src", "pyproject.toml"):
        source = repository / name
        if source.is_dir():
            ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
            shutil.copytree(source, folder / name, ignore=ignored)
        else:
            shutil.copy(source, folder / name)
    return folder
