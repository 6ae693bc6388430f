"""A model: a vehicle, the effects that act on it, and perhaps a learned residual."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Iterable

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

MAX_DRAWS = 20  # draws of a model, at most, until one has a possible body


@dataclass(frozen=True, eq=False)
class Model:
    """Physical effects of a vehicle, and perhaps a learned residual on top of them.

    Attributes:
        name: of the model.
        vehicle: the vehicle.
        vehicle_effects: the nominal physics, see `Vehicle.effects`.
        added: effects that were added to it, in order.
        residual: learned acceleration residual; None if there is none.
        inert: whether the body velocity is constant whatever the forces: the baseline.
        uncertainty: of the added effects; None where they were not fitted.
    """

    name: str
    vehicle: Vehicle
    vehicle_effects: tuple[Effect, ...]
    added: tuple[Effect, ...] = ()
    residual: Residual | None = None
    inert: bool = False
    uncertainty: Uncertainty | None = None

    def __add__(self, added: Effect) -> "Model":
        return self.with_added((*self.added, added))

    def with_added(self, effects: Iterable[Effect]) -> "Model":
        """The same model with other added effects, of unknown uncertainty."""
        return replace(self, added=tuple(effects), uncertainty=None)

    def with_effect(self, k: int, effect: Effect) -> "Model":
        """The same model with another effect in the place of number k of all `effects`."""
        effects, count = [*self.effects], len(self.vehicle_effects)
        effects[k] = effect
        vehicle_effects = tuple(effects[:count])
        return replace(self, vehicle_effects=vehicle_effects).with_added(effects[count:])

    def draw(self, random: np.random.Generator) -> "Model":
        """Draw the added effects from the model's uncertainty; unchanged where that is not known.

        Draws with an impossible body, such as negative inertia, are repeated.
        """
        if self.uncertainty is None:
            return self
        for _ in range(MAX_DRAWS):
            model = self.with_added(self.uncertainty.draw(random))
            if model.possible:
                return model
        return self

    def called(self, name: str) -> "Model":
        """The same model under another name."""
        return replace(self, name=name)

    @cached_property
    def effects(self) -> tuple[Effect, ...]:
        """All effects: those of the vehicle, then the added ones."""
        return (*self.vehicle_effects, *self.added)

    @cached_property
    def body(self) -> Body:
        """Constants of the equation of motion."""
        body = Body(gravity=self.vehicle.fluid.gravity)
        for effect in self.effects:
            if isinstance(effect, Coefficients):
                effect.enter(body)
        return body

    @cached_property
    def possible(self) -> bool:
        """Whether such a body can exist, see `Body.possible`."""
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
        """The path from logged commands to thruster forces."""
        thrusters = next(e for e in self.effects if isinstance(e, Thrusters))
        return ThrustPath(thrusters, self.effects)

    def actuated(self, force: Array, demand: Array) -> Array:
        """Wrench (k, 6) of thruster forces (k, n), and of control loops on demands (k, 6)."""
        wrench = force @ self.body.B.T
        for loop in self.thrust_path.autopilots:
            wrench = wrench + loop.demanded_wrench(demand, np.diag(self.M))
        return wrench

    @cached_property
    def wrenches(self) -> list[Wrench]:
        """Wrench effects, which are evaluated at every instant."""
        return [e for e in self.effects if isinstance(e, Wrench)]

    @cached_property
    def mocap_view(self) -> MocapView:
        """How the motion capture reports the true motion: frames and low-passes."""
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
        for effect in self.effects:
            effect.check(site, kind)


def nominal(vehicle: Vehicle) -> Model:
    """The model of the vehicle file alone, with which every comparison starts."""
    return Model(NOMINAL, vehicle, vehicle.effects())


def zero_acceleration(vehicle: Vehicle) -> Model:
    """The baseline: a vehicle whose body velocity is constant."""
    return Model(ZERO_ACCELERATION, vehicle, vehicle.effects(), inert=True)


def built_in_model(name: str, vehicle: Vehicle) -> Model:
    """The built-in model with this name, of `core.model_names.BUILT_IN`."""
    return {NOMINAL: nominal, ZERO_ACCELERATION: zero_acceleration}[name](vehicle)


BASELINES = (ZERO_ACCELERATION, NOMINAL)  # what every comparison of a study begins with
