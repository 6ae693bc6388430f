"""One step at a time: a model in somebody else's loop, with software or hardware in it.

    stepper = Stepper(model)
    while running:
        state = stepper.step(state, command, 0.001)

Thrusters keep their lag, commands their delay and the water its memory from call to call, so that
a run that is stepped is the run that `rovsim.simulation.replay` replays.
"""

from math import ceil, inf
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.run import CommandKind, Commands, Site
from rovsim.dynamics.body import packed
from rovsim.dynamics.engine.parallel import run_jobs
from rovsim.dynamics.engine.types import Jobs, Place
from rovsim.dynamics.model import Model
from rovsim.simulation.replay import packed_inputs, residual_data, stacked

LONGEST = 0.01  # s, an integration step; see `rovsim.simulation.replay.ReplaySettings`


class Stepper:
    """A model that remembers what a vehicle remembers between two steps.

    States (13,) are true ones at CO: position m in NED, quaternion body to world (w, x, y, z),
    body velocity m/s and rad/s in FRD.

    Args:
        model: physics, effects and perhaps a trained residual.
        kind: what commands are. `thruster` [-1, 1] per thruster, `demand` [-1, 1] per axis, or
            `wrench` N and N m per axis.
        site: walls of the tank, where an effect needs them.
        duration: of the whole run in s, where an effect (a sagging battery) needs it.

    Raises:
        BadInput: an effect lacks what it needs, or acts on commands before they are given.
    """

    def __init__(
        self,
        model: Model,
        kind: CommandKind = "thruster",
        site: Site | None = None,
        duration: float = inf,
    ) -> None:
        site = site or Site.unknown()
        model.check(site, kind)
        _refuse_foresight(model)
        self.model, self.kind, self.duration = model, kind, duration
        self.columns = len(model.body.directions) if kind == "thruster" else 6
        self._place = Place(np.ascontiguousarray(site.tank), np.ascontiguousarray(site.axes))
        self._fixed = model.constants, model.wrench_parameters()[None], residual_data(model)
        self.reset()

    def reset(self) -> None:
        """Begin a new run: no command was given, nothing is remembered."""
        self.time = 0.0
        self._arrival, self._value = np.empty(0), np.empty((0, self.columns))
        self._response: list | None = None
        self._memory = np.zeros(6)

    def step(self, state: Array, command: Array, dt: float) -> Array:
        """The state (13,) after dt s under a command that is given now and holds.

        Steps longer than 10 ms are divided.

        Raises:
            BadInput: a command or state of another shape, or dt that is not positive.
        """
        state, command = np.array(state, dtype=np.float64), np.asarray(command, dtype=np.float64)
        self._refuse(state, command, dt)
        self._give(command)
        count = max(1, ceil(dt / LONGEST - 1e-9))
        h = dt / count
        edges = self.time + h * np.arange(count + 1)
        thrust = self.model.thrust_path.arrived(
            Commands(self._arrival, self._value, self.kind), edges, 0.0, self.duration, "held"
        )
        thrust.force[:], self._response = self.model.thrust_path.respond(
            thrust.force, h, self._response
        )
        constants, p, data = self._fixed
        inputs = packed_inputs(self.model, thrust, self.duration)
        self.model.engine.advance(
            state, self._memory, self.time, h, constants, inputs, p, data, self._place
        )
        self.time += dt
        return state

    def _give(self, command: Array) -> None:
        """Put the command behind those that have not taken effect; forget what is over."""
        arrival = self.model.thrust_path.arrival(np.array([self.time]))
        over = max(int(np.searchsorted(self._arrival, self.time, "right")) - 1, 0)
        self._arrival = np.append(self._arrival[over:], arrival)
        self._value = np.vstack([self._value[over:], command])

    def _refuse(self, state: Array, command: Array, dt: float) -> None:
        fits = state.shape == (13,) and command.shape == (self.columns,)
        if fits and 0.0 < dt < inf and np.isfinite(command).all():
            return
        raise BadInput(
            f"state {state.shape}, command {command.shape}, dt {dt}",
            where="Stepper.step",
            expected=f"state (13,), finite command ({self.columns},) and dt > 0",
            remedy=f"Commands are of the kind '{self.kind}'.",
        )


def _refuse_foresight(model: Model) -> None:
    """Refuse clocks by which a command acts before it is given."""
    if (model.thrust_path.arrival(np.array([0.0, 3600.0])) >= [0.0, 3600.0]).all():
        return
    raise BadInput(
        "its commands act before they are given",
        where=f"model {model.name}",
        expected="input_delay of at least 0 and clock_drift of at most 0",
        remedy="Leave out what only aligns the clocks of two logs.",
    )


def rollouts(
    models: Sequence[Model], states: Array, commands: Array, dt: float, kind: CommandKind
) -> Array:
    """States (m, s, k + 1, 13) of every model from every state under the same commands.

    All run side by side on all cores. The models must have the same wrench effects (an ensemble
    of parameters has) and the same residual.

    Args:
        models: m of them.
        states: where to start (s, 13).
        commands: k of them (k, c), each held for dt.
        dt: s, not longer than an integration step of 10 ms.
        kind: what commands are; see `Stepper`.

    Raises:
        BadInput: models that do not go together, or a dt that does not fit.
    """
    first = models[0]
    same = all(m.engine is first.engine and m.residual is first.residual for m in models)
    if not same or not 0.0 < dt <= LONGEST:
        raise BadInput(
            f"dt {dt}, models {', '.join(m.name for m in models)}",
            where="rollouts",
            expected=f"dt of at most {LONGEST} s; models with the same wrench effects and residual",
            remedy="Run different models one after the other.",
        )
    k, edges = len(commands), dt * np.arange(len(commands) + 1)
    lines, duration = Commands(edges[:-1], np.asarray(commands, np.float64), kind), k * dt
    each = [packed_inputs(m, m.thrust_path.over_steps(lines, edges), duration) for m in models]
    inputs = stacked(each, range(len(models)))
    count = len(models) * len(states)
    zero, member = np.zeros(count, np.int64), np.repeat(np.arange(len(models)), len(states))
    jobs = Jobs(
        np.tile(np.asarray(states, np.float64), (len(models), 1)), np.zeros(count), zero, zero + k,
        member, k * np.arange(count),
    )  # fmt: skip
    constants = packed([m.body for m in models])
    out = np.empty((count * k, 13))
    site = Site.unknown()
    run_jobs(
        first.engine.integrate, jobs, dt, 1, constants, inputs,
        np.stack([m.wrench_parameters() for m in models]),
        residual_data(first), Place(site.tank, site.axes), out,
    )  # fmt: skip
    found = np.concatenate([jobs.state[:, None], out.reshape(count, k, 13)], axis=1)
    return found.reshape(len(models), len(states), k + 1, 13)
