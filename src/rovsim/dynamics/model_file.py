"""Read and write model files: the only module that knows their schema."""

from dataclasses import replace
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from rovsim.core.errors import BadInput, located, nearest
from rovsim.core.files import plain, write_text
from rovsim.core.model_names import BUILT_IN
from rovsim.core.names import name_of
from rovsim.core.schema import PathText, Section, checked
from rovsim.core.yaml_files import read_yaml, yaml_text
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effect_entry import EffectEntry, build_effects, describe_effect
from rovsim.dynamics.learned.residual import StoredResidual, read_residual
from rovsim.dynamics.model import Model, built_in_model
from rovsim.dynamics.uncertainty import Draws, Uncertainty
from rovsim.dynamics.vehicle import Vehicle, build_vehicle, known_vehicle, load_vehicle
from rovsim.results.fitted import Correlation, FittedNoise, Possibility, Posterior, Probability

SCHEMA = "rovsim.model/1"
# m/s2, rad/s2, m, rad: noise larger than was ever fitted; a replay with draws of it would diverge.
MAX_NOISE = 1e3


class PossibilityEntry(Section):
    """Effects that may act instead of the model's, and their probability."""

    probability: Probability
    effects: tuple[EffectEntry, ...]
    correlation: Correlation = Correlation()

    @staticmethod
    def of(fitted: Possibility, source: Path) -> "PossibilityEntry":
        """The entry of a possibility of a diagnosis, whose file is `source`.

        Raises:
            BadInput: a value is missing, or no model file may hold it.
        """
        return PossibilityEntry(
            probability=fitted.probability,
            effects=tuple(EffectEntry.of(effect, source) for effect in fitted.effects),
            correlation=fitted.correlation,
        )


class UncertaintyEntry(Section):
    """Uncertainty of the effects of a model file: see `rovsim.dynamics.uncertainty`."""

    noise: FittedNoise
    correlation: Correlation = Correlation()
    instead: tuple[PossibilityEntry, ...] = ()

    @staticmethod
    def of(posterior: Posterior, noise: FittedNoise, source: Path) -> "UncertaintyEntry":
        """The entry of what a diagnosis knows of its values.

        Args:
            posterior: how the values hang together, and what may act instead.
            noise: that was fitted with them.
            source: the file of the diagnosis, for messages.

        Raises:
            BadInput: a value or the noise is not what a model file may hold.
        """
        entry = {
            "noise": noise,
            "correlation": posterior.correlation,
            "instead": [PossibilityEntry.of(item, source) for item in posterior.instead],
        }
        return checked(UncertaintyEntry, entry, source)

    @model_validator(mode="after")
    def _leaves_something(self) -> Self:
        if sum(alternative.probability for alternative in self.instead) > 1.0:
            raise ValueError("probabilities that add up to 1 at most")
        return self

    @model_validator(mode="after")
    def _is_survived(self) -> Self:
        sizes = (*self.noise.disturbance, *self.noise.reading, *self.noise.colour)
        if max((size for size in sizes if size is not None), default=0.0) > MAX_NOISE:
            raise ValueError(f"noise of at most {MAX_NOISE:.0f} m/s2, rad/s2, m or rad")
        return self


class ModelFile(Section):
    """The content of a model file, before effects and vehicle are built from it."""

    schema_: Literal["rovsim.model/1"] = Field("rovsim.model/1", alias="schema")
    vehicle: PathText | dict[str, Any]
    effects: tuple[EffectEntry, ...] = ()
    residual: dict[str, Any] | None = None
    uncertainty: UncertaintyEntry | None = None
    provenance: dict[str, Any] | None = None

    @field_validator("effects")
    @classmethod
    def _each_once(cls, effects: tuple[EffectEntry, ...]) -> tuple[EffectEntry, ...]:
        for k, effect in enumerate(effects):
            if effect in effects[:k]:
                raise ValueError(f"each effect once ('{effect.effect}' has the same values twice)")
        return effects


