"""Find out whether attitudes and positions of a file follow another convention than assumed.

Poses can be read in other ways: as inverse rotations, with angles of another sign or order, or with
positions along swapped axes. Each reading gives another body velocity. The commands are correlated
best with that of the right reading.
"""

from dataclasses import dataclass, replace
from itertools import product
from typing import Iterator, NamedTuple, Sequence

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core.rotations import conjugate, continuous, to_euler
from rovsim.core.signs import minus
from rovsim.evaluation.commanded_motion.clocks import MAX_USUAL_LAG_S, MIN_USUAL_LAG_S
from rovsim.evaluation.commanded_motion.cross_correlation import (
    MIN_CORRELATION,
    Commanded,
    orientations,
)
from rovsim.measurement.rough_motion import ResampledPoses, of_poses

# Correlations by which another reading must be better: over all axes, and over the linear ones
# alone. In the 52 right runs of the practice campaigns, no reading is better by 0.03 over these.
MIN_GAIN, MIN_LINEAR_GAIN = 0.12, 0.05
# likewise: readings that differ by less are both reported
TIE_MARGIN, LINEAR_TIE_MARGIN = 0.1, 0.02
EULER_ANGLES = ("roll", "pitch", "yaw")
EULER_RULE = "Rz(yaw) Ry(pitch) Rx(roll)"
# intrinsic rotations, each about the rotated axis
EULER_ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY")
IDENTITY_AXES = tuple(map(tuple, np.eye(3).tolist()))
EAST_NORTH_UP = ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))  # of north, east, down
LINEAR_AXES = np.arange(6) < 3


@dataclass(frozen=True)
class OtherReading:
    """Another reading of poses, in which the motion follows its commands better.

    Attributes:
        score: mean correlation with this reading.
        own: mean correlation as the poses were read.
        description: what is read otherwise, for a sentence.
        remedy: what to do about the file, in sentences.
    """

    score: float
    own: float
    description: str
    remedy: str

    def __str__(self) -> str:
        return (
            "positions and attitudes do not go together: the motion follows its commands better "
            f"with {self.description} (correlation {self.score:.2f} against "
            f"{minus(f'{self.own:.2f}')}). "
            f"{self.remedy}"
        )


class _Reading(NamedTuple):
    """Poses in another reading.

    Attributes:
        attitude: quaternions (n, 4), body to world.
        position: (n, 3), m.
        description: what is read otherwise, for a sentence.
        remedy: what to do about the file, in sentences.
    """

    attitude: Array
    position: Array
    description: str = ""
    remedy: str = ""


class _MeanCorrelation(NamedTuple):
    """Mean correlation of a motion with its commands.

    Attributes:
        whole: over all excited axes.
        linear: over surge, sway and heave, where excited.
    """

    whole: float
    linear: float


def find_convention(
    poses: ResampledPoses,
    caused: tuple[Array, Array],
    axes: Sequence[Array],
    lag: float = 0.0,
    angles: bool = True,
) -> OtherReading | None:
    """Find another reading of poses in which the motion follows its commands clearly better.

    Args:
        poses: as they were read.
        caused: times (m,) in s, and the body velocities (m, 6) FRD that the commands should cause.
        axes: the body axes (3, 3) that are possible, see `CrossCorrelation.along`.
        lag: by which the motion comes after its commands, s.
        angles: whether the z axis of the file is vertical, so that roll, pitch and yaw are angles
            of the vehicle.

    Returns:
        The best reading; None where none is clearly better.
    """
    shift = 0.0 if MIN_USUAL_LAG_S <= lag <= MAX_USUAL_LAG_S else lag
    commanded = Commanded(poses.time, *caused, shift, MAX_USUAL_LAG_S)

    def correlate(reading: _Reading) -> _MeanCorrelation:
        motion = of_poses(ResampledPoses(poses.time, reading.position, reading.attitude))
        correlation = commanded.correlate(motion)
        score, k_best = max(((correlation.best(a)[0], k) for k, a in enumerate(axes)))
        linear = replace(correlation, excited=correlation.excited & LINEAR_AXES)
        return _MeanCorrelation(score, linear.best(axes[k_best])[0])

    unchanged = correlate(_Reading(poses.attitude, poses.position))
    if unchanged.whole > 1.0 - MIN_GAIN:
        return None
    return _choose_reading(unchanged, [(correlate(r), r) for r in _list_readings(poses, angles)])


