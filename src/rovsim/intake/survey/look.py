"""Find out what a file holds, with the reader of its format."""

from pathlib import Path
from types import MappingProxyType
from typing import Iterator, Mapping, Sequence

from rovsim.core.errors import BadInput
from rovsim.intake.survey.bags import look_into_bag
from rovsim.intake.survey.contents import Contents, Track
from rovsim.intake.survey.csv_files import look_into_csv
from rovsim.intake.survey.sizes import Key, Unit
from rovsim.intake.survey.sniff import sniff
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.candidates import FoundCommands
from rovsim.measurement.recording.readers import MocapReader, command_readers, mocap_readers


def look(path: Path, scratch: Path, units: Mapping[Key, Unit] = MappingProxyType({})) -> Contents:
    """Find out what a file or bag holds.

    Args:
        path: of the file or the bag's folder.
        scratch: folder for a copy, where a file can only be read under other column names.
        units: that other files tell for columns of the same names.

    Raises:
        BadInput: it is neither a recording nor a log of commands.
    """
    try:
        name = sniff(path)
        if name == "csv":  # its columns may have any name and unit
            return look_into_csv(path, scratch, units)
        logs = command_readers()
        commands = logs[name].find(path) if name in logs else FoundCommands()
        if name == "rosbag2":  # its sensors are topics to choose from
            return look_into_bag(path, commands)
        return _by_readers(path, name, commands)
    except OSError as error:
        raise BadInput(
            f"cannot be read ({error.strerror})",
            where=path,
            expected="a file that may be read",
            remedy="Check its permissions.",
        ) from None


def _by_readers(path: Path, name: str, commands: FoundCommands) -> Contents:
    """Read what the readers of a format find in a file: all rigid bodies, and commands.

    Args:
        path: of the file.
        name: of its format.
        commands: that were found in it.

    Raises:
        BadInput: no body was ever found, or the format is one of commands and there are none.
    """
    reader = mocap_readers().get(name)
    bodies = reader.bodies(path) if reader else ()
    tracks = tuple(_tracks(path, reader, bodies)) if reader else ()
    if reader and not tracks:
        raise BadInput(
            f"none of the rigid bodies {', '.join(bodies)} was ever found",
            where=path,
            expected="at least one that was",
            remedy="Check the rigid bodies in the motion capture software, and export again.",
        )
    if not tracks and not commands.candidates:
        raise BadInput(
            "nothing like commands",
            where=path,
            expected="commands that changed while the vehicle moved",
            remedy=" ".join([*commands.notes, commands.unknown]).strip() or "Leave the file out.",
        )
    return Contents(
        path, name, tracks, commands.candidates, notes=commands.notes, unknown=commands.unknown
    )


def _tracks(path: Path, reader: MocapReader, bodies: Sequence[str]) -> Iterator[Track]:
    """Read the bodies that were found in at least two frames.

    Raises:
        BadInput: the only body of the file cannot be read.
    """
    world_axes, body_axes = reader.axes.world[0], reader.axes.body[0]
    for body in bodies:
        # signs, and the axes y_up and fur of Motive, are applied later: these are the file's own
        mocap = Mocap(format=reader.name, body=body, world_axes=world_axes, body_axes=body_axes)
        try:
            yield Track.of(body, reader.read(path, mocap), path)
        except BadInput:
            if len(bodies) == 1:
                raise
