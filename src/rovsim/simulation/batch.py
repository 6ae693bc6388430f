"""The only way into the compiled engine: from models, drives and starts to trajectories.

Replay, stepping, training pairs, the force budget, the observer, the tank and the benchmarks all
use it. Only this module, `packed_models` and the engine know which arguments the kernels take.
"""

from dataclasses import dataclass, field, replace
from typing import Any, Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.run import Site
from rovsim.core.threads import on_cores
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.engine.types import NO_MEMORY, Inputs, Jobs, SiteArrays, World
from rovsim.dynamics.model import Model
from rovsim.simulation.correction import Correction
from rovsim.simulation.drive import Drive
from rovsim.simulation.packed_models import pack


@dataclass(frozen=True, eq=False)
class Starts:
    """Where trajectories begin: w of them for each of m models.

    Attributes:
        state: true states (m, w, 13) at CO: pose in NED, body velocity in FRD.
        first: index (w,) of the first step of each; for `Batch.innovations`, of the first reading.
        steps: number (w,) of steps of each; for `Batch.innovations`, of readings.
        memory: velocity (m, w, 6), the state of the fluid memory, m/s and rad/s; empty where no
            model has a fluid memory.
    """

    state: Array
    first: Array
    steps: Array
    memory: Array = field(default_factory=lambda: NO_MEMORY)

    def jobs(self, out: Array) -> Jobs:
        """One job for each trajectory; a kernel writes its results from row `out` (m w,) on."""
        models, count = self.state.shape[:2]
        return Jobs(
            self.state.reshape(-1, 13),
            np.tile(self.first, models),
            np.tile(self.steps, models),
            np.repeat(np.arange(models), count),
            out,
            self.memory.reshape(-1, 6),
        )


