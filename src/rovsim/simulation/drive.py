"""Forces and demands that drive a model, as means over integration steps or values at instants."""

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

MAX_KEPT_BYTES = 1 << 26  # fifty drives of a minute each, as many as one step of a fit needs


class Reads(NamedTuple):
    """Columns of a drive that the effects of an engine read.

    Attributes:
        actuators: number of columns with the forces and commands of the actuators.
        channels: names of the further columns, which were logged beside the commands, such as a
            voltage.
    """

    actuators: int
    channels: tuple[str, ...]


class Actuation(NamedTuple):
    """What commands make the actuators do over k steps; it does not depend on the vehicle's body.

    Attributes:
        wrench: commands that are a wrench themselves (k, 6), N and N m, in body axes FRD at CO.
        force: of each component of each thruster (k, n), N. A thruster that turns has two.
        demand: pilot demand (k, 6) of each axis in [-1, 1]; NaN where none was logged.
        angle: of each control surface (k, s), rad.
        read: columns (k, r) for the effects that read them: forces and commands of the actuators,
            then the channels of the model's thrust path; empty where no effect reads them.
    """

    wrench: Array
    force: Array
    demand: Array
    angle: Array
    read: Array

    @staticmethod
    def by(model: Model, thrust: Thrust) -> "Actuation":
        """Make the actuation of a thrust, with forces along the components of each thruster."""
        force = model.thrust_path.thrusters.resolved(thrust.force, thrust.cosine, thrust.sine)
        angle = thrust.angle
        if angle is None:
            angle = np.zeros((len(force), model.thrust_path.surfaces))
        readings = np.empty((len(force), 0))
        if thrust.read is not None:
            readings = np.hstack([thrust.force, thrust.read])
        return Actuation(thrust.wrench, force, thrust.demand, angle, readings)

    def wrench_on(self, model: Model) -> Array:
        """Wrench (k, 6) on a model, autopilots included, N and N m; linear in the actuation."""
        return np.asarray(self.wrench + model.actuated(self.force, self.demand))

    def drive(self, model: Model, duration: float) -> "Drive":
        """The drive of a model in a run of `duration` s."""
        return Drive(
            self.wrench_on(model),
            self.force,
            self.demand,
            duration,
            angle=self.angle,
            read=self.read,
            channels=model.thrust_path.channels,
        )

    def joined(self, steps: "JoinedSteps") -> tuple["Actuation", "Actuation"]:
        """Join steps to longer ones, over each of which the actuation is a straight line.

        A mean over a long step forgets when within the step a force acted. A line with the same
        mean and the same first moment about the middle of the step keeps that.

        Returns:
            Means over the longer steps, and by how much the lines rise over each of them.
        """
        mean, rise = (Actuation(*(weigh @ x for x in self)) for weigh in steps)
        return mean, rise


class JoinedSteps(NamedTuple):
    """Sparse matrices (s, k) that join k steps to s longer ones.

    Attributes:
        mean: gives means over the longer steps.
        rise: gives by how much a straight line with the same first moment rises over each of them.
    """

    mean: csr_array
    rise: csr_array

    @staticmethod
    def of(count: Array) -> "JoinedSteps":
        """Join so many steps (s,) to each of s longer ones."""
        bounds = np.append(0, np.cumsum(count))
        number = np.arange(bounds[-1])
        share = 1.0 / np.repeat(count, count)
        # a line r c over -1/2 < c < 1/2 has the first moment r / 12
        apart = 12.0 * ((number - np.repeat(bounds[:-1], count) + 0.5) * share - 0.5)
        return JoinedSteps(*(csr_array((w, number, bounds)) for w in (share, apart * share)))


