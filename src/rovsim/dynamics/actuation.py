"""The thrust path: from logged commands to the mean force of each thruster over each step.

Order (docs/simulator.md): clock -> mixer (demands only) -> deadband -> force curve -> gain,
asymmetry, sag -> lag. What depends on the vehicle's motion (advance loss) is in the engine.
"""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.run import Between, CommandKind, Commands
from rovsim.dynamics.effects.base import (
    Autopilot,
    CommandTiming,
    CommandTransform,
    DemandTransform,
    Effect,
    ThrustCurveShape,
    ThrusterDynamics,
    ThrustScaling,
    Wrench,
)
from rovsim.dynamics.step_cuts import StepCuts
from rovsim.dynamics.vehicle import Surfaces, Thrusters

STEPS_PER_BATCH = 1 << 16  # this takes twenty times the memory of the result


@dataclass(frozen=True, eq=False)
class Thrust:
    """Actuation at k instants or means over k steps: `force` (k, n), N, of n thrusters.

    `wrench` (k, 6): commanded directly. `demand` (k, 6): NaN if not logged. `cosine`, `sine` (k, a)
    of the azimuth angles, `angle` (k, s), rad, of control surfaces; None if a wrench is commanded.
    `read` (k, c + q): commands as logged and mixed, then `ThrustPath.channels`; None if no effect
    reads them.
    """

    force: Array
    wrench: Array
    demand: Array
    cosine: Array | None = None
    sine: Array | None = None
    angle: Array | None = None
    read: Array | None = None

    def each(self, change: Callable[[Array], Array]) -> "Thrust":
        """Apply a function to all arrays."""
        return Thrust(**{name: change(part) for name, part in self._parts.items()})

    @staticmethod
    def joined(parts: "Sequence[Thrust]") -> "Thrust":
        """Concatenate parts along the steps."""
        if len(parts) == 1:
            return parts[0]
        names = parts[0]._parts
        return Thrust(**{name: np.concatenate([p._parts[name] for p in parts]) for name in names})

    @property
    def _parts(self) -> dict[str, Array]:
        arrays = {f.name: getattr(self, f.name) for f in fields(self)}
        return {name: part for name, part in arrays.items() if part is not None}


