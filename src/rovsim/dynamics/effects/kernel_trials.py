"""The kernel of somebody's own effect, tried at many instants before an engine calls it.

Compiled code reads and writes beyond an array without a word, and an error in it ends nothing: the
engine prints it at every step and goes on. So both must show here.
"""

from functools import cache
from typing import Any, Iterator, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import matrix, normalized
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.effects.kernels import compiled_alone
from rovsim.dynamics.engine.types import EXAMPLE, At

INSTANTS = 100  # at which kernels are tried
FASTEST = 2.0  # m/s and rad/s there
LONGEST = 60.0  # s of a recording
STRONGEST = 50.0  # N of a thruster
BEYOND = 512  # numbers before and after those of the actuators, of which nothing may depend


class Actuating(NamedTuple):
    """How many actuators of each kind a vehicle has."""

    forces: int
    commands: int
    surfaces: int

    @property
    def places(self) -> int:
        """Where the velocity through the water is known."""
        return self.forces + self.surfaces

    @property
    def told(self) -> str:
        """What a kernel may read of them."""
        return (
            f"indices within the actuators of this vehicle: {self.forces} forces, {self.commands} "
            f"commands, inflow at {self.places} places, three numbers each; nothing is written"
        )


def largest_push(e: Wrench, there: Actuating) -> float:
    """Size of the largest number that a kernel returns, N or N m; what is no number is left out.

    Raises:
        IndexError: it reads an actuator that is not there.
        ValueError: it writes where it may only read.
    """
    cls = type(e)
    kernel, p = compiled_alone(cls), cls.named_parameters()(*map(float, e.values))
    pushes = [_push(kernel, at, p) for at in _instants(cls, there)]
    return float(np.max(np.abs(pushes), initial=0.0, where=np.isfinite(pushes)))


def _push(kernel: Any, readings: "Sequence[_Reading]", p: Any) -> tuple[float, ...]:
    """What a kernel returns at an instant, whatever lies beside what it may read."""
    made = []
    for reading in readings:
        before = [memory.copy() for memory in reading.memories]
        made.append(kernel(reading.at, p))
        pairs = zip(before, reading.memories, strict=True)
        if not all(np.array_equal(a, b, equal_nan=True) for a, b in pairs):
            raise ValueError("it writes into at.actuators")
    if not all(np.array_equal(made[0], one, equal_nan=True) for one in made):
        raise IndexError("no such actuator")
    return tuple(made[0])


class _Reading(NamedTuple):
    """An instant as a kernel reads it, and the memory in which its actuators lie."""

    at: Any
    memories: Sequence[Array]


def _instants(cls: type[Wrench], there: Actuating) -> Iterator[Sequence[_Reading]]:
    """Instants, each with other numbers beside its actuators where a kernel reads these."""
    random = np.random.default_rng(0)
    for at in _states():
        if not cls.reads():
            yield [_Reading(at, ())]
            continue
        acting = random.uniform(-1.0, 1.0, (5, max(there.places, there.commands)))
        logged = random.uniform(0.0, 20.0, len(cls.channels))
        channels = cls.named_channels()(*logged.tolist()) if cls.channels else 0.0
        yield [_read(at, acting, channels, there, beyond) for beyond in (np.nan, -1e9, 1e9)]


@cache
def _states() -> tuple[At, ...]:
    """At rest, at rest in no known tank and without demands, and moving anywhere in a tank."""
    unknown = (float("nan"),) * 2
    lost = EXAMPLE._replace(tank=(unknown,) * 3, demand=(float("nan"),) * 6)
    random = np.random.default_rng(1)
    return EXAMPLE, lost, *(_moving(EXAMPLE, random) for _ in range(INSTANTS))


def _moving(rest: At, random: np.random.Generator) -> At:
    nu, water = random.uniform(-FASTEST, FASTEST, (2, 6))
    R: Any = tuple(map(tuple, matrix(normalized(random.normal(size=4))).tolist()))
    return rest._replace(
        t=float(random.uniform(0.0, LONGEST)),
        duration=LONGEST,
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
    """`acting` (5, k): forces in shares of a strong one, commands, and inflow (3, k) in m/s."""
    from rovsim.dynamics.engine.reading import Actuators, ReadingAt

    force = STRONGEST * acting[0, : there.forces]
    inflow = np.ascontiguousarray(acting[2:, : there.places].T)
    own = [force, acting[1, : there.commands], inflow]
    memories = [_surrounded(values, beyond) for values in own]
    actuators = Actuators(*[m[BEYOND : len(m) - BEYOND] for m in memories])
    return _Reading(ReadingAt(*at, actuators, channels), memories)


def _surrounded(values: Array, beyond: float) -> Array:
    """The same values in a memory that holds something else before and after them."""
    memory = np.full((BEYOND + len(values) + BEYOND, *values.shape[1:]), beyond)
    memory[BEYOND : BEYOND + len(values)] = values
    return memory
