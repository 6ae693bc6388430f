"""How the motion capture reports a true motion: of another point, in other axes, and smoothed."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Iterable

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import Rigid, matrix, multiply, rotate
from rovsim.dynamics.body import cross_matrix
from rovsim.dynamics.low_pass import LowPass, in_body, in_world, unit


@dataclass(frozen=True, eq=False)
class MocapView:
    """Two constant rigid transforms, seen pose = world o true pose o body, and a low-pass.

    "True" is the motion of CO; "seen" is after the transforms; "reported" is after the low-pass as
    well. `poses`, `twists`, `states` and `inverse` belong to the transforms alone, and hold for
    each instant; `report`, `smooth` and `sharpen` apply the low-pass to a whole series. Where
    nothing changes, the same array is returned.

    Attributes:
        world: transform on the world side.
        body: transform on the body side.
        low_pass: of the poses that are seen.
    """

    world: Rigid
    body: Rigid
    low_pass: LowPass

    @staticmethod
    def through(parts: Iterable[tuple[Rigid, Rigid]], low_pass: LowPass) -> "MocapView":
        """Compose transforms (world, body) in order, the first one next to the vehicle."""
        world, body = NO_CHANGE.world, NO_CHANGE.body
        for outer, inner in parts:
            world, body = outer.after(world), body.after(inner)
        return MocapView(world, body, low_pass)

    @cached_property
    def identity(self) -> bool:
        """Whether the transforms change nothing."""
        neutral = np.concatenate(Rigid.by())
        return all(np.array_equal(np.concatenate(t), neutral) for t in (self.world, self.body))

    @cached_property
    def key(self) -> bytes:
        """Bytes that are equal for equal views."""
        return np.concatenate([*self.world, *self.body, self.low_pass.time_constants]).tobytes()

    @cached_property
    def inverse(self) -> "MocapView":
        """The view from seen to true poses, with the same low-pass."""
        return replace(self, world=self.world.inverse, body=self.body.inverse)

    def poses(self, eta: Array) -> Array:
        """Transform true poses (..., 7), position m and quaternion, to seen ones."""
        if self.identity:
            return eta
        position = eta[..., :3] + rotate(eta[..., 3:7], self.body.translation)
        position = rotate(self.world.rotation, position) + self.world.translation
        attitude = multiply(multiply(self.world.rotation, eta[..., 3:7]), self.body.rotation)
        return np.concatenate([position, attitude], axis=-1)

    @cached_property
    def twist(self) -> Array:
        """Matrix (6, 6) from a true body velocity or acceleration to the seen one.

        v + omega x r at the seen point r, rotated into the seen body axes. The transform of the
        world has no influence.
        """
        R, S = matrix(self.body.rotation).T, cross_matrix(self.body.translation)
        return np.block([[R, -R @ S], [np.zeros((3, 3)), R]])

    def twists(self, nu: Array) -> Array:
        """Transform true body velocities or accelerations (..., 6) to seen ones."""
        return nu if self.identity else nu @ self.twist.T

    def states(self, state: Array) -> Array:
        """Transform true states (..., 13), pose and nu, to seen ones."""
        if self.identity:
            return state
        return np.concatenate([self.poses(state[..., :7]), self.twists(state[..., 7:])], axis=-1)

    def report(
        self, state: Array, dt: float | Array, first: Array | None = None, straight: bool = False
    ) -> Array:
        """Reported states (..., n, 13) of a true motion (..., n, 13).

        Args:
            state: true states.
            dt: time between two samples, s: one number or (n-1,).
            first: (stages, ..., 14) initial output of each low-pass, see `LowPass.smooth`.
            straight: see `LowPass.smooth`.
        """
        reported = self.states(state)
        if not self.low_pass.time_constants:
            return reported
        with np.errstate(invalid="ignore", over="ignore"):  # of a model that diverged
            channels = in_world(reported[..., :7], reported[..., 7:])
            smoothed = self.low_pass.smooth(channels, dt, first, straight)
            return np.concatenate(in_body(smoothed), axis=-1)

    def smooth(self, eta: Array, dt: float) -> Array:
        """Reported poses (..., n, 7) of seen ones, dt s apart; at rest before the first."""
        smoothing = self.low_pass.time_constants
        return unit(self.low_pass.smooth(eta, dt)) if smoothing else eta

    def sharpen(self, eta: Array, dt: float) -> Array:
        """Seen poses (n, 7) of reported ones, which must be at the full rate, dt s apart."""
        smoothing = self.low_pass.time_constants
        return unit(self.low_pass.stages(eta, dt)[0]) if smoothing else eta


NO_CHANGE = MocapView(Rigid.by(), Rigid.by(), LowPass())