class ThrustPath:
    """Thrusters and the effects between a logged command and their force."""

    def __init__(self, thrusters: Thrusters, effects: Sequence[Effect]) -> None:
        ranked = sorted(effects, key=lambda effect: effect.rank)
        self.thrusters = thrusters
        self.surfaces = sum(len(e.names) for e in ranked if isinstance(e, Surfaces))
        self.timings = [e for e in ranked if isinstance(e, CommandTiming)]
        self.demand_transforms = [e for e in ranked if isinstance(e, DemandTransform)]
        self.autopilots = [e for e in ranked if isinstance(e, Autopilot)]
        self.command_transforms = [e for e in ranked if isinstance(e, CommandTransform)]
        self.curve_shapes = [e for e in ranked if isinstance(e, ThrustCurveShape)]
        self.scalings = [e for e in ranked if isinstance(e, ThrustScaling)]
        self.dynamics = [e for e in ranked if isinstance(e, ThrusterDynamics)]
        self.readers = [e for e in ranked if isinstance(e, Wrench) and e.reads()]
        # logged channels that their kernels read in addition to commands
        self.channels = tuple(dict.fromkeys(name for e in self.readers for name in e.channels))

    @cached_property
    def key(self) -> tuple:
        """Equal for paths with the same thrust at the same commands, but for loops on board."""
        mixing = [autopilot.mixer_demand(np.eye(6)).tobytes() for autopilot in self.autopilots]
        effects = (
            *self.timings,
            *self.demand_transforms,
            *self.command_transforms,
            *self.curve_shapes,
            *self.scalings,
            *self.dynamics,
        )
        reads = (bool(self.readers), *self.channels)
        return (*reads, *mixing, *((e.id, e.values.tobytes()) for e in effects))

    def effective_time(self, time: Array) -> Array:
        """Instants (m,), s, at which commands logged at `time` (m,) take effect."""
        for timing in self.timings:
            time = timing.effective_time(time)
        return time

    def columns(self, kind: CommandKind) -> int:
        """Number of columns of a logged command of this kind."""
        count = self.thrusters.count + int(self.thrusters.turning.sum()) + self.surfaces
        return count if kind == "thruster" else 6

    def thruster_commands(self, value: Array, kind: CommandKind) -> Array:
        """Thruster commands (m, n) of logged values (m, c); demands are mixed and clipped.

        Raises:
            BadInput: the number of columns does not fit the vehicle, or it cannot mix demands.
        """
        self._refuse(value, kind)
        if kind == "thruster":
            return value if value.shape[1] == self.thrusters.count else value[:, self._throttles]
        for autopilot in self.autopilots:
            value = autopilot.mixer_demand(value)
        for transform in self.demand_transforms:
            value = transform.mixer_demand(value)
        return np.clip(value @ self.thrusters.mixing.T, -1.0, 1.0)

    def steering(self, value: Array, kind: CommandKind) -> tuple[Array, Array]:
        """Azimuth angles (m, a) and surface angles (m, s), rad; zero if not logged."""
        azimuths, count = int(self.thrusters.turning.sum()), len(value)
        if kind != "thruster":
            return np.zeros((count, azimuths)), np.zeros((count, self.surfaces))
        angle_columns = self._throttles[self.thrusters.turning] + 1
        return value[:, angle_columns], value[:, self.thrusters.count + azimuths :]

    @cached_property
    def _throttles(self) -> Array:
        """Columns (n,) that hold the commands of the thrusters; an angle follows its thruster."""
        angles_before = np.cumsum(self.thrusters.turning) - self.thrusters.turning
        return np.arange(self.thrusters.count) + angles_before

    def _refuse(self, value: Array, kind: CommandKind) -> None:
        expected = self.columns(kind)
        if value.shape[1] != expected:
            kinds = "pwm or normalized" if kind == "thruster" else kind
            raise BadInput(
                f"{value.shape[1]} command columns",
                where="commands.columns in campaign.yaml",
                expected=f"{expected} for commands of the kind {kinds} on this vehicle",
                remedy="Name one column per thruster (two where it turns) and surface, or the six "
                "axes for demands.",
            )

    def static(
        self, command: Array, t: Array, duration: float, voltage: Array | None = None
    ) -> Array:
        """Static forces (m, n), N, of thruster commands (m, n) at times t (m,), s, in the run.

        `voltage` (m,) of the battery, V, if it was logged.
        """
        for transform in self.command_transforms:
            command = transform.thruster_command(command)
        force = self.thrusters.static_force(command, voltage)
        for shape in self.curve_shapes:
            force = shape.reshaped_force(force, self.full_force)
        for scaling in self.scalings:
            force = scaling.scaled_force(force, t, duration)
        return force

    @cached_property
    def full_force(self) -> Array:
        """Nominal static forces (2, n) in N at full command backwards and forwards."""
        forwards = np.ones((1, self.thrusters.count))
        return self.thrusters.static_force(np.concatenate([-forwards, forwards]))

    def respond(self, force: Array, h: float, states: list | None) -> tuple[Array, list]:
        """Dynamic mean forces (k, n) of static ones over steps of h s, and the last states."""
        last_states: list = []
        for i, effect in enumerate(self.dynamics if self.thrusters.count else ()):
            force, state = effect.respond(force, h, states[i] if states else None)
            last_states.append(state)
        return force, last_states

    def over_steps(
        self,
        commands: Commands,
        edges: Array,
        between: Between = "held",
        cuts: StepCuts | None = None,
    ) -> Thrust:
        """Mean thrust over each step between `edges` (k+1,), s on the MoCap clock.

        The first command also holds before its line, the last one after it. For held commands the
        static mean is exact, also if a line takes effect inside a step; a lag assumes it constant
        over the step. `cuts`: a cache.
        """
        start, duration = commands.recording(edges)
        arrival = start + self.effective_time(commands.time - start)  # clocks agree at the start
        lines = replace(commands, time=arrival)
        chunks = [
            edges[k : k + STEPS_PER_BATCH + 1] for k in range(0, len(edges) - 1, STEPS_PER_BATCH)
        ]
        static = Thrust.joined(
            [
                self.arrived(lines.within(e[0], e[-1]), e, start, duration, between, cuts)
                for e in chunks
            ]
        )
        force, _ = self.respond(static.force, float(edges[1] - edges[0]), None)
        return replace(static, force=force)

    def arrived(
        self,
        lines: Commands,
        edges: Array,
        start: float,
        duration: float,
        between: Between,
        cuts: StepCuts | None = None,
    ) -> Thrust:
        """Static mean thrust over each step, of lines whose time is that of taking effect.

        `start` and `duration`, s, are those of the recording; `cuts`: see `over_steps`.
        """
        steady = between == "held" and self._is_steady(lines)  # evaluate lines, not pieces
        cut = (cuts or StepCuts()).at(lines.time, edges, steady)
        if not steady:
            value = _between(lines, cut.middle, between)
            lines = replace(lines, time=cut.middle, value=value)
        return self.at(lines, start, duration).each(cut.average)

    def at(self, lines: Commands, start: float, duration: float) -> Thrust:
        """Static thrust of each line at its time.

        `start` and `duration`, s, are those of the recording.

        Raises:
            BadInput: the log lacks a channel that an effect reads, or its columns do not fit.
        """
        count = len(lines.time)
        no_demand, no_wrench = np.full((count, 6), np.nan), np.zeros((count, 6))
        if lines.kind == "wrench":
            force = np.zeros((count, self.thrusters.count))
            return Thrust(force, lines.value, no_demand, read=self._read_out(lines))
        command = self.thruster_commands(lines.value, lines.kind)
        force = self.static(command, lines.time - start, duration, _voltage(lines))
        demand = lines.value if lines.kind == "demand" else no_demand
        azimuth, angle = self.steering(lines.value, lines.kind)
        readings = self._read_out(lines, command)
        return Thrust(force, no_wrench, demand, np.cos(azimuth), np.sin(azimuth), angle, readings)

    def _read_out(self, lines: Commands, command: Array | None = None) -> Array | None:
        """Commands and angles in the order of a thruster log, then channels; None if not read.

        `command` (m, n): the thruster commands; None if a wrench is commanded.
        """
        if not self.readers:
            return None
        columns = np.zeros((len(lines.time), self.columns("thruster")))
        if lines.kind == "thruster":
            columns = lines.value
        elif command is not None:
            columns[:, self._throttles] = command
        channels = [_logged(lines, name)[:, None] for name in self.channels]
        return np.hstack([columns, *channels])

    def _is_steady(self, lines: Commands) -> bool:
        """Whether the thrust depends on the command alone: not on time, voltage or channels."""
        timed = "voltage" in lines.auxiliary or any(not s.steady for s in self.scalings)
        timed = timed or bool(self.channels)
        return len(lines.time) > 0 and not timed


def _between(lines: Commands, at: Array, between: Between) -> Array:
    """Values (n, c) of the lines at instants (n,): held or linear; zero if there are no lines."""
    if not len(lines.time):
        return np.zeros((len(at), lines.value.shape[1]))
    return lines.held_at(at) if between == "held" else lines.linear_at(at)


def _logged(lines: Commands, name: str) -> Array:
    """A channel (m,) interpolated to the times of the lines."""
    logged = lines.auxiliary.get(name)
    if logged is not None:
        return np.interp(lines.time, logged.time, logged.value)
    raise BadInput(
        f"no channel '{name}' was logged, and an effect of the model reads it",
        where="commands",
        expected=f"one of {', '.join(lines.auxiliary) or 'none that are there'}",
        remedy="Name it in commands.auxiliary of campaign.yaml.",
    )


def _voltage(lines: Commands) -> Array | None:
    """Voltage (m,) of the battery, V, at the times of the lines; None if it was not logged."""
    logged = lines.auxiliary.get("voltage")
    return None if logged is None else np.interp(lines.time, logged.time, logged.value)
