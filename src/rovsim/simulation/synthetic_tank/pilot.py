"""Pilots who watch the vehicle and move the sticks with a reaction time; an autopilot levels it."""

from collections import deque

import numpy as np
from numpy import ndarray as Array

from rovsim.core import gauss_markov
from rovsim.core.rotations import short_way, to_euler, unrotate
from rovsim.simulation.rest import rest_state

REACTION = 0.2  # s, human visual reaction time
WANDER_TIME = 1.5  # s, how long a stick movement lasts

# Standard deviation of the stick movements, per axis: demands in surge, sway, heave and yaw, angles
# in rad in roll and pitch. Excites each axis to some 0.15 m/s or 0.4 rad/s without saturation.
WANDER = {
    "3dof": np.array([0.16, 0.16, 0.12, 0.0, 0.0, 0.0]),
    "6dof": np.array([0.15, 0.15, 0.11, 0.3, 0.3, 0.12]),
}
LARGEST = 0.40  # of one axis' demand; the axes share the thrusters

POSITION_GAIN, SPEED_GAIN, INTEGRAL_GAIN = 0.22, 0.25, 0.03  # per m, per m/s, per m s
# The autopilot holds roll and pitch at the angles the pilot asks for: per rad, per rad/s.
# Surge and sway thrusters push 85 mm below CO, so without it every manoeuvre would roll it over.
HOLD_ANGLE, HOLD_RATE = 0.3, 0.12
NEAR = 0.6  # share of the half tank (clear of walls) in which the pilot chooses set-points
REACH = np.array([1.5, 1.2, 0.5])  # m, how far from the middle set-points lie at most
CLEARANCE = 0.5  # m, kept from walls, floor and surface
SET_POINT_TIME = 8.0  # s


def draw_wander(ticks: int, dt: float, random: np.random.Generator) -> Array:
    """Draw smooth random stick movements of unit variance: white noise through two low-passes.

    Args:
        ticks: number of commands.
        dt: time between two commands, s.
        random: generator.

    Returns:
        Stick movements (ticks, 6), from surge to yaw.
    """
    a, rows = gauss_markov.decay(2.0 * dt / WANDER_TIME), random.normal(size=(ticks + 400, 6))
    for _ in range(2):
        rows = gauss_markov.lag(a, (1 - a) * rows, np.zeros(6))
    rows = rows[400:]
    return rows / np.maximum(rows.std(axis=0), 1e-12)


class Pilot:
    """Steers from set-point to set-point in the tank, by what was seen a reaction time ago.

    Args:
        control: `3dof` or `6dof`: whether the sticks also excite rotations.
        tank: walls (3, 2) in NED, m.
        ticks: number of commands.
        dt: time between two commands, s.
        random: generator of set-points and stick movements.
    """

    def __init__(
        self, control: str, tank: Array, ticks: int, dt: float, random: np.random.Generator
    ) -> None:
        self.dt, self.delay = dt, max(1, round(REACTION / dt))
        self.middle = tank.mean(axis=1)
        half = np.minimum(NEAR * (0.5 * np.ptp(tank, axis=1) - CLEARANCE), REACH)
        count = int(ticks * dt / SET_POINT_TIME) + 2
        self.set_points = self.middle + half * random.uniform(-1, 1, (count, 3))
        self.wander = draw_wander(ticks, dt, random) * WANDER[control]
        self.seen: deque[Array] = deque(maxlen=self.delay + 1)
        self.drift = np.zeros(3)

    def choose_start(self, random: np.random.Generator) -> Array:
        """Draw the state (13,) to start from: at rest at the first set-point, any heading."""
        return rest_state(self.set_points[0], random.uniform(-np.pi, np.pi))

    def steer(self, tick: int, state: Array) -> Array:
        """Decide on the demand (6,) of each axis at a tick, when the state is `state` (13,)."""
        self.seen.append(state.copy())
        delayed = self.seen[0]
        goal = self.set_points[int(tick * self.dt / SET_POINT_TIME)]
        drift = self.drift + INTEGRAL_GAIN * self.dt * (goal - delayed[:3])
        self.drift = np.minimum(np.maximum(drift, -0.3), 0.3)  # np.clip takes longer
        push = POSITION_GAIN * (goal - delayed[:3]) + self.drift
        demand = self.wander[tick].copy()
        demand[:3] += unrotate(delayed[3:7], push) - SPEED_GAIN * delayed[7:10]
        demand[3:5] = HOLD_ANGLE * (demand[3:5] - to_euler(state[3:7])[:2])
        demand[3:5] -= HOLD_RATE * state[10:12]
        return np.minimum(np.maximum(demand, -LARGEST), LARGEST)


# Of a vehicle that cannot push sideways: it goes ahead and steers towards set-points.
AHEAD, STRAY = 0.6, 0.5  # demand in surge; share of the usual stick movements
TURN, TURN_RATE = 0.8, 1.5  # demand in yaw per rad off the course, per rad/s
DIVE, DIVE_ANGLE, PITCH, PITCH_RATE = (
    0.05,
    0.2,
    2.0,
    2.0,
)  # rad per m too shallow, most; per rad, rad/s
COURSE_TIME = 20.0  # s
SLOWLY = 0.5  # m/s ahead, as it starts


class Helmsman(Pilot):
    """Steers a vehicle that cannot push sideways: always ahead, from set-point to set-point."""

    def __init__(
        self, control: str, tank: Array, ticks: int, dt: float, random: np.random.Generator
    ) -> None:
        super().__init__(control, tank, ticks, dt, random)
        half = NEAR * (0.5 * np.ptp(tank, axis=1) - CLEARANCE)
        self.set_points = self.middle + half * random.uniform(-1, 1, self.set_points.shape)

    def choose_start(self, random: np.random.Generator) -> Array:
        """Draw the state (13,) to start from: slowly ahead in the middle, any heading."""
        state = rest_state(self.middle, random.uniform(-np.pi, np.pi))
        state[7] = SLOWLY
        return state

    def steer(self, tick: int, state: Array) -> Array:
        """Decide on the demand (6,) of each axis at a tick, when the state is `state` (13,)."""
        self.seen.append(state.copy())
        delayed = self.seen[0]
        offset = self.set_points[int(tick * self.dt / COURSE_TIME)] - delayed[:3]
        _, pitch, yaw = to_euler(delayed[3:7])
        heading_error = short_way(np.arctan2(offset[1], offset[0]) - yaw)
        demand = STRAY * self.wander[tick]
        demand[0] += AHEAD
        demand[5] += TURN * heading_error - TURN_RATE * delayed[12]
        dive = np.clip(-DIVE * offset[2], -DIVE_ANGLE, DIVE_ANGLE)
        demand[4] += PITCH * (dive - pitch) - PITCH_RATE * delayed[11]
        return np.clip(demand, -1.0, 1.0)
