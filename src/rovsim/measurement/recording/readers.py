"""The formats that can be read. A new one is a new module here that declares its reader."""

import pkgutil
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Callable, Sequence, TypeVar

from rovsim.core.errors import BadInput, nearest, unlisted
from rovsim.core.rotations import BodyAxes, WorldAxes
from rovsim.core.run import CommandKind
from rovsim.measurement.campaign_file import CommandLog, Mocap
from rovsim.measurement.recording.exports import CommandExport, Export
from rovsim.measurement.recording.signature import Signature

# What a kind of logged command drives.
KIND: dict[str, CommandKind] = {
    "pwm": "thruster",
    "normalized": "thruster",
    "demand": "demand",
    "wrench": "wrench",
}


def choose_body(names: Sequence[str], wanted: str, where: Path | str) -> str:
    """The body of a file that holds several: the one that is wanted, or the only one.

    Raises:
        BadInput: it has none of that name, or several and none was named.
    """
    if wanted in names:
        return wanted
    if not wanted and len(names) == 1:
        return names[0]
    raise BadInput(
        f"no rigid body '{wanted}'; the file has {', '.join(names) or 'none'}",
        where=where,
        expected="the body named by 'mocap.body' in campaign.yaml",
        remedy=nearest(wanted, names),
    )


@dataclass(frozen=True)
class FileAxes:
    """Axes that files of a format may have, and those that they have where nothing tells.

    `said` is why, of these and of the only ones.
    """

    world: tuple[WorldAxes, ...] = ("z_up", "ned")
    body: tuple[BodyAxes, ...] = ("flu", "frd")
    usual: tuple[WorldAxes, BodyAxes] | None = None
    said: str = ""

    @property
    def every(self) -> tuple[str, ...]:
        """Of the world, then of the body."""
        return (*self.world, *self.body)

    @property
    def fixed(self) -> bool:
        """Whether there are no others to choose from."""
        return len(self.world) == len(self.body) == 1


@dataclass(frozen=True)
class MocapReader:
    """A format of motions, declared as `MOCAP_READER` where it is read.

    `bodies` lists the rigid bodies of a file ('' where the format names none). `general`: a form
    that other formats have as well, so theirs are tried first; `folder`: a run is a folder.
    """

    name: str
    read: Callable[[Path, Mocap], Export]
    signatures: tuple[Signature, ...]
    bodies: Callable[[Path], Sequence[str]] = lambda path: [""]
    axes: FileAxes = FileAxes()
    general: bool = False
    folder: bool = False


@dataclass(frozen=True)
class CommandReader:
    """A format of commands, declared as `COMMAND_READER`; `auxiliary`: it has further columns."""

    name: str
    read: Callable[[Path, CommandLog], CommandExport]
    auxiliary: bool = False


R = TypeVar("R", MocapReader, CommandReader)


def mocap_readers() -> dict[str, MocapReader]:
    """Every format of motions that can be read, general ones last."""
    found = _declared("MOCAP_READER", MocapReader)
    return {one.name: one for one in sorted(found, key=lambda one: one.general)}


def command_readers() -> dict[str, CommandReader]:
    """Every format of commands that can be read."""
    return {one.name: one for one in _declared("COMMAND_READER", CommandReader)}


def reader_of(name: str, readers: dict[str, R], where: object) -> R:
    """Return the reader of the format `name`.

    Raises:
        BadInput: no reader of that name.
    """
    if name in readers:
        return readers[name]
    raise unlisted(name, sorted(readers), found=f"the format '{name}' is not known", where=where)


def _declared(name: str, kind: type[R]) -> list[R]:
    """What the modules of this package declare under a name."""
    import rovsim.measurement.recording as package

    modules = [f"{package.__name__}.{one.name}" for one in pkgutil.iter_modules(package.__path__)]
    found = [getattr(import_module(module), name, None) for module in modules]
    return [one for one in found if isinstance(one, kind)]
