"""Let only one study of a campaign run at a time."""

from pathlib import Path

from filelock import FileLock, Timeout

from rovsim.core.errors import BadInput
from rovsim.core.files import make_folder, unwritable

HELD_LOCKS: dict[Path, FileLock] = {}  # until the process ends


def hold(folder: Path) -> None:
    """Keep other studies out of a folder until this process ends, however it ends.

    Snakemake's own lock is a file that remains when its process is killed.

    Raises:
        BadInput: another process writes there, or the folder cannot be written to.
    """
    make_folder(folder)
    HELD_LOCKS[folder] = FileLock(folder / ".study.lock", blocking=False)
    try:
        HELD_LOCKS[folder].acquire()
    except Timeout:
        raise BadInput(
            "another study writes here",
            where=folder,
            expected="one study of a campaign at a time",
            remedy="Wait until it ends, or stop it: what it finished is kept.",
        ) from None
    except OSError as error:
        raise unwritable(folder, error) from None
