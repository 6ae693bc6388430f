"""What drives a model over integration steps, or at instants."""

from dataclasses import dataclass, field, replace
from typing import Callable, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.sparse import csr_array

from rovsim.core.bounded_cache import Recent
from rovsim.core.run import Between, Commands
from rovsim.dynamics.actuation import Thrust
from rovsim.dynamics.model import Model
from rovsim.dynamics.step_cuts import StepCuts
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.step_grid import StepGrid

KEPT = 1 << 26  # bytes: fifty drives of a minute, what one step of a fit needs


class Reads(NamedTuple):
    """What the effects of an engine read: columns of actuators, and channels by name."""

    actuators: int
    channels: tuple[str, ...]


class Actuation(NamedTuple):
    """What commands make of thrusters over k steps, whatever body they push.

    `wrench` (k, 6) N and N m that commands are themselves; `force` (k, n) N of each component of
    a thruster; `demand` (k, 6) in [-1, 1], NaN where none was logged; `angle` (k, s) rad of each
    control surface; `read` (k, r) where an effect reads them: forces and commands of the actuators,
    then the channels of the model's thrust path.
    """

    wrench: Array
    force: Array
    demand: Array
    angle: Array
    read: Array

    @staticmethod
    def by(model: Model, thrust: Thrust) -> "Actuation":
        """Of a thrust."""
        force = model.thrust_path.thrusters.resolved(thrust.force, thrust.cosine, thrust.sine)
        angle = thrust.angle
        if angle is None:
            angle = np.zeros((len(force), model.thrust_path.surfaces))
        read = np.empty((len(force), 0))
        if thrust.read is not None:
            read = np.hstack([thrust.force, thrust.read])
        return Actuation(thrust.wrench, force, thrust.demand, angle, read)

    def push(self, model: Model) -> Array:
        """Wrench (k, 6) on a model, its autopilots' share included; linear in all that acts."""
        return np.asarray(self.wrench + model.actuated(self.force, self.demand))

    def drive(self, model: Model, duration: float) -> "Drive":
        """What drives a model, in a run of that many s."""
        return Drive(
            self.push(model),
            self.force,
            self.demand,
            duration,
            angle=self.angle,
            read=self.read,
            channels=model.thrust_path.channels,
        )

    def joined(self, count: Array) -> tuple["Actuation", "Actuation"]:
        """Means over steps as long as `count` (s,) of these, and what each grows by over them.

        A force that is held over a long step loses when within it it acted; a line with the same
        first moment does not.
        """
        bounds = np.append(0, np.cumsum(count))
        number = np.arange(bounds[-1])
        share = 1.0 / np.repeat(count, count)
        # a line r c over -1/2 < c < 1/2 has the first moment r / 12
        apart = 12.0 * ((number - np.repeat(bounds[:-1], count) + 0.5) * share - 0.5)
        mean, growth = (csr_array((w, number, bounds)) for w in (share, apart * share))
        return Actuation(*(mean @ x for x in self)), Actuation(*(growth @ x for x in self))


