"""A model file from a diagnosis."""

from dataclasses import replace
from pathlib import Path
from typing import Container, Sequence

from rovsim.core.errors import BadInput, nearest
from rovsim.core.schema import checked
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import EffectEntry, build_effect, build_model, load_model
from rovsim.results.diagnosis import Diagnosis, FittedEffect


def add_effects(
    diagnosis: Diagnosis,
    source: Path,
    to: str,
    effects: Sequence[str] | None,
    catalogue: Catalogue,
) -> tuple[Model, list[str]]:
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
    return extend(base, [build_effect(entry, there) for entry in entries]), names


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
    model = replace(base, name="new", effects=(*base.effects, *effects))
    _ = model.body.M  # refuse a model that cannot move
    return model
