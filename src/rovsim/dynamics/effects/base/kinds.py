"""Kinds of effects by what they act on: a base class each, with the method it demands."""

from abc import abstractmethod
from collections import namedtuple
from typing import Any, ClassVar

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import Rigid
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base.effect import Effect, Requirement
from rovsim.dynamics.effects.base.kernels import mentions
from rovsim.dynamics.engine.types import At, Vector6


class Coefficients(Effect):
    """An effect on the constants of Fossen's equation: inertia, damping, buoyancy, current, …"""

    @abstractmethod
    def enter(self, body: Body) -> None:
        """Add this effect's contribution to the constants of the body, in place."""


class Wrench(Effect):
    """An effect that pushes the vehicle: a wrench that depends on the state and on time.

    Its kernel (`wrench`) or a helper may also use `at.actuators`, the forces, commands and inflow
    of the actuators, and `at.channels.NAME`, channels that were logged beside the commands and are
    declared in `channels` (see `rovsim.dynamics.engine.kernel_inputs`).
    """

    channels: ClassVar[tuple[str, ...]] = ()

    @staticmethod
    @abstractmethod
    def wrench(at: At, p: Any) -> Vector6:
        """Wrench on the vehicle at CO, FRD, N and N m. Compiled: plain arithmetic on floats.

        `p` has the parameters by name.
        """

    @classmethod
    def named_parameters(cls) -> type:
        """The named tuple type in which the compiled kernel gets its parameters."""
        return namedtuple(f"{cls.__name__}Parameters", [p.name for p in cls.parameters])

    @classmethod
    def named_channels(cls) -> type:
        """The named tuple type in which the compiled kernel gets its channels."""
        return namedtuple(f"{cls.__name__}Channels", cls.channels)

    @classmethod
    def example_channels(cls) -> Any:
        """Channels to compile and try the kernel with; 0.0, as in an engine, where it has none."""
        return cls.named_channels()(*(1.0 for _ in cls.channels)) if cls.channels else 0.0

    @classmethod
    def reads(cls) -> bool:
        """Whether its kernel, or a helper that it calls, reads actuators or channels."""
        return bool(cls.channels) or mentions(cls.wrench, "actuators")


class StochasticCurrent(Effect):
    """Random motion of the water. The synthetic tank draws it; a model has its mean, zero."""

    @abstractmethod
    def draw(self, ticks: int, dt: float, random: np.random.Generator) -> Array:
        """Current (ticks, 3) in NED, m/s, to add during each of the time steps of dt s."""


class CommandTiming(Effect):
    """An effect on the instants at which logged commands take effect."""

    requires: ClassVar[Requirement] = "commands"

    @abstractmethod
    def effective_time(self, time: Array) -> Array:
        """Instants (m,), s, increasing, at which the commands logged at `time` (m,) take effect."""


class DemandTransform(Effect):
    """An effect on the pilot's demands before the mixer."""

    requires = "demands"

    @abstractmethod
    def mixer_demand(self, demand: Array) -> Array:
        """Demands (m, 6) that the mixer gets, of logged ones (m, 6)."""


class Autopilot(Effect):
    """A control loop on some axes, whose demands then do not reach the mixer."""

    requires = "demands"

    @abstractmethod
    def mixer_demand(self, demand: Array) -> Array:
        """Demands (m, 6) in [-1, 1] for the mixer: 0 for axes of the loop."""

    @abstractmethod
    def demanded_wrench(self, demand: Array, inertia: Array) -> Array:
        """Wrench (m, 6) in response to demands (m, 6); `inertia` (6,) is the diagonal of M.

        The feedback of the loop, its response to the motion, is the effect's `wrench`.
        """


class CommandTransform(Effect):
    """An effect on the thruster commands before the force curve."""

    requires = "thrusters"

    @abstractmethod
    def thruster_command(self, command: Array) -> Array:
        """Commands (m, n) in [-1, 1] of n thrusters, for the force curve."""


class ThrustCurveShape(Effect):
    """An effect on the shape of the static force curve."""

    requires = "thrusters"

    @abstractmethod
    def reshaped_force(self, force: Array, full: Array) -> Array:
        """Forces (m, n), N, of nominal ones; `full` (2, n): at full command, back and ahead."""


class ThrustScaling(Effect):
    """An effect on the static force after the force curve; `steady`: it does not depend on time."""

    steady = False

    requires = "thrusters"

    @abstractmethod
    def scaled_force(self, force: Array, t: Array, duration: float) -> Array:
        """Forces (m, n), N, at times t (m,), s since the start of a recording of `duration` s."""


class ThrusterDynamics(Effect):
    """An effect on the dynamics of the thruster force, after the static force."""

    requires = "thrusters"

    @abstractmethod
    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """Mean forces (k, n), N, over steps of h s, and the state after the last step.

        `force` (k, n): static mean forces. `state`: from an earlier call; None: steady at force[0].
        """


class FrameMisalignment(Effect):
    """An effect on the frames in which the motion capture reports a motion, not on the motion."""

    @abstractmethod
    def transforms(self) -> tuple[Rigid, Rigid]:
        """Transforms (world, body): measured pose = world o true pose o body."""


class MeasurementFilter(Effect):
    """A low-pass on the poses that the motion capture reports, after all `FrameMisalignment`."""

    @abstractmethod
    def time_constants(self) -> tuple[float, ...]:
        """Time constants, s, of first-order low-passes in series; empty: no filter."""
