"""An effect as it stands in files: its id, and parameters with standard deviations and units."""

from math import inf
from pathlib import Path
from typing import Annotated, Any, Iterable

from pydantic import BeforeValidator, Field

from rovsim.core.errors import BadInput
from rovsim.core.schema import Number, Section, checked
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect
from rovsim.results.fitted import FittedEffect

# Larger than anything that was ever fitted: a replay with values drawn from it would diverge.
MAX_STD = 1e12


class Value(Section):
    """A parameter's value, its standard deviation and its unit; None: not known."""

    value: Number
    std: Annotated[Number, Field(ge=0.0, le=MAX_STD)] | None = None
    unit: str | None = None


def _with_key(value: Any) -> Any:
    """Accept a bare number as a value without standard deviation and unit."""
    return value if isinstance(value, (dict, Value)) else {"value": value}


class EffectEntry(Section):
    """An effect of a model file; a parameter is a number, or has `value`, `std` and `unit`."""

    effect: str
    parameters: dict[str, Annotated[Value, BeforeValidator(_with_key)]] = Field(
        default_factory=dict
    )

    @staticmethod
    def of(fitted: FittedEffect, source: Path) -> "EffectEntry":
        """The entry of an effect as it was fitted.

        Args:
            fitted: the effect.
            source: the file that it is from, for messages.

        Raises:
            BadInput: a parameter has no value, or a number that no model file may hold.
        """
        return checked(EffectEntry, fitted.model_dump(include={"effect", "parameters"}), source)

    @property
    def values(self) -> dict[str, float]:
        """The values by name of the parameter."""
        return {name: parameter.value for name, parameter in self.parameters.items()}

    def plain(self) -> dict[str, Any]:
        """The content for a file: bare numbers where neither std nor unit is known."""
        parameters = {
            name: v.value if v.std is None and v.unit is None else v.model_dump(exclude_none=True)
            for name, v in self.parameters.items()
        }
        return {"effect": self.effect, "parameters": parameters}


def build_effect(entry: EffectEntry, catalogue: Catalogue) -> Effect:
    """Build the effect that an entry describes.

    Raises:
        BadInput: an unknown effect or parameter, a value out of range, a value of a discrete
            parameter that is not whole, or another unit.
    """
    effect = catalogue.find(entry.effect)(**entry.values)
    _refuse_between(effect, entry)
    units = {p.name: p.unit for p in effect.parameters}
    for name, value in entry.parameters.items():
        if value.unit not in (None, units[name]):
            raise BadInput(
                f"{name} has the unit '{value.unit}'",
                where=f"effect {entry.effect}",
                expected=f"'{units[name]}'",
                remedy="Convert the value, or leave the unit out.",
            )
    std = {name: v.std for name, v in entry.parameters.items() if v.std is not None}
    return effect.with_std(std)


def _refuse_between(effect: Effect, entry: EffectEntry) -> None:
    """Refuse values of discrete parameters that are not whole or above the largest possible."""
    for p in effect.parameters:
        value = entry.values.get(p.name, 0.0)
        if p.discrete and not (value.is_integer() and value <= p.highest):
            raise BadInput(
                f"{p.name} is {value:g}",
                where=f"effect {entry.effect}",
                expected=f"a whole number from {p.low:g} to {p.highest:g}",
                remedy="Thrusters count from 1 in the vehicle file's order; 0 is none of them."
                if p.most < inf
                else "Correct that value.",
            )


def build_effects(entries: Iterable[EffectEntry], catalogue: Catalogue) -> tuple[Effect, ...]:
    """Build the effects that entries describe, see `build_effect`."""
    return tuple(build_effect(entry, catalogue) for entry in entries)


def describe_effect(effect: Effect) -> EffectEntry:
    """The entry of an effect: parameters that were fitted or differ from their default."""
    changed = effect.given()
    values = {
        p.name: Value(value=effect[p.name], std=effect.std[p.name], unit=p.unit)
        if p.name in effect.std
        else Value(value=changed[p.name])
        for p in effect.parameters
        if p.name in changed or p.name in effect.std
    }
    return EffectEntry(effect=effect.id, parameters=values)
