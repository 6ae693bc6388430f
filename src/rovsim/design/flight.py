"""Commands to predicted paths over all that is not yet known, and the limits they keep to."""

from dataclasses import dataclass
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core import gauss_markov
from rovsim.core.errors import BadInput
from rovsim.core.rotations import exp, multiply, to_euler
from rovsim.core.signs import minus
from rovsim.design.knowledge import Knowledge
from rovsim.design.settings import FlightLimits
from rovsim.design.surroundings import Surroundings
from rovsim.dynamics.model import Model
from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.drive import Drives
from rovsim.simulation.synthetic_tank.sent_log import PLACED, TURNED

MOVES = ("moves", "turns", "tilts")  # of which speed, turn rate and tilt are limits
SURE = 3.0  # standard deviations of the place that must lie inside: 1 in 1000 beyond one wall


@dataclass(frozen=True, eq=False)
class Chances:
    """What could happen: models, pushes (s, k, 6) m/s2 that nobody foresees, starting errors.

    The first are the likeliest models, which nothing pushes but what lasts. `shift` (s, 3) m,
    `turn` (s,) rad.
    """

    models: Sequence[Model]
    pushes: Array
    shift: Array
    turn: Array
    around: Surroundings

    def split(self, count: int) -> tuple["Chances", "Chances"]:
        """The first ones, and all others."""
        parts = (slice(0, count), slice(count, None))
        first, rest = (
            Chances(self.models[p], self.pushes[p], self.shift[p], self.turn[p], self.around)
            for p in parts
        )
        return first, rest

    def predict(self, drives: Drives, start: Array) -> Array:
        """Paths (s, k+1, 13) under one log, from near a state (13,)."""
        models, edges = self.models, self.around.edges
        each = zip(drives.of(models), self._wrenches, strict=True)
        pushed = [drive.pushed(push) for drive, push in each]
        states = np.tile(start, (len(models), 1, 1))
        afloat = models[0].vehicle.floats
        states[:, 0, :3] += self.shift * np.where(np.arange(3) == 2, not afloat, 1)
        states[:, 0, 3:7] = multiply(self._turns, states[:, 0, 3:7])
        steps = np.array([len(edges) - 1])
        starts = Starts(states, np.zeros(1, np.int64), steps, np.zeros((len(models), 1, 6)))
        return np.array([own[0] for own in self._batch.trajectories(pushed, starts, edges)])

    @cached_property
    def _batch(self) -> Batch:
        around = self.around
        return Batch(self.models, around.site, candidates=around.wrenches, learned=False)

    @cached_property
    def _wrenches(self) -> list[Array]:
        """Pushes of each model as wrenches (k, 6) N, N m."""
        return [push @ model.M.T for push, model in zip(self.pushes, self.models, strict=True)]

    @cached_property
    def _turns(self) -> Array:
        return exp(self.turn[:, None] * np.array([0.0, 0.0, 1.0]))


def draw_chances(
    each: Sequence[Sequence[Model]], known: Knowledge, around: Surroundings,
    random: np.random.Generator,
) -> Chances:  # fmt: skip
    """Disturbances as the recordings show them, of models that could be true.

    Args:
        each: models of each rival, the likeliest first.
        known: of the train runs: the noise, and what pushes for long.
        around: the steps of a path.
        random: generator.
    """
    chances = [_draw_of(own, known, k, around, random) for k, own in enumerate(each)]
    parts = [one.split(1) for one in chances]
    ordered = [first for first, _ in parts] + [rest for _, rest in parts]
    pushes, shift, turn = (
        np.concatenate([getattr(one, name) for one in ordered])
        for name in ("pushes", "shift", "turn")
    )
    models = [model for one in ordered for model in one.models]
    return Chances(models, pushes, shift, turn, around)


def _draw_of(
    models: Sequence[Model], known: Knowledge, rival: int, around: Surroundings,
    random: np.random.Generator,
) -> Chances:  # fmt: skip
    """Of the models of one rival: what passes by, and what lasts and it does not know of."""
    count, steps, h = len(models), len(around.edges) - 1, around.step
    noise, lasting = known.noise, known.steady[rival]
    level = noise.level * models[0].body.free
    memory = float(np.median(noise.memory))
    pushes = np.array(
        [
            level * gauss_markov.draw(steps, h / memory, random) + lasting.draw(steps, h, random)
            for _ in models
        ]
    )
    shift, turn = PLACED * random.normal(size=(count, 3)), TURNED * random.normal(size=count)
    pushes[0], shift[0], turn[0] = lasting.mean, 0.0, 0.0
    return Chances(models, pushes, shift, turn, around)


