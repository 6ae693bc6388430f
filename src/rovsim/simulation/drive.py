"""What drives a model over integration steps, or at instants."""

from dataclasses import dataclass, replace
from typing import Callable, Sequence

from numpy import ndarray as Array

from rovsim.core.run import Commands
from rovsim.dynamics.actuation import Between, Thrust
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.step_grid import StepGrid


@dataclass(frozen=True, eq=False)
class Drive:
    """Of one model: means over k steps, or at k instants. Body axes FRD at CO.

    `wrench` (k, 6) N and N m of thrusters, autopilots and commands that are a wrench; `force`
    (k, n) N of each thruster; `demand` (k, 6) in [-1, 1], NaN where none was logged; `duration` s
    of the whole run.
    """

    wrench: Array
    force: Array
    demand: Array
    duration: float

    @staticmethod
    def by(model: Model, thrust: Thrust, duration: float) -> "Drive":
        """What a thrust does to a model."""
        wrench = thrust.wrench + model.actuated(thrust.force, thrust.demand)
        return Drive(wrench, thrust.force, thrust.demand, duration)

    def each(self, change: Callable[[Array], Array]) -> "Drive":
        """Wrench, forces and demand, all changed alike."""
        return Drive(change(self.wrench), change(self.force), change(self.demand), self.duration)

    def at(self, steps: Array) -> "Drive":
        """What acts in some of the steps (j,)."""
        return self.each(lambda x: x[steps])

    def pushed(self, wrench: Array) -> "Drive":
        """The same with a further wrench (k, 6)."""
        return replace(self, wrench=self.wrench + wrench)

    def idle(self) -> "Drive":
        """The same demands while no thruster turns."""
        return replace(self, wrench=0 * self.wrench, force=0 * self.force)


def drive_models(
    models: Sequence[Model], commands: Commands, edges: Array, between: Between
) -> list[Drive]:
    """Drives of models under logged commands, over the steps between `edges` (k+1,) s.

    Models that are driven alike share one: thrust takes as long to find as a short simulation.
    """
    duration = float(edges[-1] - edges[0])
    thrusts: dict[tuple, Thrust] = {}
    drives: dict[tuple, Drive] = {}
    keys = []
    for model in models:
        path = model.thrust_path
        thrust = (id(model.vehicle), *path.key)
        if thrust not in thrusts:
            thrusts[thrust] = path.over_steps(commands, edges, between)
        loops = [loop.values.tobytes() for loop in path.autopilots]
        inertia = model.body.M.tobytes() if loops else b""
        keys.append((*thrust, *loops, inertia, model.body.B.tobytes()))
        if keys[-1] not in drives:
            drives[keys[-1]] = Drive.by(model, thrusts[thrust], duration)
    return [drives[key] for key in keys]


def drive_by_log(model: Model, motion: Motion, grid: StepGrid, settings: ReplaySettings) -> Drive:
    """What the logged commands of a run do to a model.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    model.check(motion.site, motion.commands.kind)
    return drive_models([model], motion.commands, grid.edges, settings.commands)[0]
