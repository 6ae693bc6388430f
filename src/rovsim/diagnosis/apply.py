"""A model file from a diagnosis."""

from pathlib import Path
from typing import Container, NamedTuple, Sequence

from rovsim.core.errors import BadInput, nearest
from rovsim.core.schema import checked
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import (
    EffectEntry,
    UncertaintyEntry,
    build_effects,
    build_model,
    describe_model,
    load_model,
    with_uncertainty,
)
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import FittedEffect


class Added(NamedTuple):
    """A model with effects of a diagnosis, their ids, and whether its base was `diagnosed`."""

    model: Model
    names: list[str]
    diagnosed: bool


def add_effects(
    diagnosis: Diagnosis,
    source: Path,
    to: str,
    effects: Sequence[str] | None,
    catalogue: Catalogue,
) -> Added:
    """The base model and the effects named, or selected, with their fitted values.

    Where the catalogue has the effect that the diagnosis proposes, it and what is beside it.

    Raises:
        BadInput: an effect the diagnosis has no values for, or values no model can have.
    """
    known = catalogue if effects is None else dict.fromkeys(effects)
    chosen = choose_effects(diagnosis, known)
    fitted = diagnosis.fitted | {one.effect: one for one in chosen}
    names = [one.effect for one in chosen] if effects is None else list(effects)
    for name in names:
        if name not in fitted:
            raise BadInput(
                f"has no values for '{name}'",
                where=source,
                expected=f"one of {', '.join(fitted)}",
                remedy=nearest(name, fitted),
            )
    vehicle = build_model(diagnosis.base, source, catalogue).vehicle
    base = load_model(to, vehicle, catalogue)
    entries = list_entries([fitted[name] for name in names], source)
    there = catalogue.on(vehicle)
    model = extend(base, build_effects(entries, there))
    model = add_uncertainty(model, names, base, diagnosis, source, there)
    return Added(model, names, was_diagnosed(base, diagnosis))


def was_diagnosed(base: Model, diagnosis: Diagnosis) -> bool:
    """Whether a diagnosis is of that model."""
    return describe_model(base) == diagnosis.base


def add_uncertainty(
    model: Model, names: Sequence[str], base: Model, diagnosis: Diagnosis, source: Path,
    catalogue: Catalogue,
) -> Model:  # fmt: skip
    """The base with effects as they were fitted, and how sure a diagnosis is of them.

    Of a model that it did not end with nothing is known.
    """
    posterior, whole = diagnosis.posterior, sorted(one.effect for one in diagnosis.selected)
    if posterior is None or sorted(names) != whole or not was_diagnosed(base, diagnosis):
        return model
    instead = [
        {
            "probability": one.probability,
            "effects": [entry.plain() for entry in list_entries(one.effects, source)],
            "correlation": one.correlation,
        }
        for one in posterior.instead
    ]
    content = {
        "noise": diagnosis.noise, "correlation": posterior.correlation, "instead": instead,
    }  # fmt: skip
    entry = checked(UncertaintyEntry, content, source)
    return with_uncertainty(model, entry, catalogue, source)


def choose_effects(diagnosis: Diagnosis, known: Container[str]) -> tuple[FittedEffect, ...]:
    """The selected effects; where the law that was proposed is known, it and those beside it."""
    law = diagnosis.unexplained.proposal
    if law is None or law.effect not in known:
        return diagnosis.selected
    return *law.beside, FittedEffect(effect=law.effect, parameters=law.parameters)


def list_entries(fitted: Sequence[FittedEffect], source: Path) -> list[EffectEntry]:
    """Fitted effects of a diagnosis as entries of a model file."""
    return [
        checked(
            EffectEntry,
            {
                "effect": one.effect,
                "parameters": {k: v.model_dump() for k, v in one.parameters.items()},
            },
            source,
        )
        for one in fitted
    ]


def extend(base: Model, effects: Sequence[Effect]) -> Model:
    """The base with further effects, called new.

    Raises:
        BadInput: values no model can have.
    """
    model = base.with_effects((*base.effects, *effects)).called("new")
    _ = model.M  # refuse a model that cannot move
    return model
