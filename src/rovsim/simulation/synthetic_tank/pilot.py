"""Pilots who watch the vehicle and move the sticks with a reaction time; an autopilot levels it."""

from collections import deque

import numpy as np
from numpy import ndarray as Array

from rovsim.core import gauss_markov
from rovsim.core.rotations import short_way, to_euler, unrotate
from rovsim.simulation.rest import rest_state

REACTION_S = 0.2  # human visual reaction time
WANDER_TIME_S = 1.5  # how long a stick movement lasts

# Standard deviation of the stick movements, per axis: demands in surge, sway, heave and yaw, angles
# in rad in roll and pitch. Excites each axis to some 0.15 m/s or 0.4 rad/s without saturation.
WANDER_STD = {
    "3dof": np.array([0.16, 0.16, 0.12, 0.0, 0.0, 0.0]),
    "6dof": np.array([0.15, 0.15, 0.11, 0.3, 0.3, 0.12]),
}
MAX_DEMAND = 0.40  # of one axis' demand; the axes share the thrusters

POSITION_GAIN, SPEED_GAIN, INTEGRAL_GAIN = 0.22, 0.25, 0.03  # per m, per m/s, per m s
# The autopilot holds roll and pitch at the angles the pilot asks for: per rad, per rad/s.
# Surge and sway thrusters push 85 mm below CO, so without it every manoeuvre would roll it over.
ANGLE_GAIN, RATE_GAIN = 0.3, 0.12
SET_POINT_SHARE = 0.6  # of the half tank (clear of walls) in which the pilot chooses set-points
MAX_SET_POINT_M = np.array([1.5, 1.2, 0.5])  # how far from the middle set-points lie at most
CLEARANCE_M = 0.5  # kept from walls, floor and surface
SET_POINT_TIME_S = 8.0


def draw_wander(ticks: int, dt: float, random: np.random.Generator) -> Array:
    """Draw smooth random stick movements of unit variance: white noise through two low-passes.

    Args:
        ticks: number of commands.
        dt: time between two commands, s.
        random: generator.

    Returns:
        Stick movements (ticks, 6), from surge to yaw.
    """
    a, rows = gauss_markov.decay(2.0 * dt / WANDER_TIME_S), random.normal(size=(ticks + 400, 6))
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
        self.dt, self.delay = dt, max(1, round(REACTION_S / dt))
        self.middle = tank.mean(axis=1)
        half = np.minimum(
            SET_POINT_SHARE * (0.5 * np.ptp(tank, axis=1) - CLEARANCE_M), MAX_SET_POINT_M
        )
        count = int(ticks * dt / SET_POINT_TIME_S) + 2
        self.set_points = self.middle + half * random.uniform(-1, 1, (count, 3))
        self.wander = draw_wander(ticks, dt, random) * WANDER_STD[control]
        self.seen: deque[Array] = deque(maxlen=self.delay + 1)
        self.drift = np.zeros(3)

    def choose_start(self, random: np.random.Generator) -> Array:
        """Draw the state (13,) to start from: at rest at the first set-point, any heading."""
        return rest_state(self.set_points[0], random.uniform(-np.pi, np.pi))

    def steer(self, tick: int, state: Array) -> Array:
        """Decide on the demand (6,) of each axis at a tick, when the state is `state` (13,)."""
        self.seen.append(state.copy())
        delayed = self.seen[0]
        goal = self.set_points[int(tick * self.dt / SET_POINT_TIME_S)]
        drift = self.drift + INTEGRAL_GAIN * self.dt * (goal - delayed[:3])
        self.drift = np.minimum(np.maximum(drift, -0.3), 0.3)  # np.clip takes longer
        world_demand = POSITION_GAIN * (goal - delayed[:3]) + self.drift
        demand = self.wander[tick].copy()
        demand[:3] += unrotate(delayed[3:7], world_demand) - SPEED_GAIN * delayed[7:10]
        demand[3:5] = ANGLE_GAIN * (demand[3:5] - to_euler(state[3:7])[:2])
        demand[3:5] -= RATE_GAIN * state[10:12]
        return np.minimum(np.maximum(demand, -MAX_DEMAND), MAX_DEMAND)


# Of a vehicle that cannot push sideways: it goes ahead and steers towards set-points.
SURGE_DEMAND, STRAY_SHARE = 0.6, 0.5  # demand in surge; share of the usual stick movements
HEADING_GAIN, YAW_RATE_GAIN = 0.8, 1.5  # demand in yaw per rad off the course, per rad/s
DEPTH_GAIN, MAX_DIVE_ANGLE, PITCH_GAIN, PITCH_RATE_GAIN = (
    0.05,
    0.2,
    2.0,
    2.0,
)  # rad per m too shallow, most; per rad, rad/s
COURSE_TIME_S = 20.0
START_SPEED = 0.5  # m/s ahead, as it starts


class Helmsman(Pilot):
    """Steers a vehicle that cannot push sideways: always ahead, from set-point to set-point."""

    def __init__(
        self, control: str, tank: Array, ticks: int, dt: float, random: np.random.Generator
    ) -> None:
        super().__init__(control, tank, ticks, dt, random)
        half = SET_POINT_SHARE * (0.5 * np.ptp(tank, axis=1) - CLEARANCE_M)
        self.set_points = self.middle + half * random.uniform(-1, 1, self.set_points.shape)

    def choose_start(self, random: np.random.Generator) -> Array:
        """Draw the state (13,) to start from: slowly ahead in the middle, any heading."""
        state = rest_state(self.middle, random.uniform(-np.pi, np.pi))
        state[7] = START_SPEED
        return state

    def steer(self, tick: int, state: Array) -> Array:
        """Decide on the demand (6,) of each axis at a tick, when the state is `state` (13,)."""
        self.seen.append(state.copy())
        delayed = self.seen[0]
        offset = self.set_points[int(tick * self.dt / COURSE_TIME_S)] - delayed[:3]
        _, pitch, yaw = to_euler(delayed[3:7])
        heading_error = short_way(np.arctan2(offset[1], offset[0]) - yaw)
        demand = STRAY_SHARE * self.wander[tick]
        demand[0] += SURGE_DEMAND
        demand[5] += HEADING_GAIN * heading_error - YAW_RATE_GAIN * delayed[12]
        dive = np.clip(-DEPTH_GAIN * offset[2], -MAX_DIVE_ANGLE, MAX_DIVE_ANGLE)
        demand[4] += PITCH_GAIN * (dive - pitch) - PITCH_RATE_GAIN * delayed[11]
        return np.clip(demand, -1.0, 1.0)
