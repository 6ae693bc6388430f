"""Find out what a file holds, with the reader of its format."""

from pathlib import Path
from types import MappingProxyType
from typing import Callable, Iterator, Mapping, Sequence

from rovsim.core.errors import BadInput
from rovsim.intake.survey.bags import look_into_bag
from rovsim.intake.survey.contents import Contents, Track
from rovsim.intake.survey.csv_files import look_into_csv
from rovsim.intake.survey.logs import look_into_log
from rovsim.intake.survey.sizes import Key, Unit
from rovsim.intake.survey.sniff import sniff
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.readers import MocapReader, mocap_readers
from rovsim.measurement.recording.tidying import tidy_export

# Formats whose files may hold commands, or sensors to choose from, and what finds these. For every
# other format its reader, which is found by itself, lists the bodies.
LOOKS_BY_FORMAT: dict[str, Callable[[Path, Path, Mapping[Key, Unit]], Contents]] = {
    "csv": look_into_csv,
    "rosbag2": lambda path, scratch, units: look_into_bag(path),
    "ardupilot": lambda path, scratch, units: look_into_log(path),
}


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
        if name in LOOKS_BY_FORMAT:
            return LOOKS_BY_FORMAT[name](path, scratch, units)
        return _of_bodies(path, mocap_readers()[name])
    except OSError as error:
        raise BadInput(
            f"cannot be read ({error.strerror})",
            where=path,
            expected="a file that may be read",
            remedy="Check its permissions.",
        ) from None


def _of_bodies(path: Path, reader: MocapReader) -> Contents:
    """Read all rigid bodies of a motion-capture export."""
    names = reader.bodies(path)
    tracks = tuple(_tracks(path, reader, names))
    if tracks:
        return Contents(path, reader.name, tracks)
    raise BadInput(
        f"none of the rigid bodies {', '.join(names)} was ever found",
        where=path,
        expected="at least one that was",
        remedy="Check the rigid bodies in the motion capture software, and export again.",
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
            yield Track(body, tidy_export(reader.read(path, mocap), path))
        except BadInput:
            if len(bodies) == 1:
                raise