class Batch:
    """Models of one vehicle, simulated side by side at one site.

    The attribute `free` (13,) is 0 for velocities along axes in which the vehicle cannot move, and
    1 for all other numbers of a state.

    Args:
        models: m of them.
        site: walls, where an effect needs them.
        candidates: wrench effects that later models of the same task may have. One engine then
            serves all these models and is compiled once.
        learned: whether the learned residual acts, which all models must share.

    Raises:
        BadInput: models with different residuals.
    """

    def __init__(
        self,
        models: Sequence[Model],
        site: Site,
        *,
        candidates: Sequence[type[Wrench]] = (),
        learned: bool = True,
    ) -> None:
        self._residual: Array | None = None
        if learned:
            _refuse_unlike(models)
            self._residual = models[0].residual.data if models[0].residual else None
        self._packed = pack(tuple(models), tuple(candidates))
        self.engine = self._packed.engine
        self._site = SiteArrays(
            np.ascontiguousarray(site.tank), np.ascontiguousarray(site.axes), float(site.level)
        )
        self.free = np.concatenate([np.ones(7), models[0].body.free])

    def trajectories(
        self, drives: Sequence[Drive], starts: Starts, time: Array, stride: int = 1
    ) -> list[list[Array]]:
        """Simulate each model from each start.

        Args:
            drives: one for each model.
            starts: where to begin; `steps` must be multiples of `stride`.
            time: (k+1,) s at which the integration steps begin and end.
            stride: steps from one returned state to the next.

        Returns:
            States (steps / stride + 1, 13) for each model and start; the first is the start.
        """
        models, count = starts.state.shape[:2]
        rows = np.tile(starts.steps // stride + 1, models)
        stops = np.cumsum(rows)
        out = np.empty((int(rows.sum()), 13))
        starts = replace(starts, state=starts.state * self.free)
        out[stops - rows] = starts.state.reshape(-1, 13)
        jobs = starts.jobs(stops - rows + 1)
        run_jobs(self.engine.integrate, jobs, time, stride, self._world(drives), out)
        paths = [out[a:b] for a, b in zip(stops - rows, stops, strict=True)]
        return [paths[k * count : (k + 1) * count] for k in range(models)]

    def innovations(self, drives: Sequence[Drive], starts: Starts, correction: Correction) -> Array:
        """Filter readings with models, as a Kalman filter with fixed gains does; no residual acts.

        Args:
            drives: one for each of m models.
            starts: first reading and number of readings of each trajectory, n readings in all.
            correction: the readings and the filters.

        Returns:
            Innovations (m, n, 6), reading minus prediction: m and rad, or m/s and rad/s where
            velocities are read.
        """
        models, count = len(starts.state), int(starts.steps.sum())
        stops = np.cumsum(np.tile(starts.steps, models))
        out = np.empty((models * count, 6))
        starts = replace(starts, state=starts.state * self.free)
        jobs = starts.jobs(stops - np.tile(starts.steps, models))
        world = self._world(drives)._replace(residual=None)
        run_jobs(self.engine.observe, jobs, world, correction, out)
        return out.reshape(models, count, 6)

    def accelerations(self, drive: Drive, times: Array, states: Array, memory: Array) -> Array:
        """Evaluate the body acceleration (n, 6) of the first model, m/s2 and rad/s2, at n instants.

        Args:
            drive: at the n instants.
            times: (n,) since the start of the recording, s.
            states: true states (n, 13) at CO.
            memory: state (n, 6) of the fluid memory, m/s and rad/s; empty without one.
        """
        out, states = np.empty((len(times), 6)), np.ascontiguousarray(states * self.free)
        self.engine.accelerations(times, states, memory, self._world([drive]), out)
        return out

    def advance(self, drive: Drive, state: Array, memory: Array, t: float, h: float) -> None:
        """Integrate state (13,) and memory (6,) of the first model in place, in steps of h s."""
        state *= self.free
        self.engine.advance(state, memory, t, h, self._world([drive]))

    def advance_by_heun(
        self, drive: Drive, accelerations: Array, state: Array, memory: Array, t: float, h: float
    ) -> Array:
        """Integrate the first model with Heun's method; returns the states (k, 13) after each step.

        For the synthetic tank alone, whose truth must not share a replay's integrator. The
        `accelerations` (k, 6), m/s2 and rad/s2, are not logged. `memory` (6,) is updated in place.
        """
        out = np.empty((len(accelerations), 13))
        self.engine.heun(state, memory, t, h, accelerations, self._world([drive]), out)
        return out

    def _world(self, drives: Sequence[Drive]) -> World:
        """Physics, drives, learned residual and surroundings of all models."""
        inputs = self._inputs(drives)
        constants, parameters = self._packed.constants, self._packed.parameters
        return World(constants, inputs, parameters, self._residual, self._site)

    def _inputs(self, drives: Sequence[Drive]) -> Inputs:
        """Stack the drives for the kernels; a drive that several models share is passed once."""
        distinct, row = _distinct(drives)
        first = distinct[0]
        columns = [drive.engine_columns(self._packed.reads) for drive in distinct]
        if len(distinct) == 1:
            wrench, force, ramp = first.wrench[None], columns[0][None], first.ramp[None]
        else:
            wrench, force = np.stack([d.wrench for d in distinct]), np.stack(columns)
            ramp = np.stack([d.ramp for d in distinct])
        length = np.full(len(first.wrench), first.duration)
        return Inputs(wrench, force, first.demand, row, length, ramp)


def run_jobs(kernel: Callable, jobs: Jobs, *given: Any) -> None:
    """Call `kernel(part, *given)` for parts of the jobs on all cores; it must release the GIL."""
    on_cores(lambda part: kernel(Jobs(*(values[part] for values in jobs)), *given), jobs.steps)


def _refuse_unlike(models: Sequence[Model]) -> None:
    if all(m.residual is models[0].residual for m in models):
        return
    raise BadInput(
        f"models {', '.join(m.name for m in models)}",
        where="one batch",
        expected="models with the same residual",
        remedy="Run different models one after the other.",
    )


def _distinct(drives: Sequence[Drive]) -> tuple[list[Drive], Array]:
    """The distinct ones (by identity) of m drives, and the index (m,) of each drive among them."""
    by_id = {id(drive): drive for drive in drives}
    positions = {key: k for k, key in enumerate(by_id)}
    return list(by_id.values()), np.array([positions[id(drive)] for drive in drives], np.int64)
