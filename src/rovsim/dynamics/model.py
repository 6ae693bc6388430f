"""A model: a vehicle, effects, and perhaps a trained residual. They add."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.model_names import NOMINAL, ZERO_ACCELERATION
from rovsim.core.run import CommandKind, Site
from rovsim.dynamics.actuation import ThrustPath
from rovsim.dynamics.body import Body, packed
from rovsim.dynamics.effects.base import (
    Coefficients,
    Effect,
    FrameMisalignment,
    MeasurementFilter,
    Wrench,
)
from rovsim.dynamics.engine.types import Constants
from rovsim.dynamics.learned.residual import Residual
from rovsim.dynamics.low_pass import LowPass
from rovsim.dynamics.mocap_view import NO_CHANGE, MocapView
from rovsim.dynamics.uncertainty import Uncertainty
from rovsim.dynamics.vehicle import Thrusters, Vehicle

TRIES = 20  # draws of a model until one is possible


@dataclass(frozen=True, eq=False)
class Model:
    """Physical effects of a vehicle, and perhaps a learned residual on top of them.

    `effects` are all that act: the nominal ones of the vehicle first (`nominal` puts them there),
    then those that were added, in order. `uncertainty` of those added, where they were fitted.
    """

    name: str
    vehicle: Vehicle
    effects: tuple[Effect, ...]
    residual: Residual | None = None
    inert: bool = False  # keeps its body velocity whatever pushes: the baseline to beat
    uncertainty: Uncertainty | None = None

    def __add__(self, added: Effect) -> "Model":
        return self.with_effects((*self.effects, added))

    def with_effects(self, effects: Sequence[Effect]) -> "Model":
        """The same with other effects; how sure these are is not known."""
        return replace(self, effects=tuple(effects), uncertainty=None)

    def draw(self, random: np.random.Generator) -> "Model":
        """The model as it may as well be; as it is where its uncertainty is not known.

        Values no body can have are drawn again.
        """
        if self.uncertainty is None:
            return self
        for _ in range(TRIES):
            nominal, drawn = self.vehicle.effects(), self.uncertainty.draw(random)
            found = self.with_effects((*nominal, *drawn))
            if found.possible:
                return found
        return self

    def called(self, name: str) -> "Model":
        """The same model under another name."""
        return replace(self, name=name)

    @cached_property
    def added(self) -> tuple[Effect, ...]:
        """What was added to the nominal effects of the vehicle."""
        return self.effects[len(self.vehicle.effects()) :]

    @cached_property
    def body(self) -> Body:
        """Constants of the equation of motion."""
        body = Body(gravity=self.vehicle.fluid.gravity)
        for one in self.effects:
            if isinstance(one, Coefficients):
                one.enter(body)
        return body

    @cached_property
    def possible(self) -> bool:
        """Whether such a body can exist."""
        return self.body.possible

    @cached_property
    def M(self) -> Array:
        """Total inertia (6, 6).

        Raises:
            BadInput: see `Body.M`.
        """
        return self.body.M

    @cached_property
    def constants(self) -> Constants:
        """The constants of the equation of motion, packed for the engine."""
        constants = packed(self.body)
        return constants._replace(M_inv=0.0 * constants.M_inv) if self.inert else constants

    @cached_property
    def thrust_path(self) -> ThrustPath:
        """From commands to thruster forces."""
        thrusters = next(e for e in self.effects if isinstance(e, Thrusters))
        return ThrustPath(thrusters, self.effects)

    def actuated(self, force: Array, demand: Array) -> Array:
        """Wrench (k, 6) of thruster forces (k, n), and of loops that took demands (k, 6)."""
        wrench = force @ self.body.B.T
        for loop in self.thrust_path.autopilots:
            wrench = wrench + loop.demanded_wrench(demand, np.diag(self.M))
        return wrench

    @cached_property
    def wrenches(self) -> list[Wrench]:
        """Effects evaluated at every instant."""
        return [e for e in self.effects if isinstance(e, Wrench)]

    @cached_property
    def mocap_view(self) -> MocapView:
        """What the motion capture makes of the true motion."""
        frames = [e for e in self.effects if isinstance(e, FrameMisalignment)]
        filters = [e for e in self.effects if isinstance(e, MeasurementFilter)]
        if not frames and not filters:
            return NO_CHANGE
        low_pass = LowPass(tuple(T for e in filters for T in e.time_constants()))
        ranked = sorted(frames, key=lambda e: e.rank)
        return MocapView.through((e.transforms() for e in ranked), low_pass)

    def check(self, site: Site, kind: CommandKind) -> None:
        """Refuse a run that lacks what an effect needs.

        Raises:
            BadInput: says what is missing.
        """
        for one in self.effects:
            one.check(site, kind)


def nominal(vehicle: Vehicle) -> Model:
    """The model every comparison starts from."""
    return Model(NOMINAL, vehicle, vehicle.effects())


def zero_acceleration(vehicle: Vehicle) -> Model:
    """The baseline: a vehicle that keeps its body velocity."""
    return Model(ZERO_ACCELERATION, vehicle, vehicle.effects(), inert=True)


def built_in_model(name: str, vehicle: Vehicle) -> Model:
    """The one of `core.model_names.BUILT_IN` with this name."""
    return {NOMINAL: nominal, ZERO_ACCELERATION: zero_acceleration}[name](vehicle)


BASELINES = (ZERO_ACCELERATION, NOMINAL)  # what every comparison of a study begins with
