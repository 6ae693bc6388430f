"""The motion of the vehicle from its momentum in the world (Kirchhoff; Lamb 1932, art. 120-124).

In water that moves steadily, everything is as in still water for an observer who drifts along. For
that observer the momentum P of vehicle and water, and its moment L about a fixed point, change by
the forces alone: P' = F, L' = M + x x F. Velocity follows from (R^T P, R^T (L - x x P)) = M nu, and
there is no Coriolis matrix. Attitude is the rotation matrix itself, R' = R [omega]x, made
orthogonal again after every span.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.integrate import DOP853
from scipy.spatial.transform import Rotation

from rovsim.benchmarks.blind.independent.pushes import (
    MEMORY_SCALE,
    ForceLaw,
    Instant,
    cross,
    list_force_laws,
)
from rovsim.benchmarks.blind.independent.thrusters import Thrusters
from rovsim.benchmarks.blind.independent.vehicle import Constants, Hidden, skew

# of one step of some 20 ms, relative; a tenth of it absolute, in m, 1, kg m/s, N
STEP_TOLERANCE = 1e-7


@dataclass(frozen=True, eq=False)
class Vehicle:
    """The state of the vehicle.

    Attributes:
        place: of CO (3,), m, NED.
        R: rotation matrix (3, 3) from body to world.
        velocity: (6,) over ground in body axes, m/s and rad/s.
        thrust: force (n,) of each thruster, N.
        memory: of the water (6,), the velocity that its wake follows with a lag.
    """

    place: Array
    R: Array
    velocity: Array
    thrust: Array
    memory: Array


class Mover:
    """Integrates the motion while the static forces of the thrusters are held.

    Attributes:
        own: constants of the vehicle.
        thrusters: of the vehicle; their battery may sag.
        tolerance: relative, of the integration.
        pushes: forces on the hull.
        M_inv: inverse (6, 6) of the inertia with added mass.
        weight: weight less buoyancy, N.
        hang: sum (3,) of weights and buoyancy times where they act, N m, body axes.
        current: velocity (3,) of the water, m/s, NED.
        lag: time constant of the thrusters, s; 0: none.
        sags: whether the battery sags.
        wake: coefficients (6,) of the fluid memory.
        wake_time: its time constant, s; 0: none.
        loss: of thrust with the speed of the inflow, s/m.
        wrenches: body wrench (n, 6) of one newton of each thruster.
    """

    def __init__(
        self,
        own: Constants,
        thrusters: Thrusters,
        hidden: Hidden,
        tank: Array,
        tolerance: float = STEP_TOLERANCE,
    ) -> None:
        self.own, self.thrusters, self.tolerance = own, thrusters, tolerance
        self.force_laws: Sequence[ForceLaw] = list_force_laws(own, hidden, tank)
        self.M_inv = np.linalg.inv(own.M)
        self.weight = float(own.weights[:, 0].sum())
        self.hang = own.weights[:, 0] @ own.weights[:, 1:]
        current = hidden.get("current", {})
        self.current = np.array([current.get(k, 0.0) for k in ("north", "east", "down")])
        self.lag = hidden.get("thruster_lag", {}).get("time_constant", 0.0)
        self.sags = "voltage_sag" in hidden
        wake = hidden.get("fluid_memory", {})
        self.wake = wake.get("coefficient", 0.0) * MEMORY_SCALE
        self.wake_time = wake.get("time_constant", 0.0)
        self.loss = hidden.get("advance_loss", {}).get("coefficient", 0.0)
        arm = hidden.get("propeller_torque", {}).get("ratio", 0.0)
        moments = np.cross(own.position, own.direction) + arm * own.spin[:, None] * own.direction
        self.wrenches = np.hstack([own.direction, moments])  # of one newton of each

    def carry(
        self,
        start: Vehicle,
        static: Array,
        turbulence: Array,
        span: tuple[float, float],
        wanted: Sequence[float] = (),
    ) -> tuple[Vehicle, list[Vehicle]]:
        """Integrate over a span of time.

        Args:
            start: the vehicle at its beginning.
            static: static forces (n,) of the thrusters with a full battery, held, N.
            turbulence: wrench (6,) in body axes, held, N and N m.
            span: begin and end, s.
            wanted: instants inside the span, ascending, s.

        Returns:
            The vehicle at the end, and at the wanted instants.
        """
        flow, (begin, end) = _Flow(self, start, static, turbulence, span[0]), span
        solver = DOP853(
            flow.change,
            begin,
            flow.begin,
            end,
            first_step=end - begin,
            rtol=self.tolerance,
            atol=0.1 * self.tolerance,
        )
        vehicles, instants = [], list(wanted)
        while solver.status == "running":
            solver.step()
            interpolant = solver.dense_output() if instants and instants[0] < solver.t else None
            while instants and instants[0] <= solver.t:
                t = instants.pop(0)
                y = interpolant(t) if interpolant is not None and t < solver.t else solver.y
                vehicles.append(flow.see(t, y))
        final = flow.see(end, solver.y)
        R = Rotation.from_matrix(final.R).as_matrix()
        return Vehicle(final.place, R, final.velocity, final.thrust, final.memory), vehicles


class _Flow:
    """The differential equation over one span, about the place where it begins.

    Its state y is, for an observer who drifts with the current: place less that of the start (3); R
    row by row (9); P (3); L (3); thrust (n) if it lags; memory (6) if there is any.
    """

    def __init__(
        self, mover: Mover, start: Vehicle, static: Array, turbulence: Array, begin: float
    ) -> None:
        self.mover, self.start, self.static, self.turbulence = mover, start, static, turbulence
        self.t0, self.lags, self.remembers = begin, mover.lag > 0.0, mover.wake_time > 0.0
        v = start.velocity.copy()
        v[:3] -= start.R.T @ mover.current
        momentum = (mover.own.M @ v).reshape(2, 3) @ start.R.T
        parts = [np.zeros(3), start.R.ravel(), momentum.ravel()]
        parts += [start.thrust] if self.lags else []
        self.begin = np.concatenate(parts + ([start.memory] if self.remembers else []))
        self.steady = not (self.lags or mover.sags or mover.loss)
        self.thrust = static @ mover.wrenches

    def see(self, t: float, y: Array) -> Vehicle:
        """Return the vehicle over ground from the state at time t."""
        R, v = self._motion(y)
        place = self.start.place + y[:3] + (t - self.t0) * self.mover.current
        velocity = np.concatenate([v[:3] + R.T @ self.mover.current, v[3:]])
        thrust = y[18 : 18 + len(self.static)] if self.lags else self._battery(t) * self.static
        return Vehicle(place, R, velocity, thrust, y[-6:] if self.remembers else np.zeros(6))

    def _motion(self, y: Array) -> tuple[Array, Array]:
        """Return attitude R (3, 3) and velocity (6,) through the water, body axes."""
        R, momentum = y[3:12].reshape(3, 3), y[12:18].copy()
        momentum[3:] -= cross(y[:3], momentum[:3])
        return R, self.mover.M_inv @ (momentum.reshape(2, 3) @ R).ravel()

    def _battery(self, t: float) -> float:
        return self.mover.thrusters.battery(t) if self.mover.sags else 1.0

    def change(self, t: float, y: Array) -> Array:
        """Return the derivative of the state."""
        mover, (R, v) = self.mover, self._motion(y)
        place = self.start.place + y[:3] + (t - self.t0) * mover.current
        instant, wrench, rates = Instant(place, R, v), self.turbulence, []
        if self.steady:
            wrench = wrench + self.thrust
        else:
            target = self._battery(t) * self.static
            thrust = y[18 : 18 + len(target)] if self.lags else target
            wrench = wrench + self._thrust(thrust, v)
            rates += [(target - thrust) / mover.lag] if self.lags else []
        for law in mover.force_laws:
            wrench = wrench + law(instant)
        if self.remembers:
            wrench = wrench - mover.wake * (v - y[-6:])
            rates += [(v - y[-6:]) / mover.wake_time]
        forces = wrench.reshape(2, 3) @ R.T
        weight_moment = R @ mover.hang
        forces[0, 2] += mover.weight
        forces[1, 0] += weight_moment[1]
        forces[1, 1] -= weight_moment[0]
        forces[1] += cross(y[:3], forces[0])
        return np.concatenate([R @ v[:3], (R @ skew(v[3:])).ravel(), forces.ravel(), *rates])

    def _thrust(self, force: Array, v: Array) -> Array:
        """Return the body wrench (6,) of the thrusters, less what they lose to their inflow."""
        if self.mover.loss:
            inflow = self.mover.own.direction @ v[:3]
            force = force * (1.0 - self.mover.loss * np.sign(force) * inflow)
        return force @ self.mover.wrenches
