"""What a demand asks of thrusters and surfaces: the mixer, or their levers where there is none."""

from functools import cached_property

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import short_way
from rovsim.dynamics.vehicle import Vehicle

FULL_ANGLE = 0.25  # rad, of a surface at full demand: below the stall of most


class Allocation:
    """From demands per axis to the command columns of a vehicle."""

    def __init__(self, vehicle: Vehicle) -> None:
        self.thrusters, self.limit = vehicle.thrusters, vehicle.thrusters.command_limit
        self.units = vehicle.thrusters.units
        place = np.array([u.position for u in self.units]).reshape(-1, 3)
        pull = np.array([u.direction for u in self.units]).reshape(-1, 3)
        self.arms = place / max(np.abs(place).max(initial=0.0), 1e-9)
        self.pushes = np.hstack([pull, _largest_one(np.cross(place, pull))])
        levers = [np.cross(one.position, one.normal) for one in vehicle.surfaces]
        self.levers = _largest_one(np.array(levers).reshape(-1, 3))

    @property
    def sideways(self) -> bool:
        """Whether some thruster pushes sideways."""
        turning = any(unit.azimuth for unit in self.units)
        return turning or bool(np.abs(self.pushes[:, 1]).max(initial=0.0) > 0.1)

    def command(self, demand: Array) -> Array:
        """Commands and angles, as `Vehicle.command_columns`, of a demand (6,)."""
        columns: list[float] = []
        for k, throttle in enumerate((self._shares @ demand).tolist()):
            own = self._turned(k, demand) if self.units[k].azimuth else [throttle]
            columns += [min(max(own[0], -self.limit), self.limit), *own[1:]]
        angles = FULL_ANGLE * np.clip(self.levers @ demand[3:], -1.0, 1.0)
        return np.array([*columns, *angles])

    @cached_property
    def _shares(self) -> Array:
        """What each thruster (n, 6) does for a demand."""
        return self.thrusters.mixing() if self.thrusters.mixer else self.pushes

    def _turned(self, k: int, demand: Array) -> list[float]:
        """Command and angle of a thruster that turns: along what is asked of its place."""
        x, y, _ = self.arms[k]
        ahead, aside = demand[0] - demand[5] * y, demand[1] + demand[5] * x
        zero = np.arctan2(self.units[k].direction[1], self.units[k].direction[0])
        angle = np.arctan2(aside, ahead) - zero
        return [float(np.hypot(ahead, aside)), float(short_way(angle))]


def _largest_one(levers: Array) -> Array:
    """Levers (n, 3) of which the largest is 1."""
    return levers / max(np.abs(levers).max(initial=0.0), 1e-9)
