"""What the motion capture reports of a true motion: another body point, other axes."""

from dataclasses import dataclass
from functools import cached_property
from typing import Iterable

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import Rigid, matrix, multiply, rotate
from rovsim.dynamics.body import cross_matrix


@dataclass(frozen=True, eq=False)
class MocapView:
    """Reported pose = world o true pose o body, with two constant rigid transforms.

    The inverse turns what was reported into what was true. Where both transforms are identities,
    arrays come back as they are.
    """

    world: Rigid
    body: Rigid

    @staticmethod
    def through(parts: Iterable[tuple[Rigid, Rigid]]) -> "MocapView":
        """All parts in order, the first one next to the vehicle."""
        world, body = Rigid.by(), Rigid.by()
        for outer, inner in parts:
            world, body = outer.after(world), body.after(inner)
        return MocapView(world, body)

    @cached_property
    def identity(self) -> bool:
        """Whether nothing is changed."""
        none = np.concatenate(Rigid.by())
        return all(np.array_equal(np.concatenate(one), none) for one in (self.world, self.body))

    @cached_property
    def key(self) -> bytes:
        """The same for equal views."""
        return np.concatenate([*self.world, *self.body]).tobytes()

    @cached_property
    def inverse(self) -> "MocapView":
        """From reported to true."""
        return MocapView(self.world.inverse, self.body.inverse)

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