@dataclass(frozen=True, eq=False)
class Envelope:
    """Limits of a flight: `box` (3, 2) m NED in which CO stays, infinite where nothing is known.

    `swum` (3, 2) m NED is where it was recorded, NaN along an axis that nobody measured.
    """

    box: Array
    limits: FlightLimits
    swum: Array

    @staticmethod
    def around(surroundings: Surroundings, limits: FlightLimits, floats: bool) -> "Envelope":
        """Walls, floor and surface less the clearance, and of these the depths that are wanted.

        Raises:
            BadInput: they leave no room.
        """
        tank = surroundings.site.tank
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
        return Envelope(box, limits, surroundings.swum)

    @property
    def middle(self) -> Array:
        """The place (3,) farthest from all walls; along an axis without, of where it swam."""
        known = np.isfinite(self.box).all(axis=1)
        inside = np.where(known[:, None], self.box, np.nan_to_num(self.swum))
        return np.asarray(inside.mean(axis=1))

    @property
    def longest(self) -> float:
        """Heading in rad of the longer side of the tank."""
        size = self.box[:2, 1] - self.box[:2, 0]
        return 0.5 * np.pi if size[1] > size[0] else 0.0

    def excess(self, paths: Array, still: bool = False) -> float:
        """By how much paths (s, k, 13) leave the limits: 0 if none does.

        Of the place by `SURE` standard deviations about the mean of the paths, in m; of speed,
        turn rate and tilt by the largest, as a share of the limit. `still`: the paths are those of
        rivals, and each counts alone.
        """
        return float(sum(self._beyond(paths, still)))

    def tell(self, paths: Array) -> str:
        """How paths (s, k, 13) leave the limits, in words; nothing if they do not."""
        place, *shares = self._beyond(paths, still=False)
        if not np.isfinite(place):
            return "moves beyond all numbers"
        told = [f"comes {place:.2g} m too near to a wall, the floor or the surface"]
        told += [
            f"{v} {100.0 * s:.0f} % more than it may" for v, s in zip(MOVES, shares, strict=True)
        ]
        return " and ".join(one for one, by in zip(told, (place, *shares), strict=True) if by > 0.0)

    def _beyond(self, paths: Array, still: bool) -> tuple[float, ...]:
        """By how much the place leaves the box, m, and speed, turn rate and tilt their limits."""
        if not np.isfinite(paths).all():
            return (np.inf,) * 4
        place = paths[:, :, :3]
        low, high = place.min(axis=(0, 1)), place.max(axis=(0, 1))
        if not still:
            mean, spread = place.mean(axis=0), SURE * place.std(axis=0, ddof=1)
            low, high = (mean - spread).min(axis=0), (mean + spread).max(axis=0)
        beyond = np.maximum(self.box[:, 0] - low, 0.0) + np.maximum(high - self.box[:, 1], 0.0)
        ratios = [v / w - 1.0 for v, w in zip(reached(paths), self._most, strict=True)]
        return (float(beyond.sum()), *(max(r, 0.0) for r in ratios))

    @property
    def _most(self) -> tuple[float, float, float]:
        return self.limits.speed, self.limits.turn_rate, self.limits.tilt

    def holds(self, paths: Array) -> bool:
        """Whether each of these paths (s, k, 13) stays in the box, and within the limits."""
        place = paths[:, :, :3]
        inside = ((place > self.box[:, 0]) & (place < self.box[:, 1])).all()
        return bool(inside and self.excess(paths) == 0.0)


def _require_room(box: Array, tank: Array, surface: float, limits: FlightLimits) -> None:
    if (box[:, 0] < box[:, 1]).all():
        return
    axis = int(np.argmax(box[:, 0] >= box[:, 1]))
    found = f"walls {tank[axis, 1] - tank[axis, 0]:.2f} m apart along {'xy'[axis % 2]}"
    if axis == 2:
        low, high = (minus(f"{depth:.2f}") for depth in tank[2] - surface)
        wanted = f", design.limits.depth={list(limits.depth)}" if limits.depth else ""
        found = f"floor and surface at {high} m and {low} m of depth{wanted}"
    raise BadInput(
        f"{found}, and a clearance of {limits.clearance:g} m: they leave no room",
        where="rovsim design",
        expected="some metres in which the vehicle's middle may move",
        remedy="Choose design.limits.depth and design.limits.clearance that fit into the tank.",
    )


def reached(paths: Array) -> tuple[float, float, float]:
    """Largest speed m/s, turn rate rad/s and tilt rad of paths (s, k, 13)."""
    speed = np.linalg.norm(paths[..., 7:10], axis=-1).max()
    rate = np.linalg.norm(paths[..., 10:13], axis=-1).max()
    tilt = np.abs(to_euler(paths[..., 3:7])[..., :2]).max()
    return float(speed), float(rate), float(tilt)
