"""Make a model with the effects that a diagnosis found, as `rovsim add` writes it."""

from pathlib import Path
from typing import Collection, Container, NamedTuple, Sequence

from rovsim.core.errors import BadInput, unlisted
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
    """A model with effects of a diagnosis.

    Attributes:
        model: the base with these effects.
        names: ids of the effects.
        diagnosed: whether the base is the model that was diagnosed.
        one_by_one: whether there are several effects, some of which were fitted without the others.
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
    """Add effects of a diagnosis to a model, at their fitted values.

    Args:
        diagnosis: the diagnosis.
        source: its file, for messages.
        to: the model file to which the effects are added.
        effects: ids of the effects. If None, all selected ones; or the proposed law and the effects
            beside it, if the catalogue has that law.
        catalogue: all effects, the user's own included.

    Raises:
        BadInput: the diagnosis has no values for an effect, an effect is named twice, the base has
            it at these values already, or no model can have the values.
    """
    available = catalogue if effects is None else dict.fromkeys(effects)
    selected = choose_effects(diagnosis, available)
    by_name = diagnosis.fitted | {e.effect: e for e in selected}
    names = [e.effect for e in selected] if effects is None else list(effects)
    _check_names(names, by_name, source)
    vehicle = build_model(diagnosis.base, source, catalogue).vehicle
    base = load_model(to, vehicle, catalogue)
    if base.inert:
        raise BadInput(
            "keeps its velocity whatever acts on it",
            where=f"to={to}",
            expected="a model of physics, that effects can change",
            remedy="Add them to=nominal, or to a model file.",
        )
    entries = [EffectEntry.of(by_name[name], source) for name in names]
    on_vehicle = catalogue.on(base.vehicle)
    new_effects = build_effects(entries, on_vehicle)
    _refuse_again(new_effects, base, to)
    model = extend(base, new_effects)
    model = add_uncertainty(model, names, base, diagnosis, source, on_vehicle)
    joint_names = {e.effect for e in selected}
    separately = len(names) > 1 and not joint_names.issuperset(names)
    return Added(model, names, was_diagnosed(base, diagnosis), separately)


def _check_names(names: Sequence[str], fitted: Collection[str], source: Path) -> None:
    """Refuse effects for which a diagnosis has no values, and effects that are named twice."""
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
    """Refuse an effect that the base has at exactly these values: it would act twice."""
    present = [(e.id, e.given()) for e in base.added if e.given()]
    for effect in effects:
        if (effect.id, effect.given()) in present:
            raise BadInput(
                f"has {effect.id} at these values already",
                where=to,
                expected="a model to which this diagnosis was not added yet",
                remedy="Name that one with to=, or the other effects with effects=[…].",
            )


def was_diagnosed(base: Model, diagnosis: Diagnosis) -> bool:
    """Whether a model is the one that was diagnosed."""
    return describe_model(base) == diagnosis.base


def add_uncertainty(
    model: Model,
    names: Sequence[str],
    base: Model,
    diagnosis: Diagnosis,
    source: Path,
    catalogue: Catalogue,
) -> Model:
    """Add to a model how sure the diagnosis is of its effects.

    This is known only if the model is what the diagnosis ended with: the base that was diagnosed
    and all selected effects. Any other model is returned as it is.

    Args:
        model: the base with effects at their fitted values.
        names: ids of these effects.
        base: the model without them.
        diagnosis: the diagnosis.
        source: its file, for messages.
        catalogue: the effects that the vehicle can have.
    """
    posterior, diagnosed = diagnosis.posterior, sorted(item.effect for item in diagnosis.selected)
    if posterior is None or sorted(names) != diagnosed or not was_diagnosed(base, diagnosis):
        return model
    entry = UncertaintyEntry.of(posterior, diagnosis.noise, source)
    return with_uncertainty(model, entry, catalogue, source)


def choose_effects(diagnosis: Diagnosis, known_ids: Container[str]) -> tuple[FittedEffect, ...]:
    """Choose the selected effects; if a proposed law is known, it and the effects beside it."""
    law = diagnosis.unexplained.proposal
    if law is None or law.effect not in known_ids:
        return diagnosis.selected
    return *law.beside, FittedEffect(effect=law.effect, parameters=law.parameters)


def extend(base: Model, effects: Sequence[Effect]) -> Model:
    """Add further effects to a model, and name the result "new".

    Raises:
        BadInput: no model can have these values.
    """
    model = base.with_added((*base.added, *effects)).called("new")
    _ = model.M  # raises if the inertia matrix is impossible
    return model
