"""A model: a vehicle, a list of further effects, and perhaps a trained residual. They add."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, Literal

import numpy as np
from numpy import ndarray as Array
from pydantic import BeforeValidator, Field

from rovsim.core.errors import BadInput, nearest
from rovsim.core.files import plain, read_yaml, write_yaml
from rovsim.core.run import CommandKind, Site
from rovsim.core.schema import Number, Section, checked
from rovsim.dynamics.actuation import ThrustPath
from rovsim.dynamics.body import Body, packed
from rovsim.dynamics.effects import effect
from rovsim.dynamics.effects.base import Coefficients, Effect, Sensing, Wrench
from rovsim.dynamics.engine.compiled import engine
from rovsim.dynamics.engine.types import Constants
from rovsim.dynamics.learned.residual import Residual, StoredResidual, read_residual
from rovsim.dynamics.mocap_view import MocapView
from rovsim.dynamics.vehicle import Thrusters, Vehicle, check_layout, known_vehicle, load_vehicle

SCHEMA = "rovsim.model/1"


class Value(Section):
    """A parameter's value with what is known of it."""

    value: Number
    std: Number | None = None
    unit: str | None = None


def _with_key(value: Any) -> Any:
    """A bare number is a value nothing more is known of."""
    return value if isinstance(value, (dict, Value)) else {"value": value}


class EffectEntry(Section):
    """One effect of a model file; a parameter is a number, or a `value` with `std` and `unit`."""

    effect: str
    parameters: dict[str, Annotated[Value, BeforeValidator(_with_key)]] = Field(
        default_factory=dict
    )

    def build(self) -> Effect:
        """The effect with these values.

        Raises:
            BadInput: an unknown effect or parameter, a value out of range, another unit.
        """
        found = effect(self.effect)(**{name: v.value for name, v in self.parameters.items()})
        units = {p.name: p.unit for p in found.parameters}
        for name, value in self.parameters.items():
            if value.unit not in (None, units[name]):
                raise BadInput(
                    f"{name} has the unit '{value.unit}'",
                    where=f"effect {self.effect}",
                    expected=f"'{units[name]}'",
                    remedy="Convert the value, or leave the unit out.",
                )
        return found

    def plain(self) -> dict[str, Any]:
        """As it is written: numbers alone where nothing more is known."""
        known = {
            name: v.value if v.std is None and v.unit is None else v.model_dump(exclude_none=True)
            for name, v in self.parameters.items()
        }
        return {"effect": self.effect, "parameters": known}


class ModelFile(Section):
    """A model file as it stands on disk: data only."""

    schema_: Literal["rovsim.model/1"] = Field("rovsim.model/1", alias="schema")
    vehicle: str | dict[str, Any]
    effects: tuple[EffectEntry, ...] = ()
    residual: dict[str, Any] | None = None
    provenance: dict[str, Any] | None = None


