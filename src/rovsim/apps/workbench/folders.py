"""Folders to choose a campaign from: what a folder holds, and which campaigns were opened last."""

import os
from dataclasses import dataclass
from pathlib import Path

from platformdirs import user_state_path

from rovsim.core.errors import BadInput, RovsimError
from rovsim.core.files import read_json, write_json

MAX_FOLDERS = 200  # listed of one
MAX_KEPT_CAMPAIGNS = 8
CAMPAIGN_FILE = "campaign.yaml"


@dataclass(frozen=True)
class Inside:
    """A folder inside another: its path, and whether it holds a campaign."""

    path: Path
    campaign: bool


@dataclass(frozen=True)
class Listing:
    """What a folder holds.

    Attributes:
        folder: absolute path.
        parents: of the folder, the root first.
        inside: folders in it that match, sorted by name, at most `MAX_FOLDERS`.
        more: how many others match.
        files: how many files it holds.
        problem: why it cannot be read; empty if it can.
    """

    folder: Path
    parents: tuple[Path, ...]
    inside: tuple[Inside, ...] = ()
    more: int = 0
    files: int = 0
    problem: str = ""

    @property
    def campaign(self) -> bool:
        """Whether the folder itself holds a campaign."""
        return _holds_campaign(self.folder)


def look(folder: Path, part: str = "") -> Listing:
    """List what a folder holds; the nearest one above it where there is no such folder.

    Args:
        folder: any path.
        part: only folders whose name holds this text are listed, whatever the case of its letters.
    """
    folder = Path(os.path.abspath(os.path.expanduser(folder)))
    while not os.path.isdir(folder) and folder != folder.parent:
        folder = folder.parent
    parents = tuple(reversed(folder.parents))
    try:
        with os.scandir(folder) as entries:
            contents = [(entry.name, _is_folder(entry)) for entry in entries]
    except OSError as error:
        return Listing(folder, parents, problem=error.strerror or str(error))
    folders = (name for name, is_folder in contents if is_folder and not name.startswith("."))
    names = sorted(name for name in folders if part.casefold() in name.casefold())
    paths = [folder / name for name in names[:MAX_FOLDERS]]
    inside = tuple(Inside(path, _holds_campaign(path)) for path in paths)
    files = sum(not is_folder for _, is_folder in contents)
    return Listing(folder, parents, inside, len(names) - len(inside), files)


def tell_unopenable(place: Path) -> str:
    """Say why a path is neither a campaign nor a folder of recordings; empty if it may be one."""
    problem, remedy = "no such file or folder", "Check the path, or look for the folder below."
    try:
        if place.is_dir() or (place.suffix in (".yaml", ".yml") and place.is_file()):
            return ""
        if place.exists():
            problem, remedy = "this is a file", f"Open {place.absolute().parent}."
    except (OSError, ValueError) as error:  # nobody may look, or no system takes such a name
        problem = str(error)
    expected = "the folder of a campaign, or of recordings"
    return str(BadInput(problem, where=place.absolute(), expected=expected, remedy=remedy))


def _is_folder(entry: os.DirEntry) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # a link that leads in a circle
        return False


def _holds_campaign(path: Path) -> bool:
    try:
        return (path / CAMPAIGN_FILE).is_file()
    except OSError:  # nobody may look into it
        return False


def list_recent() -> list[Path]:
    """List the campaigns that were opened last and still exist, the latest first."""
    try:
        content = read_json(_file())
    except RovsimError:
        return []
    folders = content.get("campaigns") if isinstance(content, dict) else None
    folders = folders if isinstance(folders, list) else []
    paths = [Path(folder) for folder in folders if isinstance(folder, str)]
    return [path for path in paths if _holds_campaign(path)]


def remember(campaign: Path) -> None:
    """Put a campaign first among those opened last; does nothing where that cannot be written."""
    path = Path(os.path.abspath(campaign))
    folders = [path, *(folder for folder in list_recent() if folder != path)]
    try:
        write_json(_file(), {"campaigns": [str(folder) for folder in folders[:MAX_KEPT_CAMPAIGNS]]})
    except (OSError, ValueError, RovsimError):  # read-only, full, a name that is no text
        return


def shown(path: Path) -> str:
    """Return a path as text that a page can show, whatever bytes it is made of."""
    return str(path).encode("utf-8", "replace").decode()


def _file() -> Path:
    """Return the file of recent campaigns, in the user's state folder (XDG_STATE_HOME on Linux)."""
    return user_state_path("rovsim", appauthor=False) / "recent.json"
