"""The formats that can be read. A new one is a new module of `formats` that declares its reader."""

import pkgutil
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Callable, Mapping, Sequence, TypeVar

from rovsim.core.errors import BadInput, nearest, unlisted
from rovsim.core.rotations import BodyAxes, WorldAxes
from rovsim.core.run import CommandKind
from rovsim.measurement.campaign_file import CommandLog, Mocap
from rovsim.measurement.recording.candidates import FoundCommands
from rovsim.measurement.recording.exports import CommandExport, Export
from rovsim.measurement.recording.signature import FileSignature

# What each kind of logged command drives.
COMMAND_KINDS: dict[str, CommandKind] = {
    "pwm": "thruster",
    "normalized": "thruster",
    "demand": "demand",
    "wrench": "wrench",
}


def choose_body(names: Sequence[str], wanted: str, where: Path | str) -> str:
    """Choose the rigid body of a file: the one that is wanted, or else the only one.

    Raises:
        BadInput: there is none of that name, or there are several and none was named.
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
    """The axes that files of a format may have.

    Attributes:
        world: possible axes of the world.
        body: possible axes of the body.
        usual: the axes to assume where the file does not tell; None for no assumption.
        reason: why the usual or the only possible axes are assumed.
    """

    world: tuple[WorldAxes, ...] = ("z_up", "ned")
    body: tuple[BodyAxes, ...] = ("flu", "frd")
    usual: tuple[WorldAxes, BodyAxes] | None = None
    reason: str = ""

    @property
    def every(self) -> tuple[str, ...]:
        """All possible axes: of the world, then of the body."""
        return (*self.world, *self.body)

    @property
    def fixed(self) -> bool:
        """Whether there is only one choice."""
        return len(self.world) == len(self.body) == 1


@dataclass(frozen=True)
class MocapReader:
    """A format of motions; its module declares one as `MOCAP_READER`.

    Attributes:
        name: of the format, as in `mocap.format`.
        what: such a file in words: "a QTM export".
        read: reads a file.
        signatures: how files of the format are recognised.
        bodies: lists the rigid bodies of a file ('' where the format names none).
        axes: the axes that its files may have.
        general: whether files of other formats look like this one, so that those are tried first.
        folder: whether a run may be a folder.
        start: tells from the first bytes of a file at which local time it began, as s since 1970;
            None where it is not given.
        options: keys of the section `mocap` that only this format has, with what they are.
    """

    name: str
    what: str
    read: Callable[[Path, Mocap], Export]
    signatures: tuple[FileSignature, ...]
    bodies: Callable[[Path], Sequence[str]] = lambda path: [""]
    axes: FileAxes = FileAxes()
    general: bool = False
    folder: bool = False
    start: Callable[[bytes], float | None] = lambda head: None
    options: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class CommandReader:
    """A format of commands; its module declares one as `COMMAND_READER`.

    Attributes:
        name: of the format, as in `commands.format`.
        read: reads a file.
        find: finds what may be commands in a file that nobody has described, for `rovsim init`. In
            csv files, whose columns may have any name, it searches by itself.
        what: such a file in words; empty where a `MOCAP_READER` of the same name says so.
        signatures: how files of the format are recognised; none where a `MOCAP_READER` of the same
            name says so.
        options: keys of the section `commands` that only this format has, with what they are.
    """

    name: str
    read: Callable[[Path, CommandLog], CommandExport]
    find: Callable[[Path], FoundCommands] = lambda path: FoundCommands()
    what: str = ""
    signatures: tuple[FileSignature, ...] = ()
    options: Mapping[str, str] = field(default_factory=dict)


R = TypeVar("R", MocapReader, CommandReader)


def mocap_readers() -> dict[str, MocapReader]:
    """Readers of every known format of motions by name, general ones last."""
    readers = _declared("MOCAP_READER", MocapReader)
    return {reader.name: reader for reader in sorted(readers, key=lambda reader: reader.general)}


def command_readers() -> dict[str, CommandReader]:
    """Readers of every known format of commands by name."""
    return {reader.name: reader for reader in _declared("COMMAND_READER", CommandReader)}


def reader_of(name: str, readers: dict[str, R], where: object) -> R:
    """Return the reader of the format `name`.

    Raises:
        BadInput: no reader of that name.
    """
    if name in readers:
        return readers[name]
    raise unlisted(name, sorted(readers), found=f"the format '{name}' is not known", where=where)


def _declared(name: str, kind: type[R]) -> list[R]:
    """Collect what the modules of `formats` declare under a name."""
    import rovsim.measurement.recording.formats as package

    modules = [f"{package.__name__}.{item.name}" for item in pkgutil.iter_modules(package.__path__)]
    declared = [getattr(import_module(module), name, None) for module in modules]
    return [item for item in declared if isinstance(item, kind)]
