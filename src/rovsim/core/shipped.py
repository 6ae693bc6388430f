"""Find files that come with rovsim: at the top of a checkout, or inside an installed package."""

from importlib.resources import files
from pathlib import Path

import rovsim

CONF = "conf"


def shipped(folder: str) -> Path:
    """Path of a folder that comes with rovsim, such as `conf` or `docs/images/effects`."""
    path = Path(str(files(rovsim))) / folder
    return path if path.is_dir() else Path(rovsim.__file__).parents[2] / folder


def conf_folders() -> list[Path]:
    """List the folders of the configuration: `conf/` of the working folder, then the shipped one.

    A file in the first hides the file of the same name in the second.
    """
    local = Path(CONF).absolute()
    return list(dict.fromkeys([local, shipped(CONF)] if local.is_dir() else [shipped(CONF)]))


def conf_file(name: str) -> Path | None:
    """Find a file of the configuration by its relative path; None if there is none."""
    return next((path for folder in conf_folders() if (path := folder / name).is_file()), None)


def conf_names(group: str) -> list[str]:
    """List the stems of the YAML files in a group of the configuration, sorted."""
    return sorted(
        {path.stem for folder in conf_folders() for path in (folder / group).glob("*.yaml")}
    )
