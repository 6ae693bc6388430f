"""Files that come with rovsim: in a checkout at its top, in an installed package inside it."""

from importlib.resources import files
from pathlib import Path

import rovsim

CONF = "conf"


def shipped(folder: str) -> Path:
    """A folder that comes with rovsim, such as `conf` or `docs/images/effects`."""
    inside = Path(str(files(rovsim))) / folder
    return inside if inside.is_dir() else Path(rovsim.__file__).parents[2] / folder


def conf_folders() -> list[Path]:
    """Where the configuration lies: `conf/` of the working folder, if there, then what ships.

    A file of the first hides the file of that name in the second.
    """
    own = Path(CONF).absolute()
    return list(dict.fromkeys([own, shipped(CONF)] if own.is_dir() else [shipped(CONF)]))


def conf_file(name: str) -> Path | None:
    """A file of the configuration by its path in it, None if there is none."""
    return next((path for folder in conf_folders() if (path := folder / name).is_file()), None)


def conf_names(group: str) -> list[str]:
    """Stems of the YAML files of one group, in order."""
    return sorted(
        {path.stem for folder in conf_folders() for path in (folder / group).glob("*.yaml")}
    )
