"""The equation of motion of a model as numbers, for those who write it in another language.

    M_RB nu_dot + C_RB(nu) nu + M_A nu_r_dot + C_A(nu_r) nu_r + D(nu_r) nu_r + g(R) = tau

SI, FRD at CO, world NED (Fossen 2021, eq. 6.1, 10.135); C nu follows from M (eq. 6.43).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES, FORCE, VELOCITY
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
    """A rigid body.

    Attributes:
        mass: kg.
        center: (3,) centre of gravity relative to CO, m, FRD.
        inertia: (3, 3) about the centre of gravity, kg m2.
    """

    mass: float
    center: Array
    inertia: Array

    @staticmethod
    def of(M: Array) -> "RigidInertia":
        """Take a rigid body apart, from its inertia matrix (6, 6) at CO (Fossen 2021, eq. 3.49)."""
        mass = float(M[0, 0])
        center = np.array([M[2, 4], M[0, 5], M[1, 3]]) * [-1.0, -1.0, -1.0] / mass
        S = cross_matrix(center)
        return RigidInertia(mass, center, M[3:, 3:] + mass * S @ S)


@dataclass(frozen=True, eq=False)
class Equation:
    """Constants in the equation of motion of a model of whose effects a target can hold all."""

    model: Model

    @property
    def body(self) -> Body:
        """Constants of the body in SI, FRD at CO."""
        return self.model.body

    @cached_property
    def rigid(self) -> RigidInertia:
        """Rigid-body inertia of the vehicle with its payload, without added mass."""
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
        """Coefficients of products of velocities by SNAME name (Yuv), as in vehicle files."""
        coefficients: dict[str, float] = {}
        for flow in self._list_effects(CrossFlow):
            coefficients |= {
                name: coefficients.get(name, 0.0) + c for name, c in flow.products.items()
            }
        for lift in self._list_effects(Lift):
            for name in ("Y|u|v", "Z|u|w"):
                coefficients[name] = coefficients.get(name, 0.0) - lift["coefficient"]
        for cubic in self._list_effects(CubicDamping):
            for axis, force, v in zip(AXES, FORCE, VELOCITY, strict=True):
                coefficients[f"{force}{3 * v}"] = (
                    coefficients.get(f"{force}{3 * v}", 0.0) - cubic[axis]
                )
        return {name: c for name, c in coefficients.items() if c}

    @property
    def constant(self) -> Array:
        """Constant wrench (6,), N and N m, FRD."""
        return sum((e.values for e in self._list_effects(ConstantWrench)), np.zeros(6))

    @property
    def friction(self) -> Array:
        """Coefficients c (6,) of dry friction, N and N m: tau_i = -c_i tanh(nu_r,i / 0.01)."""
        return sum((e.values for e in self._list_effects(DryFriction)), np.zeros(6))

    @property
    def names(self) -> list[str]:
        """Names of the n thrusters, in the vehicle file's order."""
        return [unit.name for unit in self.model.vehicle.thrusters.units]

    @property
    def columns(self) -> Array:
        """Position (n,) of the command that each thruster follows, counted from 0."""
        order = np.arange(self.model.thrust_path.thrusters.count)[None]
        for effect in self._list_effects(ThrusterOrder):
            order = effect.thruster_command(order)
        return np.asarray(order[0], dtype=int)

    @property
    def deadband(self) -> float:
        """Width of the deadband: commands up to this size, within [-1, 1], do nothing."""
        return max((e["width"] for e in self._list_effects(ThrusterDeadband)), default=0.0)

    @property
    def curves(self) -> list[ForceCurve]:
        """Force curve of each of the n thrusters; tables by voltage at the nominal voltage."""
        return [curve.at_nominal_voltage for curve in self.model.thrust_path.thrusters.curves]

    @property
    def exponent(self) -> float:
        """Exponent e in F -> sign(F) F_max (|F| / F_max)^e, where F_max is `full`."""
        return float(np.prod([e["exponent"] for e in self._list_effects(CurveExponent)]))

    @property
    def full(self) -> Array:
        """Absolute force (2, n) at full command, backwards and forwards, N."""
        return np.abs(self.model.thrust_path.full_force)

    @property
    def gain(self) -> Array:
        """Factor (n,) on the force of each thruster, after the curve."""
        force = np.ones((1, self.model.thrust_path.thrusters.count))
        for gain in self._list_effects(ThrusterGain):
            force = gain.scaled_force(force, np.zeros(1), 1.0)
        return np.asarray(force[0])

    @property
    def backwards(self) -> float:
        """Factor on forces that are negative after curve and gain."""
        return float(np.prod([e["ratio"] for e in self._list_effects(ThrustAsymmetry)]))

    @property
    def reach(self) -> Array:
        """Norm (n,) of the thrusters' directions: 1 up to rounding in the vehicle file (0.01)."""
        thrusters = self.model.thrust_path.thrusters
        return np.asarray(np.linalg.norm(thrusters.directions[: thrusters.count], axis=1))

    @property
    def most(self) -> Array:
        """Limit (n,) of each thruster's force, N, rounded up to 0.1 N.

        All commands are looked at, since a curve may peak below full command.
        """
        commands = np.tile(np.linspace(-1.0, 1.0, 201)[:, None], (1, len(self.names)))
        peak = np.abs(self.static_force(commands)).max(axis=0, initial=0.0) * self.reach
        return np.ceil(10.0 * (1.001 * peak)) / 10.0

    def static_force(self, command: Array) -> Array:
        """Compute the steady forces (m, n), N, of commands (m, n) in [-1, 1]."""
        return self.model.thrust_path.static(command, np.zeros(len(command)), 1.0)

    def _list_effects(self, kind: type[E]) -> list[E]:
        return [e for e in self.model.effects if isinstance(e, kind)]
