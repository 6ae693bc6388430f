"""Model files, read and written: nothing else knows what stands in one."""

from dataclasses import replace
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from rovsim.core.errors import BadInput, located, nearest
from rovsim.core.files import plain
from rovsim.core.model_names import BUILT_IN
from rovsim.core.names import name_of
from rovsim.core.schema import PathText, Section, checked
from rovsim.core.yaml_files import read_yaml, write_yaml
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effect_entry import EffectEntry, build_effects, describe_effect
from rovsim.dynamics.learned.residual import StoredResidual, read_residual
from rovsim.dynamics.model import Model, built_in_model
from rovsim.dynamics.uncertainty import Draws, Uncertainty
from rovsim.dynamics.vehicle import Vehicle, build_vehicle, known_vehicle, load_vehicle
from rovsim.results.fitted import Correlation, FittedNoise, Probability

SCHEMA = "rovsim.model/1"
# Noise, m/s2, rad/s2, m, rad, larger than was ever fitted: no replay survives what is drawn.
WILDEST = 1e3


class PossibilityEntry(Section):
    """Effects that may act instead, and how likely they are."""

    probability: Probability
    effects: tuple[EffectEntry, ...]
    correlation: Correlation = Correlation()


class UncertaintyEntry(Section):
    """How sure the effects of a model file are: see `rovsim.dynamics.uncertainty`."""

    noise: FittedNoise
    correlation: Correlation = Correlation()
    instead: tuple[PossibilityEntry, ...] = ()

    @model_validator(mode="after")
    def _leaves_something(self) -> Self:
        if sum(other.probability for other in self.instead) > 1.0:
            raise ValueError("probabilities that add up to 1 at most")
        return self

    @model_validator(mode="after")
    def _is_survived(self) -> Self:
        sizes = (*self.noise.disturbance, *self.noise.reading, *self.noise.colour)
        if max((size for size in sizes if size is not None), default=0.0) > WILDEST:
            raise ValueError(f"noise of at most {WILDEST:.0f} m/s2, rad/s2, m or rad")
        return self


class ModelFile(Section):
    """A model file as it stands on disk: data only."""

    schema_: Literal["rovsim.model/1"] = Field("rovsim.model/1", alias="schema")
    vehicle: PathText | dict[str, Any]
    effects: tuple[EffectEntry, ...] = ()
    residual: dict[str, Any] | None = None
    uncertainty: UncertaintyEntry | None = None
    provenance: dict[str, Any] | None = None

    @field_validator("effects")
    @classmethod
    def _each_once(cls, effects: tuple[EffectEntry, ...]) -> tuple[EffectEntry, ...]:
        for place, one in enumerate(effects):
            if one in effects[:place]:
                raise ValueError(f"each effect once ('{one.effect}' has the same values twice)")
        return effects


def with_uncertainty(
    model: Model, entry: UncertaintyEntry, catalogue: Catalogue, where: object
) -> Model:
    """The model whose added effects are known as an entry of the file `where` says.

    Raises:
        BadInput: an effect that may act instead is unknown, a value out of range, or a correlation
            is of none of the values.
    """
    instead = tuple(
        (one.probability, Draws(build_effects(one.effects, catalogue), one.correlation))
        for one in entry.instead
    )
    own = Draws(model.added, entry.correlation)
    for draws in (own, *(draws for _, draws in instead)):
        draws.refuse_strangers(f"{where}, uncertainty")
    return replace(model, uncertainty=Uncertainty(entry.noise, own, instead))


def _describe_uncertainty(found: Uncertainty) -> UncertaintyEntry:
    return UncertaintyEntry(
        noise=found.noise,
        correlation=found.own.correlation,
        instead=tuple(
            PossibilityEntry(
                probability=probability,
                effects=tuple(map(describe_effect, draws.effects)),
                correlation=draws.correlation,
            )
            for probability, draws in found.instead
        ),
    )


def read_model(path: Path, catalogue: Catalogue) -> Model:
    """Read a model file, of effects of this catalogue; the model is called by the file's stem.

    Raises:
        BadInput: it is missing, or something in it is unknown or out of range.
    """
    return build_model(read_yaml(path), path, catalogue)


def build_model(content: Any, path: Path, catalogue: Catalogue) -> Model:
    """The model of a file's content.

    Raises:
        BadInput: something in it is unknown or out of range.
    """
    _require_model(content, path)
    file = checked(ModelFile, content, path)
    if isinstance(file.vehicle, str):
        vehicle = load_vehicle(file.vehicle, named_in=path)
    else:
        vehicle = build_vehicle(file.vehicle, f"{path}, vehicle")
    residual = None
    if file.residual:
        residual = read_residual(file.residual, path.parent, f"{path}, residual")
    known = catalogue.on(vehicle)
    with located(path):
        added = build_effects(file.effects, known)
        model = Model(name_of(path), vehicle, (*vehicle.effects(), *added), residual)
        _ = model.M  # refuse a model that cannot move
    if file.uncertainty is None or residual is not None:
        return model
    return with_uncertainty(model, file.uncertainty, known, path)


def _require_model(content: Any, path: Path) -> None:
    """Refuse what says of itself that it is something else: one key that is wrong tells less."""
    told = content.get("schema") if isinstance(content, dict) else None
    if not isinstance(told, str) or told == SCHEMA:
        return
    raise BadInput(
        f"is no model, but says 'schema: {told}'",
        where=path,
        expected=f"a model file ('schema: {SCHEMA}')",
        remedy=f"`rovsim add diagnosis={path} model=NEW.yaml` writes one with what was found."
        if told.startswith("rovsim.diagnosis/")
        else "`rovsim add` and `rovsim train` write one.",
    )


def load_model(spec: str, vehicle: Vehicle, catalogue: Catalogue) -> Model:
    """A built-in model of this vehicle, or the model of a file, called by the file's stem.

    Raises:
        BadInput: no such file, or it does not describe a model.
    """
    if spec in BUILT_IN:
        return built_in_model(spec, vehicle)
    if not Path(spec).suffix and not Path(spec).exists():
        raise BadInput(
            f"unknown model '{spec}'",
            where="model",
            expected=f"{' or '.join(BUILT_IN)}, or the path of a model file",
            remedy=nearest(spec, BUILT_IN),
        )
    return read_model(Path(spec), catalogue)


def describe_model(model: Model) -> dict[str, Any]:
    """The content of a model's file, without a residual."""
    name = model.vehicle.name
    known = known_vehicle(name) is not None and load_vehicle(name) == model.vehicle
    return {
        "schema": SCHEMA,
        "vehicle": name if known else _described(model.vehicle),
        "effects": [describe_effect(one).plain() for one in model.added],
    }


def _described(vehicle: Vehicle) -> dict[str, Any]:
    """What its file says."""
    return vehicle.model_dump(mode="json", by_alias=True, exclude_unset=True)


def write_model(
    model: Model,
    path: Path,
    residual: StoredResidual | None = None,
    provenance: dict[str, Any] | None = None,
) -> None:
    """Write a model file; `residual` describes arrays that lie beside it.

    How sure a model is was not learned with a residual on top of it, and is left out then.
    """
    content = describe_model(model)
    if residual:
        content |= {"residual": residual.model_dump(mode="json")}
    elif model.uncertainty:
        known = _describe_uncertainty(model.uncertainty)
        content |= {"uncertainty": known.model_dump(mode="json", exclude_defaults=True)}
    content |= {"provenance": plain(provenance)} if provenance else {}
    write_yaml(path, content, rows=True)