@dataclass(frozen=True, eq=False)
class Drive:
    """What drives one model: means over k steps, or values at k instants. Body axes FRD at CO.

    Attributes:
        wrench: sum (k, 6) of thrusters, autopilots and commands that are a wrench, N and N m.
        force: of each component of each thruster (k, n), N.
        demand: pilot demand (k, 6) of each axis in [-1, 1]; NaN where none was logged.
        duration: of the whole run, s.
        ramp: by how much the wrench rises over each step (k, 6), N and N m; empty where it is
            constant over each step.
        angle: of each control surface (k, s), rad.
        read: columns (k, r) for the effects that read them: forces and commands of the actuators,
            then the `channels`; empty where no effect reads them.
        channels: names of the last columns of `read`.
    """

    wrench: Array
    force: Array
    demand: Array
    duration: float
    ramp: Array = field(default_factory=lambda: np.empty((0, 6)))
    angle: Array = field(default_factory=lambda: np.empty((0, 0)))
    read: Array = field(default_factory=lambda: np.empty((0, 0)))
    channels: tuple[str, ...] = ()

    def engine_columns(self, reads: Reads | None) -> Array:
        """The columns that the engine takes: forces, angles, then those that its effects read.

        Columns of channels that this model does not have are zero. The order is that of
        `rovsim.dynamics.engine.kernel_inputs`.

        Returns:
            Array (k, n + s), or (k, n + s + actuators + channels) where effects read something.
        """
        columns = np.hstack([self.force, self.angle]) if self.angle.size else self.force
        if reads is None:
            return columns
        table = np.zeros((len(columns), reads.actuators + len(reads.channels)))
        if self.read.size:
            table[:, : reads.actuators] = self.read[:, : reads.actuators]
            by_channel = dict(zip(self.channels, self.read[:, reads.actuators :].T, strict=True))
            for k, name in enumerate(reads.channels):
                table[:, reads.actuators + k] = by_channel.get(name, 0.0)
        return np.hstack([columns, table])

    @staticmethod
    def by(model: Model, thrust: Thrust, duration: float) -> "Drive":
        """The drive of a model under a thrust, in a run of `duration` s."""
        return Actuation.by(model, thrust).drive(model, duration)

    def each(self, change: Callable[[Array], Array]) -> "Drive":
        """Apply a function to wrench, force, demand, angle and read; the result has no ramp."""
        names = ("wrench", "force", "demand", "angle", "read")
        changed = {name: change(getattr(self, name)) for name in names}
        return Drive(duration=self.duration, channels=self.channels, **changed)

    def at(self, steps: Array) -> "Drive":
        """The drive at some of its steps or instants: their indices (j,)."""
        return self.each(lambda x: x[steps])

    def with_wrench(self, wrench: Array) -> "Drive":
        """Add a further wrench (k, 6), N and N m, in body axes FRD at CO."""
        return replace(self, wrench=self.wrench + wrench)

    def idle(self) -> "Drive":
        """The drive with the same demands and surface angles, but no wrench or thruster force."""
        return replace(self, wrench=0 * self.wrench, force=0 * self.force, read=0 * self.read)


class Drives:
    """Makes the drives of models under the commands of one run, and caches the latest ones.

    To compute the thrust takes as long as a short simulation, so models with the same thrust share
    one drive.

    Args:
        commands: the log of the run.
        edges: (k+1,) at which the steps begin and end, s; thrust is constant over each step.
        between: whether commands are held between two lines of the log, or interpolated.
        parts: (s,) how many of these steps make each of s longer ones; None: all stay as they are.
        kept: the cache, which drives of other runs may share.
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
        self._joined = None if parts is None else JoinedSteps.of(parts)
        self._kept = Recent(MAX_KEPT_BYTES) if kept is None else kept
        self._own = object()  # part of its keys, which no other run has

    def of(self, models: Sequence[Model]) -> list[Drive]:
        """The drive of each model."""
        return [self._of(model) for model in models]

    def _of(self, model: Model) -> Drive:
        """Look up or make the drive of a model; the key holds all numbers that it depends on."""
        path = model.thrust_path
        key = (self._own, id(model.vehicle), *path.key)
        loops = [loop.values.tobytes() for loop in path.autopilots]
        inertia = model.M.tobytes() if loops else b""
        full_key = (*key, *loops, inertia, model.body.B.tobytes())
        return self._kept.get(full_key, lambda: self._drive(model, key))

    def _drive(self, model: Model, key: tuple) -> Drive:
        """Make the drive of a model from the actuation with this key, which models may share."""
        mean, *growth = self._kept.get((key,), lambda: self._actuate(model))
        commands, edges, _ = self._given
        drive = mean.drive(model, commands.recording(edges)[1])
        return replace(drive, ramp=growth[0].wrench_on(model)) if growth else drive

    def _actuate(self, model: Model) -> tuple[Actuation, ...]:
        """Actuation over the steps; where these are joined, also its rise over each of them."""
        actuation = Actuation.by(model, model.thrust_path.over_steps(*self._given, self._cuts))
        return (actuation,) if self._joined is None else actuation.joined(self._joined)


def drive_by_log(model: Model, motion: Motion, grid: StepGrid, between: Between) -> Drive:
    """The drive of a model under the logged commands of a run.

    Args:
        model: the model.
        motion: the run, which has the command log.
        grid: integration steps, over each of which thrust is constant.
        between: whether commands are held between two lines of the log, or interpolated.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    model.check(motion.site, motion.commands.kind)
    return Drives(motion.commands, grid.edges, between).of([model])[0]
