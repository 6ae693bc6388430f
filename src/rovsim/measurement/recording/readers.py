"""The formats that can be read. A new one is a new module here that declares its reader."""

import pkgutil
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Callable, Mapping, Sequence, TypeVar

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, nearest, unlisted
from rovsim.core.rotations import BodyAxes, WorldAxes, normalized
from rovsim.core.run import CommandKind, Logged
from rovsim.measurement.campaign_file import CommandLog, Mocap
from rovsim.measurement.recording.channels import Channels
from rovsim.measurement.recording.signature import Signature

# A rotation matrix printed to six digits is orthonormal to about 1e-6; a cut or damaged line is
# not. The same bound holds for the length of quaternions.
ORTHONORMAL_WITHIN = UNIT_WITHIN = 0.1
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


@dataclass(frozen=True, eq=False)
class Export:
    """What was measured as a file tells it: its own axes, its own order of lines.

    `time` (n,) s; `position` (n, 3) m; `attitude` (n, 4) quaternion, body to world; `found` (n,)
    False where the body was not seen; `rate` nominal Hz, None when the file does not say; `nu`
    (n, 6) body velocities, None when not exported; `counts` of what was repaired while reading
    (`cut_lines`, `bad_rotations`); `channels` what else was measured; `notes` are sentences about
    the file that its owner should read.
    """

    time: Array
    position: Array
    attitude: Array
    found: Array
    rate: float | None = None
    nu: Array | None = None
    counts: dict[str, int] = field(default_factory=dict)
    channels: Channels = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @staticmethod
    def of_channels(
        channels: Channels, counts: dict[str, int] | None = None, notes: tuple[str, ...] = ()
    ) -> "Export":
        """What holds no full poses."""
        return Export(
            np.empty(0),
            np.empty((0, 3)),
            np.empty((0, 4)),
            np.empty(0, bool),
            counts=counts or {},
            channels=channels,
            notes=notes,
        )


@dataclass(frozen=True, eq=False)
class CommandExport:
    """Commands as a file tells them: `time` (m,) s, `value` (m, c), lines in file order.

    `counts` of what was repaired while reading (`cut_lines`, `dropped`, `clipped`); `notes` are
    sentences about the file that its owner should read. `auxiliary`: what else was logged, by name.
    """

    time: Array
    value: Array
    kind: CommandKind
    counts: dict[str, int] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    auxiliary: Mapping[str, Logged] = field(default_factory=dict)


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


def finite_rows(*arrays: Array) -> Array:
    """Rows (n,) in which every one of `arrays` (n, k) is finite."""
    return np.logical_and.reduce([np.isfinite(a).all(axis=1) for a in arrays])


def unit_quaternions(values: Array) -> tuple[Array, Array]:
    """Quaternions (n, 4) of unit length, and which of `values` (n, 4) are rotations at all.

    Far from unit length it is none: trackers write zeros where the body was not found.
    """
    found = finite_rows(values) & (np.abs(_length(values) - 1.0) < UNIT_WITHIN)
    return normalized(np.where(found[:, None], values, [1.0, 0.0, 0.0, 0.0])), found


def check_units(values: Array, place: Callable[[int], str]) -> tuple[str, ...]:
    """Sentences about quaternions (n, 4) that are none, as they have not length 1; zeros may be.

    `place` says where a row stands, for people.

    Raises:
        BadInput: most of those that are not zeros are none.
    """
    given = finite_rows(values) & values.any(axis=1)
    length = _length(values)
    off = np.flatnonzero(given & ~(np.abs(length - 1.0) < UNIT_WITHIN))
    if 2 * len(off) > given.sum():
        raise BadInput(
            f"a quaternion of length {length[off[0]]:.3g} ({len(off)} of {given.sum()} have not "
            "length 1)",
            where=place(int(off[0])),
            expected="quaternions of length 1, or zeros where the body was not found",
            remedy="Check which columns hold it, and that all four have the same scale; if they "
            "are a multiple of it, divide them by their length.",
        )
    if not len(off):
        return ()
    return (f"{len(off)} lines whose quaternion has not length 1 count as not found.",)


def _length(values: Array) -> Array:
    """Length (n,) of rows (n, k)."""
    with np.errstate(over="ignore"):
        return np.linalg.norm(values, axis=1)


def orthonormal(R: Array) -> Array:
    """Where the matrices (n, 3, 3) are rotations: orthonormal and right-handed."""
    with np.errstate(invalid="ignore", over="ignore"):
        deviation = np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)).max(axis=(1, 2))
        return (deviation < ORTHONORMAL_WITHIN) & (np.linalg.det(R) > 0.0)


def _declared(name: str, kind: type[R]) -> list[R]:
    """What the modules of this package declare under a name."""
    import rovsim.measurement.recording as package

    modules = [f"{package.__name__}.{one.name}" for one in pkgutil.iter_modules(package.__path__)]
    found = [getattr(import_module(module), name, None) for module in modules]
    return [one for one in found if isinstance(one, kind)]
