"""Inputs flown on the model: a pilot who sees all keeps the vehicle upright and near its place.

What comes out are the demands alone; they are flown without looking. So a flight needs neither the
pilot nor the autopilot of the laboratory, and how far it strays without them is predicted.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.rotations import multiply, normalized, rotate, to_euler, unrotate
from rovsim.core.run import Site
from rovsim.design.authority import Authority
from rovsim.design.inputs import TICK_SECONDS
from rovsim.design.settings import FlightLimits
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from rovsim.simulation.rest import rest_state

# rad/s, as of a spring and a damper: a place is held so softly that swings of half a minute still
# get through, an angle within a second, as an autopilot does
PLACE_BANDWIDTH, ANGLE_BANDWIDTH, DAMPING_RATIO = 0.3, 2.0, 0.7
STEPS_PER_TICK = 2  # of Heun's method
TILT_DIFFERENCE_RAD = 0.05  # of a finite difference


@dataclass(frozen=True, eq=False)
class ModelPilot:
    """Flies inputs on the model of an authority, from rest at `start` (3,) m NED.

    Full ones reach the `limits`, where the thrusters can.
    """

    authority: Authority
    site: Site
    start: Array
    limits: FlightLimits
    batch: Batch

    def fly(self, inputs: Array, heading: Array) -> Array:
        """What a log holds (m, n, c) of inputs (m, n, 6) from headings (m,) rad NED."""
        state, thrust, values = self.starts(heading), None, []
        wrench = np.tile(self.rest, (len(state), 1))
        step = self.limits.slew * TICK_SECONDS * np.maximum(self.full, 1e-9)
        for k in range(inputs.shape[1]):
            wrench = np.clip(self._wish(inputs[:, k], state), wrench - step, wrench + step)
            values.append(self.authority.values(wrench))
            drive, thrust = self.authority.respond(values[-1], TICK_SECONDS, thrust)
            state = self._advance(drive, state)
        return np.stack(values, axis=1)

    def starts(self, heading: Array) -> Array:
        """States (m, 13) at rest and level."""
        return rest_state(self.start, heading)

    @cached_property
    def full(self) -> Array:
        """Wrench (6,) of full inputs: what holds the greatest speed, turn rate and tilt."""
        wrench = np.append(self._drag[[0, 1, 2, 5]], self._stiffness * self.limits.tilt)
        return np.minimum(self.authority.full, wrench[[0, 1, 2, 4, 5, 3]])

    @cached_property
    def _drag(self) -> Array:
        """Wrench (6,) that holds the greatest speed along, and turn rate about, each axis."""
        limits = np.repeat([self.limits.speed, self.limits.turn_rate], 3)
        moving = self.starts(np.zeros(len(AXES)))
        moving[:, 7:] = np.diag(limits)
        rest = self._drive_at_rest(len(AXES))
        return -self._inertia * np.diag(self._accelerate(rest, moving))

    @cached_property
    def _inertia(self) -> Array:
        return np.diag(self.authority.model.M)

    @cached_property
    def _stiffness(self) -> Array:
        """Moment (2,) per rad of roll and pitch, held and righted."""
        tilted = self.starts(np.zeros(2))
        tilted[0, 4], tilted[1, 5] = 0.5 * TILT_DIFFERENCE_RAD, 0.5 * TILT_DIFFERENCE_RAD
        rest = self._drive_at_rest(2)
        accelerations = self._accelerate(rest, tilted)
        inertia = self._inertia[3:5]
        righting = (
            -inertia * np.array([accelerations[0, 3], accelerations[1, 4]]) / TILT_DIFFERENCE_RAD
        )
        return inertia * ANGLE_BANDWIDTH**2 + np.maximum(righting, 0.0)

    @cached_property
    def rest(self) -> Array:
        """Wrench (6,) that keeps the vehicle where it is, level and still."""
        drive = self.authority.drive(self.authority.values(np.zeros((1, len(AXES)))))
        nu_dot = self._accelerate(drive, self.starts(np.zeros(1)))
        return -self._inertia * nu_dot[0] * (self.authority.full > 0.0)

    def _drive_at_rest(self, count: int) -> Drive:
        return self.authority.drive(self.authority.values(np.tile(self.rest, (count, 1))))

    def _wish(self, inputs: Array, state: Array) -> Array:
        """Wrench (m, 6): the inputs, and what keeps it upright and near its place."""
        offset = unrotate(state[:, 3:7], state[:, :3] - self.start)
        tilt = to_euler(state[:, 3:7])
        tilt[:, 2] = 0.0
        place_term = (
            PLACE_BANDWIDTH**2 * offset + 2.0 * DAMPING_RATIO * PLACE_BANDWIDTH * state[:, 7:10]
        )
        attitude_term = (
            ANGLE_BANDWIDTH**2 * tilt + 2.0 * DAMPING_RATIO * ANGLE_BANDWIDTH * state[:, 10:13]
        )
        attitude_term[:, 2] = 0.0  # any heading will do
        restoring = np.concatenate([place_term, attitude_term], axis=1) * self._held
        return self.rest + self.full * inputs - self._inertia * restoring

    @cached_property
    def _held(self) -> Array:
        """Which axes (6,) it holds: what floats keeps itself level and at the surface."""
        floating = np.isin(np.arange(6), (2, 3, 4)) & self.authority.model.vehicle.floats
        return np.asarray(~floating)

    def _advance(self, drive: Drive, state: Array) -> Array:
        """States (m, 13) a tick later, each under its own thrust.

        A `Batch` integrates one drive a model, or one state by Heun's method: flights that go on
        side by side would be taken apart and put together again at every tick.
        """
        h = TICK_SECONDS / STEPS_PER_TICK
        for _ in range(STEPS_PER_TICK):
            first = self._rates(drive, state)
            second = self._rates(drive, _moved(state, first, h))
            state = _moved(state, 0.5 * (first + second), h)
        return state

    def _rates(self, drive: Drive, state: Array) -> Array:
        """d state / dt (m, 13)."""
        omega = np.concatenate([np.zeros((len(state), 1)), state[:, 10:13]], axis=1)
        return np.concatenate(
            [
                rotate(state[:, 3:7], state[:, 7:10]),
                0.5 * multiply(state[:, 3:7], omega),
                self._accelerate(drive, state),
            ],
            axis=1,
        )

    def _accelerate(self, drive: Drive, state: Array) -> Array:
        memory = np.zeros((len(state), 6))
        return self.batch.accelerations(drive, np.zeros(len(state)), state, memory)


def _moved(state: Array, rates: Array, h: float) -> Array:
    moved = state + h * rates
    moved[:, 3:7] = normalized(moved[:, 3:7])
    return moved
