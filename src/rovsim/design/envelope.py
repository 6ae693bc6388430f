"""The limits that a flight keeps to, and how far it is from keeping to them."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import to_euler
from rovsim.core.signs import minus
from rovsim.design.recording_setup import RecordingSetup
from rovsim.design.settings import FlightLimits

LIMITED_MOTIONS = ("moves", "turns", "tilts")  # of which speed, turn rate and tilt are limits
PLACE_STDS = 3.0  # standard deviations of the place that must lie inside: 1 in 1000 beyond one wall


class Extremes(NamedTuple):
    """The largest `speed` m/s, `turn_rate` rad/s and `tilt` rad of a flight."""

    speed: float
    turn_rate: float
    tilt: float


@dataclass(frozen=True, eq=False)
class Envelope:
    """The limits that a flight has to keep.

    Attributes:
        box: least and largest place (3, 2) of CO, m NED; infinite where no wall is known.
        limits: of speed, turn rate and tilt.
        swum: least and largest place (3, 2) that the train runs reached, m NED; NaN along an axis
            that nobody measured.
    """

    box: Array
    limits: FlightLimits
    swum: Array

    @staticmethod
    def within(setup: RecordingSetup, limits: FlightLimits, floats: bool) -> "Envelope":
        """The limits within the tank of a recording.

        Args:
            setup: with walls, floor and surface as far as they are known.
            limits: the clearance to them, the depths that are wanted, and limits of the motion.
            floats: whether the vehicle floats. Its depth is then not limited.

        Raises:
            BadInput: the clearance and the depths leave no room.
        """
        tank = setup.site.tank
        box = tank + limits.clearance * np.array([1.0, -1.0])
        box[:, 0] = np.where(np.isfinite(box[:, 0]), box[:, 0], -np.inf)
        box[:, 1] = np.where(np.isfinite(box[:, 1]), box[:, 1], np.inf)
        surface = tank[2, 0] if np.isfinite(tank[2, 0]) else 0.0
        if limits.depth:
            low, high = surface + np.array(limits.depth)
            box[2] = max(box[2, 0], low), min(box[2, 1], high)
        if floats:
            box[2] = -np.inf, np.inf
        _require_room(box, tank, surface, limits)
        return Envelope(box, limits, setup.swum)

    @property
    def middle(self) -> Array:
        """The middle (3,) of the box, m NED; without walls, that of what the train runs reached."""
        walled = np.isfinite(self.box).all(axis=1)
        box = np.where(walled[:, None], self.box, np.nan_to_num(self.swum))
        return np.asarray(box.mean(axis=1))

    @property
    def longest(self) -> float:
        """Heading along the longer side of the tank, rad NED."""
        size = self.box[:2, 1] - self.box[:2, 0]
        return 0.5 * np.pi if size[1] > size[0] else 0.0

    def excess(self, paths: Array, each_alone: bool = False) -> float:
        """By how much paths leave the limits; 0 if none does.

        The sum of two things: how far the place leaves the box, in m, where `PLACE_STDS` standard
        deviations about the mean of the paths have to stay inside; and by which share the largest
        speed, turn rate and tilt exceed their limits.

        Args:
            paths: states (s, k, 13) of s paths.
            each_alone: take the places as they are. Paths under rivals are not draws of one
                uncertainty, so their standard deviation means nothing.
        """
        return float(sum(self._beyond(paths, each_alone)))

    def describe_excess(self, paths: Array) -> str:
        """How paths (s, k, 13) leave the limits, in words; empty if they do not."""
        distance, *ratios = self._beyond(paths, each_alone=False)
        if not np.isfinite(distance):
            return "moves beyond all numbers"
        phrases = [f"comes {distance:.2g} m too near to a wall, the floor or the surface"]
        phrases += [
            f"{v} {100.0 * s:.0f} % more than it may"
            for v, s in zip(LIMITED_MOTIONS, ratios, strict=True)
        ]
        return " and ".join(
            phrase
            for phrase, excess in zip(phrases, (distance, *ratios), strict=True)
            if excess > 0.0
        )

    def _beyond(self, paths: Array, each_alone: bool) -> tuple[float, ...]:
        """By how much paths (s, k, 13) leave each limit; 0 where they do not.

        The place in m, then speed, turn rate and tilt as shares of their limits.
        """
        if not np.isfinite(paths).all():
            return (np.inf,) * 4
        position = paths[:, :, :3]
        low, high = position.min(axis=(0, 1)), position.max(axis=(0, 1))
        if not each_alone:
            mean, spread = position.mean(axis=0), PLACE_STDS * position.std(axis=0, ddof=1)
            low, high = (mean - spread).min(axis=0), (mean + spread).max(axis=0)
        overshoot = np.maximum(self.box[:, 0] - low, 0.0) + np.maximum(high - self.box[:, 1], 0.0)
        ratios = [v / w - 1.0 for v, w in zip(find_extremes(paths), self._most, strict=True)]
        return (float(overshoot.sum()), *(max(r, 0.0) for r in ratios))

    @property
    def _most(self) -> Extremes:
        return Extremes(self.limits.speed, self.limits.turn_rate, self.limits.tilt)

    def holds(self, paths: Array) -> bool:
        """Whether all paths (s, k, 13) stay in the box and within the limits."""
        position = paths[:, :, :3]
        inside = ((position > self.box[:, 0]) & (position < self.box[:, 1])).all()
        return bool(inside and self.excess(paths) == 0.0)


def _require_room(box: Array, tank: Array, surface: float, limits: FlightLimits) -> None:
    if (box[:, 0] < box[:, 1]).all():
        return
    axis = int(np.argmax(box[:, 0] >= box[:, 1]))
    room = f"walls {tank[axis, 1] - tank[axis, 0]:.2f} m apart along {'xy'[axis % 2]}"
    if axis == 2:
        low, high = (minus(f"{depth:.2f}") for depth in tank[2] - surface)
        depth_limits = f", design.limits.depth={list(limits.depth)}" if limits.depth else ""
        room = f"floor and surface at {high} m and {low} m of depth{depth_limits}"
    raise BadInput(
        f"{room}, and a clearance of {limits.clearance:g} m: they leave no room",
        where="rovsim design",
        expected="some metres in which the vehicle's middle may move",
        remedy="Choose design.limits.depth and design.limits.clearance that fit into the tank.",
    )


def find_extremes(paths: Array) -> Extremes:
    """The largest speed, turn rate and tilt of paths (s, k, 13)."""
    speed = np.linalg.norm(paths[..., 7:10], axis=-1).max()
    rate = np.linalg.norm(paths[..., 10:13], axis=-1).max()
    tilt = np.abs(to_euler(paths[..., 3:7])[..., :2]).max()
    return Extremes(float(speed), float(rate), float(tilt))
