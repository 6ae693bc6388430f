"""A model file from a diagnosis."""

from pathlib import Path
from typing import Collection, Container, NamedTuple, Sequence

from rovsim.core.errors import BadInput, unlisted
from rovsim.core.schema import checked
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effect_entry import EffectEntry, build_effects
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import (
    UncertaintyEntry,
    build_model,
    describe_model,
    load_model,
    with_uncertainty,
)
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import FittedEffect


class Added(NamedTuple):
    """A model with effects of a diagnosis, their ids, and whether its base was `diagnosed`.

    `one_by_one`: several, some of whose values were found without the others.
    """

    model: Model
    names: list[str]
    diagnosed: bool
    one_by_one: bool


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
        BadInput: an effect the diagnosis has no values for, that is named twice or that the base
            has already, or values no model can have.
    """
    known = catalogue if effects is None else dict.fromkeys(effects)
    chosen = choose_effects(diagnosis, known)
    fitted = diagnosis.fitted | {one.effect: one for one in chosen}
    names = [one.effect for one in chosen] if effects is None else list(effects)
    _check_names(names, fitted, source)
    vehicle = build_model(diagnosis.base, source, catalogue).vehicle
    base = load_model(to, vehicle, catalogue)
    entries = list_entries([fitted[name] for name in names], source)
    there = catalogue.on(vehicle)
    effects_there = build_effects(entries, there)
    _refuse_again(effects_there, base, to)
    model = extend(base, effects_there)
    model = add_uncertainty(model, names, base, diagnosis, source, there)
    together = {one.effect for one in chosen}
    one_by_one = len(names) > 1 and not together.issuperset(names)
    return Added(model, names, was_diagnosed(base, diagnosis), one_by_one)


def _check_names(names: Sequence[str], fitted: Collection[str], source: Path) -> None:
    """Refuse a name that a diagnosis has no values for, and one that comes twice."""
    for k, name in enumerate(names):
        if name not in fitted:
            raise unlisted(name, fitted, found=f"has no values for '{name}'", where=source)
        if name in names[:k]:
            raise BadInput(
                f"'{name}' is named twice",
                where="effects",
                expected="each effect once, for it would act twice",
                remedy="Leave one of them out.",
            )


def _refuse_again(effects: Sequence[Effect], base: Model, to: str) -> None:
    """Refuse an effect that the base has at the very same values: it would act twice."""
    there = [(one.id, one.given()) for one in base.added if one.given()]
    for effect in effects:
        if (effect.id, effect.given()) in there:
            raise BadInput(
                f"has {effect.id} at these values already",
                where=to,
                expected="a model to which this diagnosis was not added yet",
                remedy="Name that one with to=, or the other effects with effects=[…].",
            )


def was_diagnosed(base: Model, diagnosis: Diagnosis) -> bool:
    """Whether a diagnosis is of that model."""
    return describe_model(base) == diagnosis.base


def add_uncertainty(
    model: Model,
    names: Sequence[str],
    base: Model,
    diagnosis: Diagnosis,
    source: Path,
    catalogue: Catalogue,
) -> Model:
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
        "noise": diagnosis.noise,
        "correlation": posterior.correlation,
        "instead": instead,
    }
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
