"""Try the kernel of a user's effect at many instants before an engine calls it.

Compiled code reads and writes out of the bounds of an array without an error, and an exception in
it does not end a simulation: the engine prints it at every step and continues. So both must be
found here.
"""

from functools import cache
from typing import Any, Iterator, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import matrix, normalized
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.effects.base.kernels import compiled_alone
from rovsim.dynamics.engine.types import EXAMPLE, At

INSTANTS_TRIED = 100  # number of random instants that kernels are tried at
MAX_SPEED = 2.0  # m/s and rad/s: largest velocity at these instants
DURATION_SECONDS = 60.0  # s of a recording
MAX_THRUST_N = 50.0  # N of a thruster
GUARD_SIZE = 512  # numbers before and after the actuators' arrays, which a kernel must not read


class Actuating(NamedTuple):
    """How many actuators of each kind a vehicle has."""

    forces: int
    commands: int
    surfaces: int

    @property
    def places(self) -> int:
        """Number of places with an inflow velocity: thrusters and control surfaces."""
        return self.forces + self.surfaces

    @property
    def description(self) -> str:
        """What a kernel may read of the actuators, in words for messages."""
        return (
            f"indices within the actuators of this vehicle: {self.forces} forces, {self.commands} "
            f"commands, inflow at {self.places} places, three numbers each; nothing is written"
        )


def largest_wrench(e: Wrench, there: Actuating) -> float:
    """Largest absolute value that a kernel returns at any instant, N or N m, but for NaN.

    Raises:
        IndexError: the kernel reads an actuator that does not exist.
        ValueError: the kernel writes to the arrays of the actuators.
    """
    cls = type(e)
    kernel, p = compiled_alone(cls), cls.named_parameters()(*map(float, e.values))
    wrenches = [_evaluate_wrench(kernel, at, p) for at in _instants(cls, there)]
    return float(np.max(np.abs(wrenches), initial=0.0, where=np.isfinite(wrenches)))


def _evaluate_wrench(kernel: Any, readings: "Sequence[_Reading]", p: Any) -> tuple[float, ...]:
    """The wrench at one instant; `readings` differ only in what is beyond the actuators' arrays."""
    wrenches = []
    for reading in readings:
        copies = [memory.copy() for memory in reading.memories]
        wrenches.append(kernel(reading.at, p))
        pairs = zip(copies, reading.memories, strict=True)
        if not all(np.array_equal(a, b, equal_nan=True) for a, b in pairs):
            raise ValueError("it writes into at.actuators")
    if not all(np.array_equal(wrenches[0], wrench, equal_nan=True) for wrench in wrenches):
        raise IndexError("no such actuator")
    return tuple(wrenches[0])


class _Reading(NamedTuple):
    """An instant as a kernel reads it, and the arrays that contain those of its actuators."""

    at: Any
    memories: Sequence[Array]


def _instants(cls: type[Wrench], there: Actuating) -> Iterator[Sequence[_Reading]]:
    """Yield instants; if the kernel reads actuators, each with three fillings of the margins."""
    random = np.random.default_rng(0)
    for at in _states():
        if not cls.reads():
            yield [_Reading(at, ())]
            continue
        columns = random.uniform(-1.0, 1.0, (5, max(there.places, there.commands)))
        logged = random.uniform(0.0, 20.0, len(cls.channels))
        channels = cls.named_channels()(*logged.tolist()) if cls.channels else 0.0
        yield [_read(at, columns, channels, there, filling) for filling in (np.nan, -1e9, 1e9)]


@cache
def _states() -> tuple[At, ...]:
    """Instants at rest, at rest with unknown walls and demands, and at random in a tank."""
    unknown = (float("nan"),) * 2
    unmeasured = EXAMPLE._replace(tank=(unknown,) * 3, demand=(float("nan"),) * 6)
    random = np.random.default_rng(1)
    return EXAMPLE, unmeasured, *(_moving(EXAMPLE, random) for _ in range(INSTANTS_TRIED))


def _moving(rest: At, random: np.random.Generator) -> At:
    nu, water = random.uniform(-MAX_SPEED, MAX_SPEED, (2, 6))
    R: Any = tuple(map(tuple, matrix(normalized(random.normal(size=4))).tolist()))
    return rest._replace(
        t=float(random.uniform(0.0, DURATION_SECONDS)),
        duration=DURATION_SECONDS,
        position=tuple(random.uniform(-1.0, 1.0, 3).tolist()),
        R=R,
        nu=tuple(nu.tolist()),
        nu_r=(*(nu - 0.2 * water)[:3].tolist(), *nu[3:].tolist()),
        nu_c_dot=(*(0.1 * water)[:3].tolist(), 0.0, 0.0, 0.0),
        drag=tuple((-20.0 * nu).tolist()),
        inertia=(20.0, 20.0, 20.0, 0.5, 0.5, 0.5),
        demand=tuple(random.uniform(-1.0, 1.0, 6).tolist()),
    )


def _read(at: At, acting: Array, channels: Any, there: Actuating, beyond: float) -> _Reading:
    """An instant with actuators of `acting` (5, k): forces / MAX_THRUST_N, commands, inflow."""
    from rovsim.dynamics.engine.kernel_inputs import Actuators, ReadingAt

    force = MAX_THRUST_N * acting[0, : there.forces]
    inflow = np.ascontiguousarray(acting[2:, : there.places].T)
    arrays = [force, acting[1, : there.commands], inflow]
    memories = [_surrounded(values, beyond) for values in arrays]
    actuators = Actuators(*[m[GUARD_SIZE : len(m) - GUARD_SIZE] for m in memories])
    return _Reading(ReadingAt(*at, actuators, channels), memories)


def _surrounded(values: Array, beyond: float) -> Array:
    """An array with the values in the middle, and `beyond` before and after them."""
    memory = np.full((GUARD_SIZE + len(values) + GUARD_SIZE, *values.shape[1:]), beyond)
    memory[GUARD_SIZE : GUARD_SIZE + len(values)] = values
    return memory
