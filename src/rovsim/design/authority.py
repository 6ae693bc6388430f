"""From a wrench that is wanted to what a log of commands would hold, and what that does."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.run import CommandKind, Commands, latest
from rovsim.dynamics.model import Model
from rovsim.simulation.command_columns import round_as_logged
from rovsim.simulation.drive import Drive

COMMAND_LEVELS = np.linspace(-1.0, 1.0, 81)  # of a thruster's command
# An axis is commanded if no more than this share of a push along it goes elsewhere.
MAX_CROSS_SHARE = 0.3
DEMAND_STEP = 0.5  # of a demand, to see what a loop on board makes of it

ThrusterState = list  # of the thrusters


@dataclass(frozen=True, eq=False)
class Authority:
    """What commands of one model can do.

    `kind` of its logs; `logged` (6,) axes that a log per axis has; `largest` (6,) N, N m that logs
    of a wrench went up to.
    """

    model: Model
    kind: CommandKind
    logged: Array
    largest: Array

    @cached_property
    def axes(self) -> Array:
        """Axes (j,) that can be pushed along without pushing along others."""
        free = self.model.body.free
        if self.kind == "wrench":
            return np.flatnonzero(self.logged & free & (self.largest > 0.0))
        B = np.where(free[:, None], self.model.body.B, 0.0)
        coupling = np.linalg.norm(B @ np.linalg.pinv(B) - np.eye(len(AXES)), axis=0)
        reachable = (coupling < MAX_CROSS_SHARE) | self._looped
        return np.flatnonzero(reachable & free & (self.logged | (self.kind == "thruster")))

    @cached_property
    def full(self) -> Array:
        """Wrench (6,) that is reached both ways along each axis; 0 where there is none."""
        wrench = np.zeros(len(AXES))
        for i in self.axes:
            wrench[i] = self.largest[i] if self.kind == "wrench" else self._reach(i)
        return wrench

    def _reach(self, axis: int) -> float:
        if self._looped[axis]:
            return abs(float(self._slopes[axis]))
        share = np.linalg.norm(self._parts(self._spread[:, [axis]].T), axis=0)[0]
        limit = np.minimum(self._forces[1][-1], -self._forces[1][0])
        used = share > 1e-6
        return float(np.min(limit[used] / share[used]))

    def values(self, wrench: Array) -> Array:
        """What a log would hold (m, c) for a wrench (m, 6), as far as it goes."""
        if self.kind == "wrench":
            return np.clip(wrench, -self.largest, self.largest)
        along, across = self._parts(wrench @ self._spread.T)
        azimuthing = self.model.thrust_path.thrusters.turning
        force = np.where(azimuthing, np.hypot(along, across), along)
        command = np.stack(
            [
                np.interp(f, curve, c)
                for f, curve, c in zip(force.T, self._forces[1].T, self._forces[0].T, strict=True)
            ],
            axis=1,
        )
        if self.kind == "demand":
            return self._demands(command, wrench)
        angle = np.arctan2(across, along)[:, azimuthing]
        columns = np.empty((len(wrench), self.model.thrust_path.columns("thruster")))
        columns[:, ~self._angles] = command
        columns[:, self._angles] = np.hstack([angle, np.zeros((len(wrench), self._fins))])
        return columns

    def _demands(self, command: Array, wrench: Array) -> Array:
        """Demands (m, 6) that mix to these commands (m, n) as nearly as they can."""
        mixing = self.model.thrust_path.thrusters.mixing
        demands = command @ np.linalg.pinv(mixing).T
        loops = self._looped
        demands[:, loops] = wrench[:, loops] / self._slopes[loops]
        return np.clip(np.where(np.isin(np.arange(6), self.axes), demands, 0.0), -1.0, 1.0)

    def round(self, value: Array) -> Array:
        """Values (m, c) to the digits that a log keeps."""
        return round_as_logged(value, self.kind, self.model.vehicle)

    def drive(self, value: Array) -> Drive:
        """What values (m, c) of a log do to the model in the long run, each for itself."""
        return self.respond(value, 1.0, None)[0]

    def respond(
        self, value: Array, h: float, state: ThrusterState | None
    ) -> tuple[Drive, ThrusterState]:
        """What values (m, c) do over h s, each for itself, without delay.

        `state` of the thrusters is what the call before returned; None: they have settled.
        """
        path = self.model.thrust_path
        thrust = path.at(Commands(np.zeros(len(value)), value, self.kind), 0.0, 1.0)
        # a thruster answers as its column does: those of all flights stand side by side
        force, state = path.respond(thrust.force.reshape(1, -1), h, state)
        thrust = replace(thrust, force=force.reshape(thrust.force.shape))
        return Drive.by(self.model, thrust, 1.0), state

    def commands(self, time: Array, value: Array, at: Array) -> Commands:
        """A log with lines at times (n,) s, of values (k, c) at times (k,) s.

        Angles hold from one to the next: between them they may turn either way.
        """
        latest_lines = latest(time, at + 1e-9)
        lines = np.stack([np.interp(at, time, column) for column in value.T], axis=1)
        if self.kind == "thruster":
            lines[:, self._angles] = value[latest_lines][:, self._angles]
        return Commands(at, self.round(lines), self.kind)

    @cached_property
    def _angles(self) -> Array:
        return np.array(self.model.vehicle.angles, bool)

    @property
    def _fins(self) -> int:
        return len(self.model.vehicle.surfaces)

    @cached_property
    def _spread(self) -> Array:
        """Forces (k, 6) of the components of all thrusters per unit of wrench."""
        allocation = np.zeros((self.model.body.B.shape[1], len(AXES)))
        axes = [i for i in self.axes if not self._looped[i]]
        allocation[:, axes] = np.linalg.pinv(self.model.body.B[axes])
        return allocation

    def _parts(self, force: Array) -> tuple[Array, Array]:
        """Along and aside (m, n) of forces of the components (m, k)."""
        thrusters = self.model.thrust_path.thrusters
        along, across = force[:, : thrusters.count], np.zeros((len(force), thrusters.count))
        across[:, thrusters.turning] = force[:, thrusters.count :]
        return along, across

    @cached_property
    def _forces(self) -> tuple[Array, Array]:
        """Commands (l, n) within the limit, and their static forces (l, n), rising."""
        path = self.model.thrust_path
        limit = self.model.vehicle.thrusters.command_limit if self.kind == "thruster" else 1.0
        command = np.tile(limit * COMMAND_LEVELS[:, None], path.thrusters.count)
        force = path.static(command, np.zeros(len(command)), 1.0)
        order = np.argsort(force, axis=0, kind="stable")
        return np.take_along_axis(command, order, 0), np.take_along_axis(force, order, 0)

    @cached_property
    def _looped(self) -> Array:
        """Axes (6,) whose demands a loop on board takes."""
        loops = self.model.thrust_path.autopilots if self.kind == "demand" else []
        remainder = np.ones(len(AXES))
        for loop in loops:
            remainder = remainder * np.diag(loop.mixer_demand(np.eye(len(AXES))))
        return remainder == 0.0

    @cached_property
    def _slopes(self) -> Array:
        """Wrench (6,) per unit of demand of each axis."""
        return np.diag(self.drive(DEMAND_STEP * np.eye(len(AXES))).wrench) / DEMAND_STEP
