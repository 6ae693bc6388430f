"""A model file from a diagnosis."""

from dataclasses import replace
from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.core.errors import BadInput, nearest
from rovsim.core.files import read_json
from rovsim.core.schema import checked
from rovsim.diagnosis.result import SCHEMA
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import EffectEntry, build_effect, build_model, load_model


def read_diagnosis(path: Path) -> dict[str, Any]:
    """Read diagnosis.json.

    Raises:
        BadInput: it is missing, or it is not a diagnosis.
    """
    found = read_json(path)
    parts = ("selected", "ranking", "base")
    if isinstance(found, dict) and found.get("schema") == SCHEMA and all(k in found for k in parts):
        return found
    raise BadInput(
        "is not a diagnosis of this program",
        where=path,
        expected=f"what `rovsim diagnose` wrote, its schema {SCHEMA}",
        remedy="Run `rovsim diagnose` again.",
    )


def added(
    diagnosis: dict[str, Any],
    source: Path,
    to: str,
    effects: Sequence[str] | None,
    catalogue: Catalogue,
) -> tuple[Model, list[str]]:
    """The base model and the effects named, or selected, with their fitted values.

    Raises:
        BadInput: an effect the diagnosis has no values for, or values no model can have.
    """
    fitted = {one["effect"]: one for one in diagnosis["ranking"]}
    fitted |= {one["effect"]: one for one in diagnosis["selected"]}
    names = [one["effect"] for one in diagnosis["selected"]] if effects is None else list(effects)
    for name in names:
        if name not in fitted:
            raise BadInput(
                f"has no values for '{name}'",
                where=source,
                expected=f"one of {', '.join(fitted)}",
                remedy=nearest(name, fitted),
            )
    vehicle = build_model(diagnosis["base"], source, catalogue).vehicle
    base = load_model(to, vehicle, catalogue)
    entries = entries_of([fitted[name] for name in names], source)
    return extended(base, [build_effect(entry, catalogue) for entry in entries]), names


def entries_of(fitted: Sequence[Mapping[str, Any]], source: Path) -> list[EffectEntry]:
    """Fitted effects of a diagnosis as entries of a model file."""
    return [
        checked(EffectEntry, {k: one[k] for k in ("effect", "parameters")}, source)
        for one in fitted
    ]


def extended(base: Model, effects: Sequence[Effect]) -> Model:
    """The base with further effects, called new.

    Raises:
        BadInput: values no model can have.
    """
    model = replace(base, name="new", effects=(*base.effects, *effects))
    _ = model.body.M  # refuse a model that cannot move
    return model