def with_uncertainty(
    model: Model, entry: UncertaintyEntry, catalogue: Catalogue, where: object
) -> Model:
    """Give a model the uncertainty of its added effects that stands in a file.

    Args:
        model: whose effects were read from the file.
        entry: the file's section.
        catalogue: of the effects that may act instead.
        where: the file, for messages.

    Raises:
        BadInput: an effect that may act instead is unknown, a value is out of range, or a
            correlation names a value that does not exist.
    """
    alternatives = tuple(
        (a.probability, Draws(build_effects(a.effects, catalogue), a.correlation))
        for a in entry.instead
    )
    main = Draws(model.added, entry.correlation)
    for draws in (main, *(draws for _, draws in alternatives)):
        draws.refuse_strangers(f"{where}, uncertainty")
    return replace(model, uncertainty=Uncertainty(entry.noise, main, alternatives))


def _describe_uncertainty(uncertainty: Uncertainty) -> UncertaintyEntry:
    return UncertaintyEntry(
        noise=uncertainty.noise,
        correlation=uncertainty.own.correlation,
        instead=tuple(
            PossibilityEntry(
                probability=probability,
                effects=tuple(map(describe_effect, draws.effects)),
                correlation=draws.correlation,
            )
            for probability, draws in uncertainty.instead
        ),
    )


def read_model(path: Path, catalogue: Catalogue) -> Model:
    """Read a model file with effects of this catalogue; the file's stem is the model's name.

    Raises:
        BadInput: the file is missing, or something in it is unknown or out of range.
    """
    return build_model(read_yaml(path), path, catalogue)


def build_model(content: Any, path: Path, catalogue: Catalogue) -> Model:
    """Build the model that the content of a file describes.

    Args:
        content: what was read from the file.
        path: the file; others that it names are relative to its folder.
        catalogue: of the effects that it may name.

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
    effects = catalogue.on(vehicle)
    with located(path):
        added = build_effects(file.effects, effects)
        model = Model(name_of(path), vehicle, vehicle.effects(), added, residual)
        _ = model.M  # refuse a model that cannot move
    if file.uncertainty is None or residual is not None:
        return model
    return with_uncertainty(model, file.uncertainty, effects, path)


def _require_model(content: Any, path: Path) -> None:
    """Refuse a file whose `schema` says that it is something else, with a message of its own."""
    schema = content.get("schema") if isinstance(content, dict) else None
    if not isinstance(schema, str) or schema == SCHEMA:
        return
    raise BadInput(
        f"is no model, but says 'schema: {schema}'",
        where=path,
        expected=f"a model file ('schema: {SCHEMA}')",
        remedy=f"`rovsim add diagnosis={path} model=NEW.yaml` writes one with what was found."
        if schema.startswith("rovsim.diagnosis/")
        else "`rovsim add` and `rovsim train` write one.",
    )


def load_model(spec: str, vehicle: Vehicle, catalogue: Catalogue) -> Model:
    """Load a built-in model of this vehicle by its name, or the model of a file by its path.

    Raises:
        BadInput: no such model or file, or the file does not describe a model.
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
    """The content of a model file: vehicle and effects, without residual and uncertainty."""
    name = model.vehicle.name
    is_shipped = known_vehicle(name) is not None and load_vehicle(name) == model.vehicle
    return {
        "schema": SCHEMA,
        "vehicle": name if is_shipped else _describe_vehicle(model.vehicle),
        "effects": [describe_effect(effect).plain() for effect in model.added],
    }


def _describe_vehicle(vehicle: Vehicle) -> dict[str, Any]:
    """The content of a vehicle's file."""
    return vehicle.model_dump(mode="json", by_alias=True, exclude_unset=True)


def write_model(
    model: Model,
    path: Path,
    residual: StoredResidual | None = None,
    provenance: dict[str, Any] | None = None,
) -> None:
    """Write a model file, see `model_text`; one that is there is replaced."""
    write_text(path, model_text(model, residual, provenance))


def model_text(
    model: Model,
    residual: StoredResidual | None = None,
    provenance: dict[str, Any] | None = None,
) -> str:
    """The text of a model file.

    The uncertainty of a model holds without a learned residual, and is omitted if there is one.

    Args:
        model: to write.
        residual: describes the arrays of a learned residual, which are in files beside this one.
        provenance: how the model came about.
    """
    content = describe_model(model)
    if residual:
        content |= {"residual": residual.model_dump(mode="json")}
    elif model.uncertainty:
        uncertainty = _describe_uncertainty(model.uncertainty)
        content |= {"uncertainty": uncertainty.model_dump(mode="json", exclude_defaults=True)}
    content |= {"provenance": plain(provenance)} if provenance else {}
    return yaml_text(content, rows=True)