def _choose_reading(
    own: _MeanCorrelation, scored: list[tuple[_MeanCorrelation, _Reading]]
) -> OtherReading | None:
    """Describe the readings that are clearly better and about as good as the best of them.

    Args:
        own: correlation of the poses as they were read.
        scored: other readings and their correlation, the simplest first.

    Returns:
        At most two readings in one, the simplest ones; None where none is clearly better.
    """
    threshold = max(own.whole + MIN_GAIN, MIN_CORRELATION)
    candidates = [
        (correlation, reading)
        for correlation, reading in scored
        if correlation.whole >= threshold and correlation.linear >= own.linear + MIN_LINEAR_GAIN
    ]
    if not candidates:
        return None
    highest = max(correlation for correlation, _ in candidates)
    best_readings = [
        reading
        for correlation, reading in candidates
        if correlation.whole >= highest.whole - TIE_MARGIN
        and correlation.linear >= highest.linear - LINEAR_TIE_MARGIN
    ][:2]
    wording = ", or with ".join(reading.description for reading in best_readings)
    remedy = " Or: ".join(dict.fromkeys(reading.remedy for reading in best_readings))
    return OtherReading(highest.whole, own.whole, wording, remedy)


def _list_readings(poses: ResampledPoses, angles: bool) -> Iterator[_Reading]:
    """Yield other readings of poses, simple ones first."""
    yield _Reading(
        conjugate(poses.attitude),
        poses.position,
        "the inverse of the attitudes",
        "If they turn the world into the body, turn the signs of qx, qy and qz.",
    )
    yield _of_positions(poses, EAST_NORTH_UP)
    if angles:
        yield from _of_angles(poses)
    for axes in orientations():
        if axes not in (IDENTITY_AXES, EAST_NORTH_UP):
            yield _of_positions(poses, axes)


def _of_positions(poses: ResampledPoses, axes: tuple[tuple[float, ...], ...]) -> _Reading:
    """Read positions along swapped or mirrored axes: the rows of the matrix `axes` (3, 3)."""
    order = ", ".join(
        minus(f"{'-' if row[k := int(np.argmax(np.abs(row)))] < 0 else ''}{'xyz'[k]}")
        for row in axes
    )
    hint = " (north, east, down for east, north, up, or back)" if axes == EAST_NORTH_UP else ""
    return _Reading(
        poses.attitude,
        poses.position @ np.array(axes).T,
        f"{order} in place of x, y, z of the positions{hint}",
        "Check how the axes of the positions were exported: some are swapped or mirrored.",
    )


def _of_angles(poses: ResampledPoses) -> Iterator[_Reading]:
    """Yield readings with angles of other signs, quarter turns added, then of other orders."""
    angles = to_euler(poses.attitude)
    signs = [(np.array(s), turns) for s in product((1.0, -1.0), repeat=3) for turns in range(4)]
    for sign, turns in sorted(signs, key=lambda pair: (pair[1] > 0, -pair[0].sum())):
        if np.any(sign < 0.0):
            changed = angles * sign + [0.0, 0.0, 0.5 * np.pi * turns]
            yield _Reading(_composed("ZYX", changed), poses.position, *_of_signs(sign, turns))
    for order in EULER_ORDERS:
        rule = " ".join(f"R{axis.lower()}({EULER_ANGLES['XYZ'.index(axis)]})" for axis in order)
        yield _Reading(
            _composed(order, angles),
            poses.position,
            f"angles of the order R = {rule}",
            f"Angles are read as R = {EULER_RULE}: export such, or quaternions.",
        )


def _of_signs(sign: Array, turns: int) -> tuple[str, str]:
    """Describe a reading with angles of other signs: what is read otherwise, and what to do.

    Args:
        sign: of roll, pitch and yaw (3,), 1 or -1.
        turns: quarter turns that are added to yaw.
    """
    negated = [name for name, s in zip(EULER_ANGLES, sign, strict=True) if s < 0.0]
    names = " and ".join(filter(None, [", ".join(negated[:-1]), negated[-1]]))
    change = f"the sign{'s' * (len(negated) > 1)} of {names} turned"
    remedy = f"Turn {'these signs' if len(negated) > 1 else 'that sign'} in the columns of angles"
    if turns:
        from_zero = {1: "90°", 2: "180°", 3: "−90°"}[turns]
        change += f", and {from_zero} added to yaw"
        remedy += f", and add {from_zero} to yaw, as a compass counts from north"
    if negated == ["pitch", "yaw"]:
        remedy += " (attitudes of axes with z down beside positions with z up, or the reverse)"
    return change, f"{remedy}: roll, pitch and yaw are right-handed about x, y and z."


def _composed(order: str, angles: Array) -> Array:
    """Quaternions (n, 4) of roll, pitch and yaw (n, 3), rad, rotated in another order."""
    finite = np.isfinite(angles).all(axis=1)
    quaternions = np.full((len(angles), 4), np.nan)
    ordered = angles[finite][:, ["XYZ".index(axis) for axis in order]]
    rotations = scipy.spatial.transform.Rotation.from_euler(order, ordered)
    quaternions[finite] = continuous(rotations.as_quat(scalar_first=True))
    return quaternions