@dataclass(frozen=True, eq=False)
class Drive:
    """Of one model: means over k steps, or at k instants. Body axes FRD at CO.

    `wrench` (k, 6) N and N m of thrusters, autopilots and commands that are a wrench; `force`
    (k, n) N of each thruster; `demand` (k, 6) in [-1, 1], NaN where none was logged; `duration` s
    of the whole run. `ramp` (k, 6) is what the wrench grows by over each step; empty: nothing.
    `angle` (k, s) rad of each control surface. `read` (k, r): where an effect reads them, forces
    and commands of the actuators, then the `channels`; empty elsewhere.
    """

    wrench: Array
    force: Array
    demand: Array
    duration: float
    ramp: Array = field(default_factory=lambda: np.empty((0, 6)))
    angle: Array = field(default_factory=lambda: np.empty((0, 0)))
    read: Array = field(default_factory=lambda: np.empty((0, 0)))
    channels: tuple[str, ...] = ()

    def acting(self, reads: Reads | None) -> Array:
        """Forces and angles (k, n + s), then what effects read; zero what this model's do not.

        As the engine takes them (`rovsim.dynamics.engine.reading`).
        """
        own = np.hstack([self.force, self.angle]) if self.angle.size else self.force
        if reads is None:
            return own
        table = np.zeros((len(own), reads.actuators + len(reads.channels)))
        if self.read.size:
            table[:, : reads.actuators] = self.read[:, : reads.actuators]
            known = dict(zip(self.channels, self.read[:, reads.actuators :].T, strict=True))
            for k, name in enumerate(reads.channels):
                table[:, reads.actuators + k] = known.get(name, 0.0)
        return np.hstack([own, table])

    @staticmethod
    def by(model: Model, thrust: Thrust, duration: float) -> "Drive":
        """What a thrust does to a model."""
        return Actuation.by(model, thrust).drive(model, duration)

    def each(self, change: Callable[[Array], Array]) -> "Drive":
        """Wrench, forces, demand, angles and what is read, all changed alike."""
        names = ("wrench", "force", "demand", "angle", "read")
        changed = {name: change(getattr(self, name)) for name in names}
        return Drive(duration=self.duration, channels=self.channels, **changed)

    def at(self, steps: Array) -> "Drive":
        """What acts in some of the steps (j,)."""
        return self.each(lambda x: x[steps])

    def pushed(self, wrench: Array) -> "Drive":
        """The same with a further wrench (k, 6)."""
        return replace(self, wrench=self.wrench + wrench)

    def idle(self) -> "Drive":
        """The same demands while no thruster turns."""
        return replace(self, wrench=0 * self.wrench, force=0 * self.force, read=0 * self.read)


class Drives:
    """Drives of models under the commands of one run; the last ones are kept.

    Models that are driven alike share one: thrust takes as long to find as a short simulation.

    Args:
        commands: the log.
        edges: ends (k+1,) s of the steps, over each of which thrust is steady.
        between: two lines of the log.
        parts: (s,) so many steps are then joined to each one.
        kept: where they are kept, perhaps with those of other runs.
    """

    def __init__(
        self,
        commands: Commands,
        edges: Array,
        between: Between,
        parts: Array | None = None,
        kept: Recent | None = None,
    ) -> None:
        self._given = commands, edges, between
        self._cuts = StepCuts()
        self._parts = parts
        self._kept = Recent(KEPT) if kept is None else kept
        self._own = object()  # of its keys: no other run has it

    def of(self, models: Sequence[Model]) -> list[Drive]:
        """One for each model."""
        return [self._of(model) for model in models]

    def _of(self, model: Model) -> Drive:
        path = model.thrust_path
        key = (self._own, id(model.vehicle), *path.key)
        loops = [loop.values.tobytes() for loop in path.autopilots]
        inertia = model.M.tobytes() if loops else b""
        whole = (*key, *loops, inertia, model.body.B.tobytes())
        return self._kept.get(whole, lambda: self._drive(model, key))

    def _drive(self, model: Model, key: tuple) -> Drive:
        mean, *growth = self._kept.get((key,), lambda: self._actuate(model))
        commands, edges, _ = self._given
        drive = mean.drive(model, commands.recording(edges)[1])
        return replace(drive, ramp=growth[0].push(model)) if growth else drive

    def _actuate(self, model: Model) -> tuple[Actuation, ...]:
        """Over the steps; where they are joined, also what each grows by."""
        found = Actuation.by(model, model.thrust_path.over_steps(*self._given, self._cuts))
        return (found,) if self._parts is None else found.joined(self._parts)


def drive_by_log(model: Model, motion: Motion, grid: StepGrid, between: Between) -> Drive:
    """What the logged commands of a run do to a model; `between` two logged lines.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    model.check(motion.site, motion.commands.kind)
    return Drives(motion.commands, grid.edges, between).of([model])[0]
