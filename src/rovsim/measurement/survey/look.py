"""What a file holds, by the reader of its format."""

from pathlib import Path
from typing import Callable, Iterator

from rovsim.core.errors import BadInput
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording import c3d, motive_csv, qtm_tsv
from rovsim.measurement.recording.readers import mocap_readers
from rovsim.measurement.recording.tidying import tidy_export
from rovsim.measurement.survey.bags import look_into_bag
from rovsim.measurement.survey.contents import Contents, Track
from rovsim.measurement.survey.csv_files import look_into_csv
from rovsim.measurement.survey.logs import look_into_log
from rovsim.measurement.survey.sniff import sniff

BODIES: dict[str, Callable[[Path], list[str]]] = {
    "qtm_tsv": qtm_tsv.body_names,
    "motive_csv": motive_csv.body_names,
    "c3d": c3d.body_names,
}
OTHERS: dict[str, Callable[[Path, Path], Contents]] = {
    "csv": look_into_csv,
    "rosbag2": lambda path, scratch: look_into_bag(path),
    "ardupilot": lambda path, scratch: look_into_log(path),
}


def look(path: Path, scratch: Path) -> Contents:
    """What a file or bag holds; a copy that only rovsim can read is put into `scratch`.

    Raises:
        BadInput: it is no recording, and neither a log of commands.
    """
    try:
        name = sniff(path)
        return OTHERS[name](path, scratch) if name in OTHERS else _of_bodies(path, name)
    except OSError as error:
        raise BadInput(
            f"cannot be read ({error.strerror})",
            where=path,
            expected="a file that may be read",
            remedy="Check its permissions.",
        ) from None


def _of_bodies(path: Path, name: str) -> Contents:
    names = BODIES[name](path)
    tracks = tuple(_tracks(path, name, names))
    if tracks:
        return Contents(path, name, tracks)
    raise BadInput(
        f"none of the rigid bodies {', '.join(names)} was ever found",
        where=path,
        expected="at least one that was",
        remedy="Check the rigid bodies in the motion capture software, and export again.",
    )


def _tracks(path: Path, name: str, bodies: list[str]) -> Iterator[Track]:
    """The bodies that were found in at least two frames; one that is alone may say why not."""
    read = mocap_readers()[name]
    for body in bodies:
        # signs, and the axes y_up and fur of Motive, are applied later: these are the file's own
        mocap = Mocap(format=name, body=body, world_axes="z_up", body_axes="flu")
        try:
            yield Track(body, tidy_export(read(path, mocap), path)[0])
        except BadInput:
            if len(bodies) == 1:
                raise
