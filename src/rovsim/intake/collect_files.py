"""Look into all files that a user named: what each holds, or why it cannot be used."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Sequence

from rovsim.core.errors import BadInput, RovsimError
from rovsim.core.progress import counted
from rovsim.intake.one_unit import list_others
from rovsim.intake.survey import Contents, gather, look
from rovsim.intake.survey.csv_files import UnknownColumns
from rovsim.intake.survey.sizes import Key, Unit, UnknownUnit
from rovsim.intake.together import put_together
from rovsim.measurement.recording.one_run import SeveralRuns

ASKED_ERRORS = (UnknownUnit, SeveralRuns)  # that stop init for a file of a folder, too

MAX_LISTED = 5  # files and reasons in one message


@dataclass(frozen=True, eq=False)
class CollectedFiles:
    """What was found in the files.

    Attributes:
        motions: one for each run, which may have been put together from several files.
        logs: files that hold commands alone.
        left_out: for each file of a named folder that is not used, a sentence on why.
        apart: sentences about files that may be of one run but were not put together.
        unknown: for each file with columns of numbers that rovsim does not know, a sentence.
    """

    motions: tuple[Contents, ...]
    logs: tuple[Contents, ...]
    left_out: tuple[str, ...] = ()
    apart: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()


def collect_files(paths: Sequence[Path], scratch: Path) -> CollectedFiles:
    """Look into files, bags and folders.

    Args:
        paths: that the user named.
        scratch: folder for copies of files that rovsim can only read under other column names.

    Raises:
        RovsimError: a message for each file that was named and cannot be used.
        BadInput: no motion in any, or motions of several formats.
    """
    recordings, inside = gather(paths)
    by_path, refused = _look_into_all([*recordings, *inside], scratch)
    ambiguous = [path for path in inside if isinstance(refused.get(path), ASKED_ERRORS)]
    errors = [str(refused[path]) for path in (*recordings, *ambiguous) if path in refused]
    if errors:
        raise RovsimError("\n".join(errors))
    contents = list(by_path.values())
    left_out = tuple(
        f"{path.name}{_place(refused[path])} is left out: {refused[path].found}. "
        f"{refused[path].remedy}".rstrip()
        for path in inside
        if path in refused
    )
    motions = tuple(c for c in contents if c.tracks)
    logs = tuple(c for c in contents if not c.tracks)
    _check(motions, logs, list(refused.values()), paths)
    runs, apart = put_together(motions)
    unknown = [f"{c.named.name}: {c.unknown}" for c in contents if c.unknown]
    unknown += [
        f"{path}: {refused[path].found}"
        for path in inside
        if isinstance(refused.get(path), UnknownColumns)
    ]
    return CollectedFiles(runs, logs, left_out, apart, tuple(unknown))


def _place(error: BadInput) -> str:
    """Return the line and column of an error, in brackets; empty where it has none."""
    place = error.where.partition(", ")[2]
    return f" ({place})" if place else ""


def _look_into_all(
    paths: Sequence[Path], scratch: Path
) -> tuple[dict[Path, Contents], dict[Path, BadInput]]:
    """Look into each file; again where other files tell the unit of its columns.

    Returns:
        What each file holds, in the order of `paths`, and the errors of the others.
    """
    contents: dict[Path, Contents] = {}
    refused: dict[Path, BadInput] = {}

    def look_into(path: Path, units: Mapping[Key, Unit]) -> None:
        place = scratch / str(paths.index(path))
        place.mkdir(parents=True, exist_ok=True)
        try:
            contents[path] = look(path, place, units)
            refused.pop(path, None)
        except BadInput as error:
            refused[path] = error
            contents.pop(path, None)

    for path in counted(paths, "looking into the files"):
        look_into(path, {})
    for path, units in list_others(contents, refused).items():
        look_into(path, units)
    return {path: contents[path] for path in paths if path in contents}, refused


def _check(
    motions: Sequence[Contents],
    logs: Sequence[Contents],
    refused: list[BadInput],
    paths: Sequence[Path],
) -> None:
    where = paths[0] if len(paths) == 1 else "the files"
    if not motions:
        raise _no_motion(logs, refused, where)
    formats: dict[str, list[str]] = {}
    for motion in motions:
        formats.setdefault(motion.format, []).append(motion.named.name)
    if len(formats) > 1:
        descriptions = (
            f"{name}: {', '.join(files[:MAX_LISTED])}" for name, files in formats.items()
        )
        listed = "; ".join(descriptions)
        raise BadInput(
            f"motions of {len(formats)} formats ({listed})",
            where=where,
            expected="one format of motions in a campaign",
            remedy="Run init for each of them, with another out=.",
        )


def _no_motion(logs: Sequence[Contents], refused: Sequence[BadInput], where: object) -> BadInput:
    """Make the error of files without a motion: why each was refused, and what may help."""
    content = "no recording"
    if logs:
        content = f"commands alone ({', '.join(c.named.name for c in logs[:MAX_LISTED])})"
    groups: dict[tuple[str, str], list[str]] = {}
    for error in refused:
        name = Path(error.where.partition(", ")[0]).name
        groups.setdefault((error.found, error.remedy), []).append(f"{name}{_place(error)}")
    reasons = [
        f"{', '.join(names[:MAX_LISTED])}: {problem}"
        for (problem, _), names in [*groups.items()][:MAX_LISTED]
    ]
    remedies = [remedy for _, remedy in groups if remedy]
    remedies += [note for log in logs for note in log.notes]
    if not remedies:
        remedies = ["Name the export of the motion capture, the bag or the log as well."]
    return BadInput(
        content + (f" ({'; '.join(reasons)})" if reasons else ""),
        where=where,
        expected="at least one file that tells how the vehicle moved",
        remedy=" ".join([*dict.fromkeys(remedies)][:MAX_LISTED]),
    )
