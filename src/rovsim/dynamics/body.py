"""The constants of Fossen's equation, filled in by effects, then packed for the engine."""

from dataclasses import dataclass, field
from math import inf

import numpy as np
from numpy import ndarray as Array
from numpy.typing import ArrayLike

from rovsim.core.errors import BadInput
from rovsim.dynamics.engine.types import Constants


def cross_matrix(r: Array) -> Array:
    """S(r) with S(r) x = r x x (Fossen 2021, eq. 2.10)."""
    x, y, z = r
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def inertia_at(mass: float, r: Array, inertia: Array) -> Array:
    """Inertia (6, 6) at CO of a mass at r with its own inertia (3, 3) (Fossen 2021, eq. 3.49)."""
    S = cross_matrix(r)
    top = np.hstack([mass * np.eye(3), -mass * S])
    return np.vstack([top, np.hstack([mass * S, inertia - mass * S @ S])])


@dataclass
class Body:
    """An empty body in still water; effects add to it.

    SI, FRD at CO: `M_RB`, `M_A` (6, 6); `linear`, `quadratic` (6,) damping, positive = drag;
    `weight` N and `weight_moment` (3,) sum of weight times place, N m; `buoyancy` N at
    `center_of_buoyancy` (3,) m; `current` (3,) m/s NED; `B` (6, n) wrench per thruster force and
    `directions` (n, 3); `spin` (n,) sign of the reaction moment; `advance` s/m; `coupling`
    (2, 6, 6) linear and quadratic damping of an axis (row) by motion along another (column), never
    changed by walls; `memory` (6,) force per remembered velocity; `memory_decay` 1/s, 0: none;
    `memories`: so many effects gave one; `waterplane` (3,) stiffness N/m, N m/rad in heave, roll,
    pitch; `products` (t,) coefficients of products of velocities, `factors` (t, 4) axis of the
    force and up to three velocities: i, 6 + i for its size, -1 for none; `surfaces` (s, 15) with
    the columns of `engine.types`, `lifting` (s,) factor on the lift of each; `free` (6,) axes that
    move; `places` (n + s, 3) m of thrusters, then surfaces.
    """

    gravity: float
    M_RB: Array = field(default_factory=lambda: np.zeros((6, 6)))
    M_A: Array = field(default_factory=lambda: np.zeros((6, 6)))
    linear: Array = field(default_factory=lambda: np.zeros(6))
    quadratic: Array = field(default_factory=lambda: np.zeros(6))
    weight: float = 0.0
    weight_moment: Array = field(default_factory=lambda: np.zeros(3))
    buoyancy: float = 0.0
    center_of_buoyancy: Array = field(default_factory=lambda: np.zeros(3))
    current: Array = field(default_factory=lambda: np.zeros(3))
    B: Array = field(default_factory=lambda: np.zeros((6, 0)))
    directions: Array = field(default_factory=lambda: np.zeros((0, 3)))
    spin: Array = field(default_factory=lambda: np.zeros(0))
    advance: float = 0.0
    coupling: Array = field(default_factory=lambda: np.zeros((2, 6, 6)))
    memory: Array = field(default_factory=lambda: np.zeros(6))
    memory_decay: float = 0.0
    memories: int = 0
    waterplane: Array = field(default_factory=lambda: np.zeros(3))
    products: Array = field(default_factory=lambda: np.zeros(0))
    factors: Array = field(default_factory=lambda: np.zeros((0, 4), np.int64))
    surfaces: Array = field(default_factory=lambda: np.zeros((0, 15)))
    lifting: Array = field(default_factory=lambda: np.zeros(0))
    free: Array = field(default_factory=lambda: np.ones(6, bool))
    places: Array = field(default_factory=lambda: np.zeros((0, 3)))

    def add_mass(self, mass: float, place: Array, inertia: Array) -> None:
        """Add a mass in kg at a place (3,), with its own inertia (3, 3), and its weight."""
        self.M_RB += inertia_at(mass, place, inertia)
        self.weight += mass * self.gravity
        self.weight_moment += mass * self.gravity * place

    def remember(self, memory: Array, time_constant: float) -> None:
        """Water that follows the vehicle within a time constant in s, and goes on pushing.

        -c nu_r, with `memory` c (6,) in N s/m and N m s/rad, is linear damping that no wall
        changes; the engine adds c times what is remembered. A body has at most one.
        """
        self.memories += 1
        self.memory, self.memory_decay = memory, 1.0 / time_constant
        self.coupling[0] += np.diag(memory)

    @property
    def possible(self) -> bool:
        """Whether there can be such a body, and the engine can hold it."""
        return self.least_inertia > 0.0 and self.memories <= 1

    @property
    def least_inertia(self) -> float:
        """Smallest eigenvalue of the inertia that moves: positive if such a body can exist."""
        M = (self.M_RB + self.M_A)[np.ix_(self.free, self.free)]
        symmetric = 0.5 * (M + M.T)
        if not np.isfinite(symmetric).all():  # two numbers near the largest have no sum
            return -inf
        return float(np.linalg.eigvalsh(symmetric)[0])

    @property
    def M(self) -> Array:
        """Total inertia (6, 6).

        Raises:
            BadInput: it is not positive definite, so no such body exists; or it has two memories.
        """
        if self.memories > 1:
            raise BadInput(
                f"{self.memories} effects with a fluid memory",
                where="model",
                expected="at most one",
                remedy="Keep one of them.",
            )
        M, lowest = self.M_RB + self.M_A, self.least_inertia
        if lowest > 0:
            return M
        raise BadInput(
            f"the inertia matrix has the eigenvalue {lowest:.3g}",
            where="model",
            expected="a positive definite M = M_RB + M_A",
            remedy="Check the mass, inertia and added mass (all positive), and their changes.",
        )

    @property
    def M_inv(self) -> Array:
        """Acceleration per force (6, 6): its inverse; zero where an axis is held.

        Raises:
            BadInput: no such body exists.
        """
        if self.free.all():
            return np.linalg.inv(self.M)
        moving, found = np.ix_(self.free, self.free), np.zeros((6, 6))
        found[moving] = np.linalg.inv(self.M[moving])
        return found

    @property
    def stated(self) -> dict[str, Array]:
        """Coefficients (6,) of the vehicle file, by the effect whose values are changes of them."""
        return {
            "linear_damping": self.linear,
            "quadratic_damping": self.quadratic,
            "added_mass": np.diag(self.M_A),
        }

    @property
    def has_uncommon_forces(self) -> bool:
        """Whether it has a waterplane, products of velocities or surfaces."""
        return bool(self.waterplane.any() or self.products.size or self.lifting.size)


def packed(body: Body) -> Constants:
    """Constants of one parameter set for the engine."""

    def alone(value: ArrayLike) -> Array:
        return np.array([value], dtype=float)

    return Constants(
        M_RB=alone(body.M_RB),
        M_A=alone(body.M_A),
        M_inv=alone(body.M_inv),
        linear=alone(body.linear),
        quadratic=alone(body.quadratic),
        net_weight=alone(body.weight - body.buoyancy),
        restoring_lever=alone(body.weight_moment - body.buoyancy * body.center_of_buoyancy),
        current=alone(body.current),
        advance=alone(body.advance),
        coupled=alone(np.any(body.coupling)),
        coupling=alone(body.coupling),
        memory=alone(body.memory),
        memory_decay=alone(body.memory_decay),
        B=alone(body.B),
        directions=np.ascontiguousarray(body.directions, dtype=float),
        uncommon=alone(body.has_uncommon_forces),
        waterplane=alone(body.waterplane),
        products=alone(body.products),
        factors=np.ascontiguousarray(body.factors),
        surfaces=np.ascontiguousarray(body.surfaces),
        lifting=alone(body.lifting),
        free=alone(body.free),
        places=np.ascontiguousarray(body.places, dtype=float),
    )
