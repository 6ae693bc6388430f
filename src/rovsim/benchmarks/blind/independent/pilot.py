"""A pilot unlike that of the tank: sines on the sticks around slow journeys between places."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.benchmarks.blind.independent.motion import Vehicle

SINE_COUNT, MIN_STICK_HZ, MAX_STICK_HZ = 8, 0.04, 0.7  # sines on each stick; Hz: what a hand does
# RMS of the sticks: demands in surge, sway, heave and yaw; angles in rad in roll and pitch
STICK_RMS = {
    "3dof": np.array([0.15, 0.15, 0.10, 0.0, 0.0, 0.0]),
    "6dof": np.array([0.15, 0.14, 0.10, 0.25, 0.25, 0.12]),
}
JOURNEY_S = 12.0  # from place to place
# m about the middle, or half of what the walls leave if less
MAX_ROAMING_M = np.array([1.4, 1.1, 0.4])
PLACE_GAIN, SPEED_GAIN, TRIM_GAIN = 0.2, 0.25, 0.025  # demand per m, per m/s, per m s
UPRIGHT_GAIN, RATE_GAIN = 0.3, 0.12  # demand per rad, per rad/s
MAX_DEMAND = 0.4  # demand of an axis
REACTION_TICKS = 10  # ticks of 20 ms: the reaction time of an eye and a hand


class Pilot:
    """Steers by the place and velocity of a reaction time ago, and by the present attitude.

    Attributes:
        places: (n, 3) that are headed for, one after the other, m, NED.
        hertz: frequencies (SINE_COUNT, 6) of the sticks, Hz.
        phase: (SINE_COUNT, 6) of the sticks, rad.
        size: amplitude (6,) of each sine.
        heading: yaw at the start, rad.
        trim: integral part (3,) of the position control.
        states: of the vehicle so far.
    """

    def __init__(
        self, control: str, tank: Array, seconds: float, random: np.random.Generator
    ) -> None:
        low, high = tank[:, 0] + 0.6, tank[:, 1] - 0.6  # m, half the vehicle and a hand's breadth
        half = np.minimum(0.25 * (high - low), MAX_ROAMING_M)
        count = int(seconds / JOURNEY_S) + 2
        self.places = 0.5 * (low + high) + half * random.uniform(-1.0, 1.0, (count, 3))
        self.hertz = random.uniform(MIN_STICK_HZ, MAX_STICK_HZ, (SINE_COUNT, 6))
        self.phase = random.uniform(0.0, 2.0 * np.pi, (SINE_COUNT, 6))
        self.size = STICK_RMS[control] * np.sqrt(2.0 / SINE_COUNT)
        self.heading = float(random.uniform(-np.pi, np.pi))
        self.trim, self.states = np.zeros(3), []  # type: tuple[Array, list[Vehicle]]

    def begin(self, thrusters: int) -> Vehicle:
        """Return the vehicle at rest at the first place."""
        c, s = np.cos(self.heading), np.sin(self.heading)
        R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        return Vehicle(self.places[0], R, np.zeros(6), np.zeros(thrusters), np.zeros(6))

    def steer(self, t: float, now: Vehicle, tick: float) -> Array:
        """Return the demand (6,) at time t, from the present state and the states so far."""
        self.states.append(now)
        delayed = self.states[max(0, len(self.states) - 1 - REACTION_TICKS)]
        k, fraction = divmod(t / JOURNEY_S, 1.0)
        goal = (1.0 - fraction) * self.places[int(k)] + fraction * self.places[int(k) + 1]
        error = goal - delayed.place
        self.trim = np.clip(self.trim + TRIM_GAIN * tick * error, -0.3, 0.3)
        demand = self.size * np.sum(np.sin(2.0 * np.pi * self.hertz * t + self.phase), axis=0)
        demand[:3] += (
            delayed.R.T @ (PLACE_GAIN * error + self.trim) - SPEED_GAIN * delayed.velocity[:3]
        )
        tilt = [np.arctan2(now.R[2, 1], now.R[2, 2]), -np.arcsin(np.clip(now.R[2, 0], -1.0, 1.0))]
        demand[3:5] = UPRIGHT_GAIN * (demand[3:5] - tilt) - RATE_GAIN * now.velocity[3:5]
        return np.clip(demand, -MAX_DEMAND, MAX_DEMAND)


def draw_turbulence(
    force: float,
    moment: float,
    time: float,
    tick: float,
    count: int,
    random: np.random.Generator,
) -> Sequence[Array]:
    """Draw turbulence: an Ornstein-Uhlenbeck wrench that no log contains.

    Args:
        force: standard deviation, N.
        moment: standard deviation, N m.
        time: time constant, s.
        tick: over which a wrench is held, s.
        count: of ticks.
        random: from which they are drawn.

    Returns:
        A wrench (6,) for each tick, body axes.
    """
    decay = np.exp(-tick / time)
    std = np.repeat([force, moment], 3)
    wrenches = [std * random.normal(size=6)]
    for _ in range(count - 1):
        wrenches.append(
            decay * wrenches[-1] + std * np.sqrt(1.0 - decay**2) * random.normal(size=6)
        )
    return wrenches
