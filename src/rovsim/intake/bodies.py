"""Find which rigid body or topic is the vehicle, where a file holds several."""

from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np

from rovsim.core.errors import BadInput
from rovsim.core.robust import usual_range
from rovsim.evaluation.commanded_motion.cross_correlation import MIN_CORRELATION, MIN_LEAD_RATIO
from rovsim.intake.survey.contents import Contents, Track
from rovsim.measurement.quality.usability import REST_POSITION_SPREAD


@dataclass(frozen=True)
class FoundBody:
    """The rigid body or topic that is the vehicle.

    Attributes:
        name: of the body, empty where a person has to say it.
        reason: how it is known; empty where there was no choice.
        choices: bodies that it may be.
    """

    name: str
    reason: str
    choices: tuple[str, ...]


def find_body(motions: Sequence[Contents], score: Callable[[str], float]) -> FoundBody:
    """Find the body that is the vehicle in all files.

    Args:
        motions: files with motions.
        score: the mean correlation of the motion of a body and the commands, 0 where unknown.

    Raises:
        BadInput: no body is in all of them.
    """
    names = [track.body for track in motions[0].tracks]
    common = [n for n in names if all(any(t.body == n for t in m.tracks) for m in motions)]
    if not common:
        raise _nothing_common(motions)
    if len(common) == 1:
        return FoundBody(
            common[0], "" if len(names) == 1 else "the only one in all files", (common[0],)
        )
    scores = {name: score(name) for name in common}
    best, second = sorted(common, key=lambda name: -scores[name])[:2]
    if scores[best] >= MIN_CORRELATION and scores[best] > MIN_LEAD_RATIO * scores[second]:
        reason = f"of {', '.join(common)} the one that follows the commands ({scores[best]:.2f})"
        return FoundBody(best, reason, tuple(common))
    moving = [name for name in common if any(_moves(m, name) for m in motions)]
    if len(moving) == 1:
        return FoundBody(
            moving[0], f"guess: of {', '.join(common)} the only one that moves", tuple(common)
        )
    return FoundBody("", "", tuple(moving or common))


def track_of(contents: Contents, body: str) -> Track:
    """Return the motion of a body in a file, or the first motion if the file lacks that body."""
    return next((track for track in contents.tracks if track.body == body), contents.tracks[0])


def _moves(contents: Contents, body: str) -> bool:
    track = track_of(contents, body)
    if not track.posed:
        return True
    place = track.export.position[track.export.tracked]
    low, high = usual_range(place)
    return bool(np.max(high - low) > REST_POSITION_SPREAD)


def _nothing_common(motions: Sequence[Contents]) -> BadInput:
    listed = "; ".join(
        f"{m.named.name}: {', '.join(t.body for t in m.tracks)}" for m in motions[:5]
    )
    return BadInput(
        f"no body is in all files ({listed})",
        where="the files",
        expected="runs of one vehicle, its rigid body or topic called the same in each",
        remedy="Run init for each vehicle, with another out=.",
    )
