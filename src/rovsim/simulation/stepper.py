"""Steps a model one command at a time, for software or hardware in the loop.

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
from rovsim.core.run import CommandKind, Commands, Site, latest
from rovsim.dynamics.model import Model
from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.drive import Drive, Drives

MAX_STEP_S = 0.01  # an integration step; see `rovsim.simulation.settings.ReplaySettings`


class Stepper:
    """A model that keeps what is not part of its state: thruster lag, late commands, fluid memory.

    States (13,) are true ones at CO: position m in NED, quaternion body to world (w, x, y, z),
    body velocity m/s and rad/s in FRD.

    Args:
        model: physics, effects and perhaps a trained residual.
        kind: what commands are. `thruster` [-1, 1] per thruster, `demand` [-1, 1] per axis, or
            `wrench` N and N m per axis.
        site: walls of the tank, where an effect needs them.
        duration: of the whole run, s, needed where an effect changes over a run (such as a battery
            whose voltage sags).

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
        _refuse_unknown_duration(model, duration)
        self.model, self.kind, self.duration = model, kind, duration
        self.columns = model.thrust_path.columns(kind)
        self._batch = Batch([model], site)
        self.reset()

    def reset(self) -> None:
        """Begin a new run: forget all commands, the thruster lag and the fluid memory."""
        self.time = 0.0
        self._arrival, self._value = np.empty(0), np.empty((0, self.columns))
        self._response: list | None = None
        self._memory = np.zeros(6)

    def step(self, state: Array, command: Array, dt: float, wrench: Array | None = None) -> Array:
        """Step the model by dt s under a command that is given now and held.

        Args:
            state: at the beginning of the step (13,).
            command: (c,) in the unit of its kind.
            dt: length of the step, s; longer ones than 10 ms are divided.
            wrench: a further wrench (6,) that acts during the step, N and N m, in body axes FRD at
                CO.

        Returns:
            The state (13,) at the end of the step.

        Raises:
            BadInput: a command or state of another shape, or dt that is not positive.
        """
        state, command = np.array(state, dtype=np.float64), np.asarray(command, dtype=np.float64)
        self._refuse(state, command, dt)
        self._give(command)
        count = max(1, ceil(dt / MAX_STEP_S - 1e-9))
        h = dt / count
        edges = self.time + h * np.arange(count + 1)
        thrust = self.model.thrust_path.arrived(
            Commands(self._arrival, self._value, self.kind), edges, 0.0, self.duration, "held"
        )
        thrust.force[:], self._response = self.model.thrust_path.respond(
            thrust.force, h, self._response
        )
        drive = Drive.by(self.model, thrust, self.duration)
        if wrench is not None:
            drive = drive.with_wrench(np.asarray(wrench, dtype=np.float64))
        self._batch.advance(drive, state, self._memory, self.time, h)
        self.time += dt
        return state

    def _give(self, command: Array) -> None:
        """Queue a command behind those that have not yet taken effect, and drop replaced ones."""
        arrival = self.model.thrust_path.effective_time(np.array([self.time]))
        current = int(latest(self._arrival, self.time))
        self._arrival = np.append(self._arrival[current:], arrival)
        self._value = np.vstack([self._value[current:], command])

    def _refuse(self, state: Array, command: Array, dt: float) -> None:
        shapes_fit = state.shape == (13,) and command.shape == (self.columns,)
        if shapes_fit and 0.0 < dt < inf and np.isfinite(command).all():
            return
        raise BadInput(
            f"state {state.shape}, command {command.shape}, dt {dt}",
            where="Stepper.step",
            expected=f"state (13,), finite command ({self.columns},) and dt > 0",
            remedy=f"Commands are of the kind '{self.kind}'.",
        )


def _refuse_foresight(model: Model) -> None:
    """Refuse clocks by which a command acts before it is given."""
    if (model.thrust_path.effective_time(np.array([0.0, 3600.0])) >= [0.0, 3600.0]).all():
        return
    raise BadInput(
        "its commands act before they are given",
        where=f"model {model.name}",
        expected="input_delay of at least 0 and clock_drift of at most 0",
        remedy="Leave out what only aligns the clocks of two logs.",
    )


def _refuse_unknown_duration(model: Model, duration: float) -> None:
    """Refuse effects whose values refer to a whole run where its duration is not known."""
    names = [effect.id for effect in model.effects if effect.needs_duration()]
    if not names or duration < inf:
        return
    raise BadInput(
        f"{', '.join(names)} is given per run, and the duration of the run is not known",
        where=f"model {model.name}",
        expected="Stepper(…, duration=…), or values that hold for any run",
        remedy="Give voltage_sag a rate: its fraction divided by the duration of the runs in s.",
    )


def rollouts(
    models: Sequence[Model], states: Array, commands: Array, dt: float, kind: CommandKind
) -> Array:
    """Simulate every model from every state under the same commands.

    All run side by side on all cores. The models must have the same wrench effects (an ensemble
    of parameters has) and the same residual.

    Args:
        models: m of them.
        states: where to start (s, 13).
        commands: k of them (k, c), each held for dt.
        dt: s, not longer than an integration step of 10 ms.
        kind: what commands are; see `Stepper`.

    Returns:
        States (m, s, k + 1, 13), of which the first of each trajectory is the given one.

    Raises:
        BadInput: models with different residuals, effects that need the duration of the run, or a
            dt that is not positive or too long.
    """
    for model in models:
        _refuse_unknown_duration(model, inf)
    if not 0.0 < dt <= MAX_STEP_S:
        raise BadInput(
            f"dt {dt}",
            where="rollouts",
            expected=f"dt of at most {MAX_STEP_S} s",
            remedy="Give a command several times in a row.",
        )
    count, edges = len(commands), dt * np.arange(len(commands) + 1)
    lines = Commands(edges[:-1], np.asarray(commands, np.float64), kind)
    starts = Starts(
        np.tile(np.asarray(states, np.float64), (len(models), 1, 1)),
        np.zeros(len(states), np.int64),
        np.full(len(states), count),
    )
    batch = Batch(models, Site.unknown())
    drives = Drives(lines, edges, "held").of(models)
    return np.array(batch.trajectories(drives, starts, edges))
