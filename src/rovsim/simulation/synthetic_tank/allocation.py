"""Allocation of demands to thrusters and control surfaces, by the mixer or by their lever arms."""

from functools import cached_property

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import short_way
from rovsim.dynamics.vehicle import Vehicle

FULL_ANGLE = 0.25  # rad, of a surface at full demand: below the stall of most


class Allocation:
    """Turns demands per axis into the commands of a vehicle.

    Attributes:
        arms: places (n, 3) of the n thrusters in body axes FRD, scaled so that the largest is 1.
        wrenches: force and moment (n, 6) of each thruster per unit of thrust; moments are scaled so
            that the largest is 1. These allocate demands where the vehicle has no mixer.
        levers: moment (s, 3) of each control surface per unit of force along its normal, scaled so
            that the largest is 1.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        self.thrusters, self.limit = vehicle.thrusters, vehicle.thrusters.command_limit
        self.units = vehicle.thrusters.units
        position = np.array([u.position for u in self.units]).reshape(-1, 3)
        direction = np.array([u.direction for u in self.units]).reshape(-1, 3)
        self.arms = position / max(np.abs(position).max(initial=0.0), 1e-9)
        self.wrenches = np.hstack([direction, _largest_one(np.cross(position, direction))])
        levers = [np.cross(surface.position, surface.normal) for surface in vehicle.surfaces]
        self.levers = _largest_one(np.array(levers).reshape(-1, 3))

    @property
    def sideways(self) -> bool:
        """Whether a thruster can push sideways."""
        has_azimuth = any(unit.azimuth for unit in self.units)
        return has_azimuth or bool(np.abs(self.wrenches[:, 1]).max(initial=0.0) > 0.1)

    def command(self, demand: Array) -> Array:
        """Allocate a demand (6,) from surge to yaw, each axis in [-1, 1].

        Returns:
            Thruster commands in [-1, 1] and angles in rad, in the order of
            `Vehicle.command_columns`.
        """
        columns: list[float] = []
        for k, throttle in enumerate((self._shares @ demand).tolist()):
            values = self._turned(k, demand) if self.units[k].azimuth else [throttle]
            columns += [min(max(values[0], -self.limit), self.limit), *values[1:]]
        angles = FULL_ANGLE * np.clip(self.levers @ demand[3:], -1.0, 1.0)
        return np.array([*columns, *angles])

    @cached_property
    def _shares(self) -> Array:
        """Command (n, 6) of each of n thrusters per unit of demand of each axis."""
        return self.thrusters.mixing() if self.thrusters.mixer else self.wrenches

    def _turned(self, k: int, demand: Array) -> list[float]:
        """Command and angle, rad, of azimuth thruster k, along the force demanded at its place."""
        x, y, _ = self.arms[k]
        ahead, across = demand[0] - demand[5] * y, demand[1] + demand[5] * x
        zero = np.arctan2(self.units[k].direction[1], self.units[k].direction[0])
        angle = np.arctan2(across, ahead) - zero
        return [float(np.hypot(ahead, across)), float(short_way(angle))]


def _largest_one(levers: Array) -> Array:
    """Scale lever arms (n, 3) so that their largest component is 1."""
    return levers / max(np.abs(levers).max(initial=0.0), 1e-9)
