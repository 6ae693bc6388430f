"""An effect as files name it: its name, and its parameters with what is known of them."""

from math import inf
from typing import Annotated, Any, Iterable

from pydantic import BeforeValidator, Field

from rovsim.core.errors import BadInput
from rovsim.core.schema import Number, Section
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect

# Larger than anything that was ever fitted: no replay survives what is drawn from it.
VAGUEST = 1e12  # a standard deviation


class Value(Section):
    """A parameter's value with what is known of it."""

    value: Number
    std: Annotated[Number, Field(ge=0.0, le=VAGUEST)] | None = None
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

    @property
    def values(self) -> dict[str, float]:
        """The values alone, by parameter."""
        return {name: known.value for name, known in self.parameters.items()}

    def plain(self) -> dict[str, Any]:
        """As it is written: numbers alone where nothing more is known."""
        known = {
            name: v.value if v.std is None and v.unit is None else v.model_dump(exclude_none=True)
            for name, v in self.parameters.items()
        }
        return {"effect": self.effect, "parameters": known}


def build_effect(entry: EffectEntry, catalogue: Catalogue) -> Effect:
    """The effect that an entry describes.

    Raises:
        BadInput: an unknown effect or parameter, a value out of range or between those that it may
            have, another unit.
    """
    found = catalogue.find(entry.effect)(**entry.values)
    _refuse_between(found, entry)
    units = {p.name: p.unit for p in found.parameters}
    for name, known in entry.parameters.items():
        if known.unit not in (None, units[name]):
            raise BadInput(
                f"{name} has the unit '{known.unit}'",
                where=f"effect {entry.effect}",
                expected=f"'{units[name]}'",
                remedy="Convert the value, or leave the unit out.",
            )
    std = {name: v.std for name, v in entry.parameters.items() if v.std is not None}
    return found.with_std(std)


def _refuse_between(effect: Effect, entry: EffectEntry) -> None:
    """Refuse what is no number of something, or of something that is not there."""
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
    """The effects that entries describe; see `build_effect`."""
    return tuple(build_effect(entry, catalogue) for entry in entries)


def describe_effect(effect: Effect) -> EffectEntry:
    """The entry of an effect: what differs from the default, and what was fitted."""
    given = effect.given()
    values = {
        p.name: Value(value=effect[p.name], std=effect.std[p.name], unit=p.unit)
        if p.name in effect.std
        else Value(value=given[p.name])
        for p in effect.parameters
        if p.name in given or p.name in effect.std
    }
    return EffectEntry(effect=effect.id, parameters=values)
