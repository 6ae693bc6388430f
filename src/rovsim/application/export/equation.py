"""The equation of motion of a model as numbers, for those who write it in another language.

    M_RB nu_dot + C_RB(nu) nu + M_A nu_r_dot + C_A(nu_r) nu_r + D(nu_r) nu_r + g(R) = tau

SI, FRD at CO, world NED (Fossen 2021, eq. 6.1, 10.135); C nu follows from M (eq. 6.43).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core.axes import FORCE, VELOCITY
from rovsim.dynamics.body import Body, cross_matrix
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.dynamics.effects.damping import CubicDamping
from rovsim.dynamics.effects.dry_friction import DryFriction
from rovsim.dynamics.effects.force_curve import CurveExponent
from rovsim.dynamics.effects.lift import Lift
from rovsim.dynamics.effects.thruster_order import ThrusterOrder
from rovsim.dynamics.effects.thrusters import ThrustAsymmetry, ThrusterDeadband, ThrusterGain
from rovsim.dynamics.model import Model
from rovsim.dynamics.vehicle.cross_flow import CrossFlow
from rovsim.dynamics.vehicle.curves import ForceCurve

E = TypeVar("E", bound=Effect)


@dataclass(frozen=True, eq=False)
class RigidInertia:
    """A rigid body: `mass` kg, `center` (3,) m of gravity, `inertia` (3, 3) kg m2 about it."""

    mass: float
    center: Array
    inertia: Array

    @staticmethod
    def of(M: Array) -> "RigidInertia":
        """Of its inertia (6, 6) at CO (Fossen 2021, eq. 3.49)."""
        mass = float(M[0, 0])
        center = np.array([M[2, 4], M[0, 5], M[1, 3]]) * [-1.0, -1.0, -1.0] / mass
        S = cross_matrix(center)
        return RigidInertia(mass, center, M[3:, 3:] + mass * S @ S)


@dataclass(frozen=True, eq=False)
class Equation:
    """What stands in the equation of motion of a model whose effects are all held."""

    model: Model

    @property
    def body(self) -> Body:
        """The constants."""
        return self.model.body

    @cached_property
    def rigid(self) -> RigidInertia:
        """The dry vehicle with what it carries."""
        return RigidInertia.of(self.body.M_RB)

    @property
    def linear(self) -> Array:
        """Linear damping (6, 6): tau_i = -sum_j D_ij nu_r,j."""
        return np.diag(self.body.linear) + self.body.coupling[0]

    @property
    def quadratic(self) -> Array:
        """Quadratic damping (6, 6): tau_i = -sum_j D_ij |nu_r,j| nu_r,j."""
        return np.diag(self.body.quadratic) + self.body.coupling[1]

    @cached_property
    def products(self) -> dict[str, float]:
        """Coefficients of products of velocities under their SNAME names, as in vehicle files."""
        found: dict[str, float] = {}
        for flow in self._those(CrossFlow):
            found |= {name: found.get(name, 0.0) + c for name, c in flow.products.items()}
        for lift in self._those(Lift):
            for name in ("Y|u|v", "Z|u|w"):
                found[name] = found.get(name, 0.0) - lift["coefficient"]
        for cubic in self._those(CubicDamping):
            for axis, force, v in zip(AXES, FORCE, VELOCITY, strict=True):
                found[f"{force}{3 * v}"] = found.get(f"{force}{3 * v}", 0.0) - cubic[axis]
        return {name: c for name, c in found.items() if c}

    @property
    def constant(self) -> Array:
        """A wrench (6,) that is always there, N and N m."""
        return sum((e.values for e in self._those(ConstantWrench)), np.zeros(6))

    @property
    def friction(self) -> Array:
        """Dry friction (6,): tau_i = -c_i tanh(nu_r,i / 0.01)."""
        return sum((e.values for e in self._those(DryFriction)), np.zeros(6))

    @property
    def names(self) -> list[str]:
        """Of the thrusters, in the vehicle file's order."""
        return [unit.name for unit in self.model.vehicle.thrusters.units]

    @property
    def columns(self) -> Array:
        """Which command (n,), counted from 0, each thruster follows."""
        order = np.arange(self.model.thrust_path.thrusters.count)[None]
        for swapped in self._those(ThrusterOrder):
            order = swapped.thruster_command(order)
        return np.asarray(order[0], dtype=int)

    @property
    def deadband(self) -> float:
        """Commands up to this size do nothing."""
        return max((e["width"] for e in self._those(ThrusterDeadband)), default=0.0)

    @property
    def curves(self) -> list[ForceCurve]:
        """The force curve of each thruster (n); tables by voltage are those of the nominal one."""
        return [curve.at_nominal_voltage for curve in self.model.thrust_path.thrusters.curves]

    @property
    def exponent(self) -> float:
        """F -> sign(F) F_max (|F| / F_max)^e, with F_max (2, n) of `full`."""
        return float(np.prod([e["exponent"] for e in self._those(CurveExponent)]))

    @property
    def full(self) -> Array:
        """Size of the force (2, n) at full command backwards and forwards, N."""
        return np.abs(self.model.thrust_path.full_force)

    @property
    def gain(self) -> Array:
        """Factor (n,) on the force of each thruster, after the curve."""
        force = np.ones((1, self.model.thrust_path.thrusters.count))
        for gain in self._those(ThrusterGain):
            force = gain.scaled_force(force, np.zeros(1), 1.0)
        return np.asarray(force[0])

    @property
    def backwards(self) -> float:
        """Factor on forces that are then negative."""
        return float(np.prod([e["ratio"] for e in self._those(ThrustAsymmetry)]))

    @property
    def reach(self) -> Array:
        """Length (n,) of the directions, which a vehicle file may round: 1 within a hundredth."""
        thrusters = self.model.thrust_path.thrusters
        return np.asarray(np.linalg.norm(thrusters.directions[: thrusters.count], axis=1))

    @property
    def most(self) -> Array:
        """What no thruster (n,) exceeds, up to 0.1 N: a curve may peak below full command."""
        commands = np.tile(np.linspace(-1.0, 1.0, 201)[:, None], (1, len(self.names)))
        peak = np.abs(self.static_force(commands)).max(axis=0, initial=0.0) * self.reach
        return np.ceil(10.0 * (1.001 * peak)) / 10.0

    def static_force(self, command: Array) -> Array:
        """Forces (m, n) in N of commands (m, n)."""
        return self.model.thrust_path.static(command, np.zeros(len(command)), 1.0)

    def _those(self, kind: type[E]) -> list[E]:
        return [e for e in self.model.effects if isinstance(e, kind)]
