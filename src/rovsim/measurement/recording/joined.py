"""Join several files of one run, which hold different sensors on one clock, into one export."""

from dataclasses import replace
from pathlib import Path
from typing import Mapping

import numpy as np

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.repairs import MotionRepairs

FULL_POSES = "full poses"
POSE_CHANNELS = ("position", "attitude", "euler")  # channels that full poses contain as well


def list_held(export: Export) -> list[str]:
    """List what a file holds: full poses, and the kinds of channels with any sample."""
    channels = [kind for kind, channel in export.channels.items() if len(channel.time)]
    return [*([FULL_POSES] if len(export.time) and export.tracked.any() else []), *channels]


def join(exports: Mapping[Path, Export]) -> Export:
    """Make one export of all files: the poses of the one that has them, the channels of each.

    Beside full poses the position and attitude of other files are not used, and a note says so.

    Raises:
        BadInput: two of the files hold the same quantity, or have no time in common.
    """
    if len(exports) == 1:
        return next(iter(exports.values()))
    _check_clocks(exports)
    exports, left_out = _beside_poses(exports)
    _check_different(exports)
    posed = [export for export in exports.values() if FULL_POSES in list_held(export)]
    basis = (posed or list(exports.values()))[0]
    repairs = sum((export.repairs for export in exports.values()), MotionRepairs())
    channels = {
        kind: c for export in exports.values() for kind, c in export.channels.items() if len(c.time)
    }
    notes = dict.fromkeys(note for export in exports.values() for note in export.notes)
    return replace(basis, repairs=repairs, channels=channels, notes=(*notes, *left_out))


def _beside_poses(exports: Mapping[Path, Export]) -> tuple[Mapping[Path, Export], list[str]]:
    """Drop channels that the full poses of another file contain; with sentences about them."""
    posed = [path for path, export in exports.items() if FULL_POSES in list_held(export)]
    if len(posed) != 1:
        return exports, []
    remaining, notes = dict(exports), []
    for path, export in exports.items():
        repeated = [
            kind for kind in list_held(export) if kind in POSE_CHANNELS and path != posed[0]
        ]
        if repeated:
            channels = {kind: c for kind, c in export.channels.items() if kind not in POSE_CHANNELS}
            remaining[path] = replace(export, channels=channels)
            notes.append(
                f"The {' and '.join(repeated)} in {path.name} is not used: {posed[0].name} holds "
                "full poses."
            )
    return remaining, notes


def _check_different(exports: Mapping[Path, Export]) -> None:
    path_by_kind: dict[str, Path] = {}
    for path, export in exports.items():
        for kind in list_held(export):
            if kind in path_by_kind:
                raise BadInput(
                    f"'{kind}' is in {path_by_kind[kind].name} and in {path.name}",
                    where=path,
                    expected="files of one run that hold different sensors",
                    remedy="Take one of them out of 'mocap' of that run, or make two runs of them.",
                )
            path_by_kind[kind] = path


def _check_clocks(exports: Mapping[Path, Export]) -> None:
    spans = {path: span_of(export) for path, export in exports.items()}
    latest = max(spans, key=lambda path: spans[path][0])
    earliest = min(spans, key=lambda path: spans[path][1])
    if spans[latest][0] < spans[earliest][1]:
        return
    begin, end = spans[latest]
    other_span = spans[earliest]
    raise BadInput(
        f"runs from {begin:.10g} to {end:.10g} s, {earliest.name} from {other_span[0]:.10g} to "
        f"{other_span[1]:.10g} s",
        where=latest,
        expected="files of one run on one clock",
        remedy="Shift the times of one of them, or make two runs of them.",
    )


def span_of(export: Export) -> tuple[float, float]:
    """First and last time of any measurement, s."""
    times = [export.time, *(channel.time for channel in export.channels.values())]
    instants = np.concatenate([time for time in times if len(time)] or [np.zeros(1)])
    return float(instants.min()), float(instants.max())
