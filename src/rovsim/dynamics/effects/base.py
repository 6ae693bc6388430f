"""What an effect is: one declaration that simulates, fits, is reported and documented.

An effect is a subclass of one of the classes below, which says on what it acts, and implements the
method of that class. Effects are immutable, and a model is a list of them.

    base class         acts on                               method
    Coefficients       the constants of Fossen's equation    enter(body)
    Wrench             the forces at one instant (compiled)  wrench(at, p) -> 6 numbers
    StochasticCurrent  the water, at random                  draw(ticks, dt, random) -> current
    CommandTiming      when a logged command takes effect    effective_time(time) -> time
    DemandTransform    the demand before the mixer           mixer_demand(demand) -> demand
    Autopilot          demands in place of the mixer         mixer_demand(demand) -> demand;
                                                             demanded_wrench(...) -> wrench
    CommandTransform   the thruster command                  thruster_command(command) -> command
    ThrustCurveShape   the shape of the static force curve   reshaped_force(force, full) -> force
    ThrustScaling      the static thruster force             scaled_force(force, t, ...) -> force
    ThrusterDynamics   the dynamic thruster force            respond(force, h, state) -> ...
    FrameMisalignment  what the motion capture reports       transforms() -> two rigid transforms
    MeasurementFilter  what its software makes of that       time_constants() -> of low-passes
"""

from abc import ABC, abstractmethod
from collections import namedtuple
from copy import copy
from typing import Any, ClassVar, Literal, Mapping, Protocol, Self

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, unlisted
from rovsim.core.rotations import Rigid
from rovsim.core.run import CommandKind, Site
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.kernels import says
from rovsim.dynamics.effects.parameters import Parameter, Signature
from rovsim.dynamics.engine.types import At, Vector6

Requirement = Literal["nothing", "commands", "demands", "thrusters", "surfaces", "waterplane"]


class Actuated(Protocol):
    """What effects need to know of a vehicle: its mass, its thrusters and its control surfaces."""

    @property
    def dry_mass(self) -> float:
        """Dry mass, kg: without the water inside the vehicle."""

    @property
    def thruster_count(self) -> int:
        """Number of thrusters."""

    @property
    def thruster_names(self) -> tuple[str, ...]:
        """Names of the thrusters, in the vehicle file's order."""

    @property
    def surface_names(self) -> tuple[str, ...]:
        """Names of the control surfaces, in the vehicle file's order."""


class Effect(ABC):
    """A physical effect with values for its parameters; a value not given is the default.

    Raises:
        BadInput: an unknown parameter, or a value that is not a number or is out of range.
    """

    id: ClassVar[str]
    equation: ClassVar[str]
    symbols: ClassVar[tuple[tuple[str, str], ...]] = ()  # (LaTeX, meaning); no parameters
    neglects: ClassVar[str]
    source: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]
    starts: ClassVar[tuple[dict[str, float], ...]] = ({},)  # where fits begin; {} = the defaults
    cause: ClassVar[str] = ""  # what in a laboratory makes it act, one sentence
    revealed_by: ClassVar[str] = ""  # what to record to confirm it, one sentence
    telling: ClassVar[tuple[str, ...]] = ()  # that show the effect in a run; (): any of them
    signature: ClassVar[Signature | None] = None  # how the catalogue page shows it
    listed: ClassVar[bool] = True  # False: part of every vehicle, not for the catalogue
    rank: ClassVar[int] = 0  # order among the effects of one kind along the thrust path
    requires: ClassVar[Requirement] = "nothing"  # a run without it cannot show the effect

    def __init__(self, **values: float) -> None:
        names = [p.name for p in self.parameters]
        for name in values:
            if name not in names:
                raise unlisted(
                    name, names, found=f"unknown parameter '{name}'", where=f"effect {self.id}"
                )
        numbers = [
            self._checked(p, values[p.name]) if p.name in values else p.default
            for p in self.parameters
        ]
        self.values: Array = np.array(numbers, dtype=float)
        self.values.setflags(write=False)
        self.std: Mapping[str, float] = {}  # standard deviations of fitted values

    def _checked(self, parameter: Parameter, value: Any) -> float:
        is_number = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
        if is_number and parameter.low <= value <= parameter.high and np.isfinite(value):
            return float(value)
        raise BadInput(
            f"{parameter.name} is {value!r}",
            where=f"effect {self.id}",
            expected=f"a number from {parameter.low:g} to {parameter.high:g} {parameter.unit}",
            remedy="Correct that value.",
        )

    def __getitem__(self, name: str) -> float:
        return float(self.values[[p.name for p in self.parameters].index(name)])

    def __repr__(self) -> str:
        arguments = ", ".join(f"{k}={v:g}" for k, v in self.given().items())
        return f"{type(self).__name__}({arguments})"

    def given(self) -> dict[str, float]:
        """The values that differ from their default, by name."""
        return {
            p.name: float(v)
            for p, v in zip(self.parameters, self.values, strict=True)
            if v != p.default and np.isfinite(v)
        }

    def with_values(self, values: Mapping[str, float]) -> "Effect":
        """The same effect with some values replaced, and no standard deviations."""
        return type(self)(**self.given() | dict(values))

    def neutral(self) -> "Effect":
        """The effect at its defaults, which change nothing; unless it is not `listed`: itself."""
        return type(self)() if self.listed else self

    def with_std(self, std: Mapping[str, float]) -> "Effect":
        """The same effect with the standard deviations of its fitted values."""
        effect = copy(self)
        effect.std = dict(std)
        return effect

    @classmethod
    def starts_at(cls, site: Site) -> tuple[dict[str, float], ...]:
        """Initial values of fits at this site; several where the likelihood is flat at neutral."""
        return cls.starts

    @classmethod
    def on(cls, vehicle: Actuated) -> "type[Effect]":
        """The same effect with the parameters and starts that it has on a vehicle."""
        return cls

    @classmethod
    def adapted(cls, **own: Any) -> type[Self]:
        """A subclass with other class attributes, such as parameters, for `on` to return."""
        attributes = {"__doc__": cls.__doc__, "__module__": cls.__module__}
        return type(cls.__name__, (cls,), attributes | own)

    @classmethod
    def free_at(cls, start: Mapping[str, float]) -> tuple[str, ...]:
        """Names of the parameters that a fit from these initial values may change."""
        return tuple(p.name for p in cls.parameters if p.fitted)

    def check(self, site: Site, kind: CommandKind) -> None:  # noqa: B027 - most need nothing
        """Refuse a run that lacks what this effect needs.

        Raises:
            BadInput: no tank is known, or the commands are of another kind.
        """

    def needs_duration(self) -> bool:
        """Whether its values refer to the duration of a run, which then must be known."""
        return False


class Coefficients(Effect):
    """An effect on the constants of Fossen's equation: inertia, damping, buoyancy, current, …"""

    @abstractmethod
    def enter(self, body: Body) -> None:
        """Add this effect's contribution to the constants of the body, in place."""


class Wrench(Effect):
    """An effect that pushes the vehicle: a wrench that depends on the state and on time.

    Its kernel (`wrench`) or a helper may also use `at.actuators`, the forces, commands and inflow
    of the actuators, and `at.channels.NAME`, channels that were logged beside the commands and are
    declared in `channels` (see `rovsim.dynamics.engine.reading`).
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
        return bool(cls.channels) or says(cls.wrench, "actuators")


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
