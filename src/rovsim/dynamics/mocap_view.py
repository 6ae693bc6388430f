"""What the motion capture reports of a true motion: another body point, other axes, smoothed."""

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
    """Seen pose = world o true pose o body, with two constant rigid transforms; then smoothed.

    `poses`, `twists`, `states` and the inverse are those of the transforms alone, at one instant;
    what has to do with the low-pass takes a whole series. Where nothing is changed, arrays come
    back as they are.
    """

    world: Rigid
    body: Rigid
    low_pass: LowPass

    @staticmethod
    def through(parts: Iterable[tuple[Rigid, Rigid]], low_pass: LowPass) -> "MocapView":
        """All parts in order, the first one next to the vehicle."""
        world, body = NO_CHANGE.world, NO_CHANGE.body
        for outer, inner in parts:
            world, body = outer.after(world), body.after(inner)
        return MocapView(world, body, low_pass)

    @cached_property
    def identity(self) -> bool:
        """Whether the transforms change nothing."""
        none = np.concatenate(Rigid.by())
        return all(np.array_equal(np.concatenate(one), none) for one in (self.world, self.body))

    @cached_property
    def key(self) -> bytes:
        """The same for equal views."""
        return np.concatenate([*self.world, *self.body, self.low_pass.time_constants]).tobytes()

    @cached_property
    def inverse(self) -> "MocapView":
        """From seen to true."""
        return replace(self, world=self.world.inverse, body=self.body.inverse)

    def poses(self, eta: Array) -> Array:
        """Poses (..., 7) as this view shows them."""
        if self.identity:
            return eta
        place = eta[..., :3] + rotate(eta[..., 3:7], self.body.translation)
        place = rotate(self.world.rotation, place) + self.world.translation
        attitude = multiply(multiply(self.world.rotation, eta[..., 3:7]), self.body.rotation)
        return np.concatenate([place, attitude], axis=-1)

    @cached_property
    def twist(self) -> Array:
        """Matrix (6, 6) from a body velocity or acceleration to the one this view shows.

        v + omega x r at the place r, turned into the axes there. The world side drops out.
        """
        R, S = matrix(self.body.rotation).T, cross_matrix(self.body.translation)
        return np.block([[R, -R @ S], [np.zeros((3, 3)), R]])

    def twists(self, nu: Array) -> Array:
        """Body velocities or accelerations (..., 6) as this view shows them."""
        return nu if self.identity else nu @ self.twist.T

    def states(self, state: Array) -> Array:
        """States (..., 13) as this view shows them."""
        if self.identity:
            return state
        return np.concatenate([self.poses(state[..., :7]), self.twists(state[..., 7:])], axis=-1)

    def report(
        self, state: Array, dt: float | Array, first: Array | None = None, straight: bool = False
    ) -> Array:
        """States (..., n, 13) of a true motion, dt s apart, as they are reported.

        `dt` (n-1,), `first` (stages, ..., 14) and `straight`: see `LowPass.smooth`.
        """
        seen = self.states(state)
        if not self.low_pass.time_constants:
            return seen
        with np.errstate(invalid="ignore", over="ignore"):  # of a model that diverged
            channels = in_world(seen[..., :7], seen[..., 7:])
            smoothed = self.low_pass.smooth(channels, dt, first, straight)
            return np.concatenate(in_body(smoothed), axis=-1)

    def smooth(self, eta: Array, dt: float) -> Array:
        """Poses (..., n, 7) that were seen, dt s apart, as they are reported; first still."""
        smoothing = self.low_pass.time_constants
        return unit(self.low_pass.smooth(eta, dt)) if smoothing else eta

    def sharpen(self, eta: Array, dt: float) -> Array:
        """Poses (n, 7) that were seen, of reported ones at the full rate, dt s apart."""
        smoothing = self.low_pass.time_constants
        return unit(self.low_pass.stages(eta, dt)[0]) if smoothing else eta


NO_CHANGE = MocapView(Rigid.by(), Rigid.by(), LowPass())
