"""The constants of Fossen's equation: summed up by effects, then packed for the engine."""

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
    """Constants of the equation of motion; empty, in still water, until effects add to them.

    SI units, body axes FRD at CO.

    Attributes:
        gravity: m/s2.
        M_RB: (6, 6) rigid-body inertia.
        M_A: (6, 6) added mass.
        linear: (6,) linear damping, positive = drag, N s/m and N m s/rad.
        quadratic: (6,) quadratic damping, positive = drag, N s2/m2 and N m s2/rad2.
        weight: N.
        weight_moment: (3,) sum of each weight times its place, N m.
        buoyancy: N.
        center_of_buoyancy: (3,) m.
        current: (3,) velocity of the water in NED, m/s.
        B: (6, n) allocation: wrench per force of each thruster component.
        directions: (n, 3) of positive thrust.
        spin: (n,) sign of the reaction moment of each propeller.
        advance: relative loss of thrust per inflow velocity, s/m.
        coupling: (2, 6, 6) linear and quadratic damping of an axis (row) by motion along another
            (column); walls do not change it.
        memory: (6,) force per remembered velocity, N s/m and N m s/rad.
        memory_decay: 1 / time constant of the fluid memory, 1/s; 0: no memory.
        memories: number of effects that added a fluid memory.
        waterplane: (3,) stiffness in heave N/m, roll and pitch N m/rad.
        products: (t,) coefficients of forces that are products of velocities.
        factors: (t, 4) for each product, the axis of the force and up to three velocities: i for
            the velocity of axis i, 6 + i for its absolute value, -1 for none.
        surfaces: (s, 15) control surfaces, with the columns of `engine.types`.
        lifting: (s,) factor on the lift of each surface.
        free: (6,) whether an axis moves; otherwise it is held at rest.
        places: (n + s, 3) of thrusters, then surfaces, m.
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
        """Add a mass, kg, at a place (3,), m, with its own inertia (3, 3), and its weight."""
        self.M_RB += inertia_at(mass, place, inertia)
        self.weight += mass * self.gravity
        self.weight_moment += mass * self.gravity * place

    def remember(self, memory: Array, time_constant: float) -> None:
        """Add a fluid memory: water that follows the vehicle late, and then goes on pushing it.

        The wrench is c (mu - nu_r), where mu is nu_r low-passed with the time constant. The part
        -c nu_r is linear damping that walls do not change; the engine adds c mu. A body has at most
        one fluid memory.

        Args:
            memory: c (6,), N s/m and N m s/rad.
            time_constant: of the low-pass, s.
        """
        self.memories += 1
        self.memory, self.memory_decay = memory, 1.0 / time_constant
        self.coupling[0] += np.diag(memory)

    @property
    def possible(self) -> bool:
        """Whether M is positive definite, and there is at most one fluid memory."""
        return self.least_inertia > 0.0 and self.memories <= 1

    @property
    def least_inertia(self) -> float:
        """Smallest eigenvalue of M of the axes that move: positive if such a body can exist."""
        M = (self.M_RB + self.M_A)[np.ix_(self.free, self.free)]
        symmetric = 0.5 * (M + M.T)
        if not np.isfinite(symmetric).all():  # the sum of two very large numbers overflows
            return -inf
        return float(np.linalg.eigvalsh(symmetric)[0])

    @property
    def M(self) -> Array:
        """Total inertia M_RB + M_A (6, 6).

        Raises:
            BadInput: M is not positive definite, or there is more than one fluid memory.
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
        """Inverse of M for the axes that move (6, 6); zero in rows and columns of held axes.

        Raises:
            BadInput: see `M`.
        """
        if self.free.all():
            return np.linalg.inv(self.M)
        moving, inverse = np.ix_(self.free, self.free), np.zeros((6, 6))
        inverse[moving] = np.linalg.inv(self.M[moving])
        return inverse

    @property
    def stated(self) -> dict[str, Array]:
        """Diagonal coefficients (6,), by the id of the effect whose parameters change them."""
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
    """Pack a body into the constants of the engine, as a single parameter set (m = 1)."""

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
