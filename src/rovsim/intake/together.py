"""Put together files of one run that hold different sensors, by their names or their clocks."""

from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Iterator, Sequence

from rovsim.core.errors import BadInput
from rovsim.intake.names import sensor_key, without_sensor
from rovsim.intake.survey import Contents, Track
from rovsim.measurement.recording.joined import FULL_POSES, POSE_CHANNELS, join, list_held, span_of

JOINED_FORMAT = "csv"  # other formats hold all sensors of a run in one file
MIN_OVERLAP_SHARE = 0.5  # of the shorter file that lies beside another of its run


def put_together(motions: Sequence[Contents]) -> tuple[tuple[Contents, ...], tuple[str, ...]]:
    """Put files of one run together.

    Returns:
        One entry for each run, in the order of their first files, and sentences about files that
        may be of one run but could not be put together.
    """
    if len(motions) < 2 or any(contents.format != JOINED_FORMAT for contents in motions):
        return tuple(motions), ()
    runs, notes = _by_name(motions)
    if len(runs) == len(motions) and not notes:
        runs, notes = _by_clock(runs)
    order = {contents.named: k for k, contents in enumerate(motions)}
    position = {run.named: min(order[file.named] for file in run.files) for run in runs}
    return tuple(sorted(runs, key=lambda run: position[run.named])), tuple(notes)


def list_stems(motions: Sequence[Contents]) -> list[str]:
    """List what each run may be called: its file's stem, or what the names of its files share.

    The folder's name goes in front where several runs would be called the same.
    """
    stems = [_stem(contents) for contents in motions]
    return [
        f"{contents.named.absolute().parent.name} {stem}".strip() if stems.count(stem) > 1 else stem
        for contents, stem in zip(motions, stems, strict=True)
    ]


def _stem(one: Contents) -> str:
    path = one.named
    if not one.beside:
        return path.stem if path.is_file() else path.name
    return without_sensor(path.stem) or path.absolute().parent.name


def _by_name(motions: Sequence[Contents]) -> tuple[list[Contents], list[str]]:
    """Put together files of one folder whose names differ only in words for sensors and roles."""
    groups: dict[tuple[Path, str], list[Contents]] = defaultdict(list)
    for contents in motions:
        groups[contents.named.absolute().parent, sensor_key(contents.named.stem)].append(contents)
    runs, notes = [], []
    for group in groups.values():
        if len(group) == 1:
            runs += group
            continue
        try:
            runs.append(_joined(group, "their names differ in the sensor alone"))
        except BadInput as error:
            runs += group
            if _all_different(group):
                notes.append(f"{_names(group)} look like one run by their names, but {error.found}")
    return runs, notes


def _by_clock(motions: Sequence[Contents]) -> tuple[list[Contents], list[str]]:
    """Put together files of different sensors that ran at the same time, where that is clear."""
    kinds: dict[frozenset[str], list[Contents]] = defaultdict(list)
    for contents in motions:
        kinds[_held(contents)].append(contents)
    groups = list(kinds.values())
    if len(groups) < 2 or not _all_different([group[0] for group in groups]):
        return list(motions), []
    runs = [list(_at_that_time(contents, groups)) for contents in max(groups, key=len)]
    joined = [file for run in runs for file in run]
    if len({id(file) for file in joined}) < len(joined) or not all(
        _one_each(r, groups) for r in runs
    ):
        return list(motions), [
            f"{' and '.join(map(_listed, groups))}: neither names nor clocks tell which files are "
            "of one run. List those of one run in its mocap: [a.csv, b.csv]"
        ]
    rest = [contents for contents in motions if not any(contents is file for file in joined)]
    reason = "they hold different sensors and ran at the same time"
    return [*(_joined(r, reason) if len(r) > 1 else r[0] for r in runs), *rest], []


def _at_that_time(one: Contents, groups: Sequence[Sequence[Contents]]) -> Iterator[Contents]:
    """List a file, and the files of other sensors that ran at the same time."""
    yield one
    for group in groups:
        if not any(file is one for file in group):
            yield from (file for file in group if _beside(one, file))


def _beside(one: Contents, other: Contents) -> bool:
    """Whether two files overlap in time by more than `MIN_OVERLAP_SHARE` of the shorter one."""
    (a, b), (c, d) = (span_of(x.tracks[0].export) for x in (one, other))
    return min(b, d) - max(a, c) > MIN_OVERLAP_SHARE * min(b - a, d - c)


def _one_each(run: Sequence[Contents], groups: Sequence[Sequence[Contents]]) -> bool:
    """Whether a run has at most one file of each sensor."""
    return all(sum(any(f is g for g in group) for f in run) <= 1 for group in groups)


def _held(one: Contents) -> frozenset[str]:
    """Return the kinds of measurements in a file, with those that its poses imply."""
    kinds = list_held(one.tracks[0].export)
    return frozenset([*kinds, *(POSE_CHANNELS if FULL_POSES in kinds else ())])


def _all_different(files: Sequence[Contents]) -> bool:
    """Whether no two files hold the same kind of measurement."""
    kinds = [kind for contents in files for kind in _held(contents)]
    return len(kinds) == len(set(kinds))


def _joined(files: Sequence[Contents], reason: str) -> Contents:
    """Join files to one run; one that holds commands stands for it.

    Args:
        files: of the run.
        reason: why they are one run.

    Raises:
        BadInput: two of them hold the same, or have no time in common.
    """
    main, *rest = sorted(files, key=lambda contents: not contents.drives)
    export = join({contents.named: contents.tracks[0].export for contents in (main, *rest)})
    track = Track.of("", export, main.named)
    notes: tuple[str, ...] = (f"guess: {_names(files)} are one run: {reason}",)
    notes += tuple(note for contents in files for note in contents.notes)
    return replace(main, tracks=(track,), notes=notes, beside=tuple(rest))


def _listed(files: Sequence[Contents]) -> str:
    return f"{_names(files)} ({', '.join(list_held(files[0].tracks[0].export))})"


def _names(files: Sequence[Contents]) -> str:
    return ", ".join(contents.named.name for contents in files)
