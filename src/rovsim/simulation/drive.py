"""What drives a model over integration steps, or at instants."""

from dataclasses import dataclass, field, replace
from typing import Callable, Sequence, TypeVar

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import Commands
from rovsim.dynamics.actuation import Between, Thrust
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.step_grid import StepGrid

T = TypeVar("T")
KEPT = 64  # drives of a run: what one step of a fit needs, some 0.2 MB each a minute


@dataclass(frozen=True, eq=False)
class Drive:
    """Of one model: means over k steps, or at k instants. Body axes FRD at CO.

    `wrench` (k, 6) N and N m of thrusters, autopilots and commands that are a wrench; `force`
    (k, n) N of each thruster; `demand` (k, 6) in [-1, 1], NaN where none was logged; `duration` s
    of the whole run. `ramp` (k, 6) is what the wrench grows by over each step; empty: nothing.
    `angle` (k, s) rad of each control surface.
    """

    wrench: Array
    force: Array
    demand: Array
    duration: float
    ramp: Array = field(default_factory=lambda: np.empty((0, 6)))
    angle: Array = field(default_factory=lambda: np.empty((0, 0)))

    @property
    def acting(self) -> Array:
        """Forces, then angles (k, n + s), as the engine takes them."""
        return np.hstack([self.force, self.angle]) if self.angle.size else self.force

    @staticmethod
    def by(model: Model, thrust: Thrust, duration: float) -> "Drive":
        """What a thrust does to a model."""
        force = model.thrust_path.thrusters.resolved(thrust.force, thrust.heading)
        wrench = thrust.wrench + model.actuated(force, thrust.demand)
        angle = np.zeros((len(force), model.thrust_path.surfaces))
        if thrust.angle is not None:
            angle = thrust.angle
        return Drive(wrench, force, thrust.demand, duration, angle=angle)

    def each(self, change: Callable[[Array], Array]) -> "Drive":
        """Wrench, forces, demand and angles, all changed alike."""
        names = ("wrench", "force", "demand", "angle")
        changed = {name: change(getattr(self, name)) for name in names}
        return Drive(duration=self.duration, **changed)

    def joined(self, count: Array) -> "Drive":
        """The same over steps as long as `count` (s,) of these: mean, and first moment as a ramp.

        A force that is held over a long step loses when within it it acted.
        """
        first, whole = np.cumsum(count) - count, count[:, None]
        number = np.arange(int(count.sum())) - np.repeat(first, count)
        apart = (number + 0.5) / np.repeat(count, count) - 0.5
        # a line r c over -1/2 < c < 1/2 has the first moment r / 12
        moment = np.add.reduceat(apart[:, None] * self.wrench, first, axis=0) / whole
        long = self.each(lambda x: np.add.reduceat(x, first, axis=0) / whole)
        return replace(long, ramp=12.0 * moment)

    def at(self, steps: Array) -> "Drive":
        """What acts in some of the steps (j,)."""
        return self.each(lambda x: x[steps])

    def pushed(self, wrench: Array) -> "Drive":
        """The same with a further wrench (k, 6)."""
        return replace(self, wrench=self.wrench + wrench)

    def idle(self) -> "Drive":
        """The same demands while no thruster turns."""
        return replace(self, wrench=0 * self.wrench, force=0 * self.force)


class Drives:
    """Drives of models under the commands of one run; the last ones are kept.

    Models that are driven alike share one: thrust takes as long to find as a short simulation.

    Args:
        commands: the log.
        edges: ends (k+1,) s of the steps, over each of which thrust is steady.
        between: two lines of the log.
        parts: (s,) so many steps are then joined to each one.
    """

    def __init__(
        self, commands: Commands, edges: Array, between: Between, parts: Array | None = None
    ) -> None:
        self._given = commands, edges, between
        self._parts = parts
        self._thrusts: dict[tuple, Thrust] = {}
        self._drives: dict[tuple, Drive] = {}

    def of(self, models: Sequence[Model]) -> list[Drive]:
        """One for each model."""
        return [self._of(model) for model in models]

    def _of(self, model: Model) -> Drive:
        path = model.thrust_path
        key = (id(model.vehicle), *path.key)
        loops = [loop.values.tobytes() for loop in path.autopilots]
        inertia = model.body.M.tobytes() if loops else b""
        whole = (*key, *loops, inertia, model.body.B.tobytes())
        edges = self._given[1]
        if whole not in self._drives:
            if key not in self._thrusts:
                _keep(self._thrusts, key, path.over_steps(*self._given))
            drive = Drive.by(model, self._thrusts[key], float(edges[-1] - edges[0]))
            joined = drive if self._parts is None else drive.joined(self._parts)
            _keep(self._drives, whole, joined)
        return self._drives[whole]


def _keep(kept: dict[tuple, T], key: tuple, value: T) -> None:
    """Put in, and let go of what came first."""
    kept[key] = value
    if len(kept) > KEPT:
        del kept[next(iter(kept))]


def drive_by_log(model: Model, motion: Motion, grid: StepGrid, settings: ReplaySettings) -> Drive:
    """What the logged commands of a run do to a model.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    model.check(motion.site, motion.commands.kind)
    return Drives(motion.commands, grid.edges, settings.commands).of([model])[0]