@dataclass(frozen=True, eq=False)
class Model:
    """A vehicle and what was added to its nominal physics."""

    name: str
    vehicle: Vehicle
    entries: tuple[EffectEntry, ...] = ()
    residual: Residual | None = None
    inert: bool = False  # keeps its body velocity whatever pushes: the baseline to beat
    unlisted: tuple[Effect, ...] = ()  # physics that no model file can name

    def __add__(self, added: Effect) -> "Model":
        if not added.listed:
            return replace(self, unlisted=(*self.unlisted, added))
        entry = EffectEntry(
            effect=added.id, parameters={k: Value(value=v) for k, v in added.given().items()}
        )
        return replace(self, entries=(*self.entries, entry))

    def called(self, name: str) -> "Model":
        """The same model under another name."""
        return replace(self, name=name)

    @cached_property
    def effects(self) -> list[Effect]:
        """All effects: the nominal ones of the vehicle, then the added ones."""
        return [*self.vehicle.effects(), *(e.build() for e in self.entries), *self.unlisted]

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
        return self.body.least_inertia > 0.0

    @cached_property
    def constants(self) -> Constants:
        """The same, packed for the engine."""
        constants = packed([self.body])
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
            wrench = wrench + loop.asked(demand, np.diag(self.body.M))
        return wrench

    @cached_property
    def wrenches(self) -> list[Wrench]:
        """Effects evaluated at every instant."""
        return [e for e in self.effects if isinstance(e, Wrench)]

    @cached_property
    def mocap_view(self) -> MocapView:
        """What the motion capture makes of the true motion."""
        sensing = sorted((e for e in self.effects if isinstance(e, Sensing)), key=lambda e: e.rank)
        return MocapView.through(e.transforms() for e in sensing)

    def check(self, site: Site, kind: CommandKind) -> None:
        """Refuse a run that lacks what an effect needs.

        Raises:
            BadInput: says what is missing.
        """
        for one in self.effects:
            one.check(site, kind)

    @cached_property
    def engine(self) -> ModuleType:
        """The compiled equation of motion with these wrench effects."""
        return engine([type(wrench) for wrench in self.wrenches])

    def wrench_parameters(self) -> Array:
        """Their parameters (k,), one after the other."""
        return np.concatenate([np.zeros(0), *(e.values for e in self.wrenches)])

    def content(self) -> dict[str, Any]:
        """A model file's content, without a residual."""
        name = self.vehicle.name
        known = known_vehicle(name) is not None and load_vehicle(name) == self.vehicle
        content: dict[str, Any] = {"schema": SCHEMA}
        content["vehicle"] = name if known else self.vehicle.model_dump(mode="json")
        content["effects"] = [entry.plain() for entry in self.entries]
        return content

    def write(
        self, path: Path, residual: StoredResidual | None = None, provenance: dict | None = None
    ):
        """Write a model file; `residual` describes arrays that lie beside it."""
        content = self.content()
        content |= {"residual": residual.model_dump(mode="json")} if residual else {}
        content |= {"provenance": plain(provenance)} if provenance else {}
        write_yaml(path, content)


def nominal(vehicle: Vehicle) -> Model:
    """The model every comparison starts from."""
    return Model("nominal", vehicle)


def zero_acceleration(vehicle: Vehicle) -> Model:
    """The baseline: a vehicle that keeps its body velocity."""
    return Model("zero_acceleration", vehicle, inert=True)


BUILT_IN = {"nominal": nominal, "zero_acceleration": zero_acceleration}


def load_model(spec: str, vehicle: Vehicle) -> Model:
    """A built-in model of this vehicle, or the model of a file, called by the file's stem.

    Raises:
        BadInput: no such file, or it does not describe a model.
    """
    if spec in BUILT_IN:
        return BUILT_IN[spec](vehicle)
    if not Path(spec).suffix and not Path(spec).exists():
        raise BadInput(
            f"unknown model '{spec}'",
            where="model",
            expected=f"{' or '.join(BUILT_IN)}, or the path of a model file",
            remedy=nearest(spec, BUILT_IN),
        )
    return read_model(Path(spec))


def read_model(path: Path) -> Model:
    """Read a model file.

    Raises:
        BadInput: it is missing, or something in it is unknown or out of range.
    """
    return model_of(read_yaml(path), path)


def model_of(content: Any, path: Path) -> Model:
    """The model of a file's content.

    Raises:
        BadInput: something in it is unknown or out of range.
    """
    file = checked(ModelFile, content, path)
    if isinstance(file.vehicle, str):
        vehicle = load_vehicle(file.vehicle, beside=path.parent)
    else:
        vehicle = checked(Vehicle, file.vehicle, f"{path}, vehicle")
        check_layout(vehicle, path)
    residual = read_residual(file.residual, path.parent) if file.residual else None
    model = Model(path.stem, vehicle, file.effects, residual)
    _ = model.body.M, model.effects  # refuse a model that cannot move
    return model
