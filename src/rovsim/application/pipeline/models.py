"""Models by name or file, and effects added to one of them."""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.core.errors import BadInput
from rovsim.core.files import require_replaceable
from rovsim.diagnosis import apply
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import SCHEMA, load_model, write_model
from rovsim.dynamics.vehicle import Vehicle
from rovsim.results.diagnosis import Diagnosis


def load_models(specs: str | Sequence[str], vehicle: Vehicle, catalogue: Catalogue) -> list[Model]:
    """The models that names and files stand for, each once.

    Raises:
        BadInput: one cannot be loaded, or two files have the same stem.
    """
    given = [specs] if isinstance(specs, str) else specs
    loaded = [load_model(spec, vehicle, catalogue) for spec in dict.fromkeys(given)]
    names = [model.name for model in loaded]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise BadInput(
            f"two models are called '{twice.pop()}'",
            where="model",
            expected="different names (a model is called by its file's stem)",
            remedy="Rename one of the files.",
        )
    return loaded


def load_one_model(specs: str | Sequence[str], vehicle: Vehicle, catalogue: Catalogue) -> Model:
    """The one model that was named.

    Raises:
        BadInput: there are several, or it cannot be loaded.
    """
    loaded = load_models(specs, vehicle, catalogue)
    if len(loaded) == 1:
        return loaded[0]
    raise BadInput(
        f"{len(loaded)} models ({', '.join(model.name for model in loaded)})",
        where="model",
        expected="one model",
        remedy="Name one, or sweep over them with -m.",
    )


def require_physics(model: Model, doing: str) -> None:
    """Refuse a model that is not of physics alone; `doing` says what cannot be done with it.

    Raises:
        BadInput: it has a trained residual, or no physics.
    """
    if model.residual is not None or model.inert:
        raise BadInput(
            f"cannot {doing} {model.name}",
            where="model",
            expected="one model of physics, without a trained residual",
            remedy="Give model=nominal, or one model file without a residual.",
        )


def add_effects(
    diagnosis: Path,
    base: str,
    effects: Sequence[str] | None,
    catalogue: Catalogue,
    out: Path,
    story: Mapping[str, object],
) -> apply.Added:
    """Write `base` with effects that a diagnosis fitted as a model file.

    Args:
        diagnosis: its file.
        base: a built-in model, or a model file.
        effects: ids; None: those that the diagnosis selected.
        catalogue: all effects.
        out: the model file.
        story: what else its provenance tells.

    Raises:
        BadInput: no such diagnosis, effect or model, or `out` is another file of the user's.
    """
    if out.resolve() == diagnosis.resolve():
        raise BadInput(
            "is the diagnosis itself",
            where=out,
            expected="another file for the model",
            remedy="For example model=NEW.yaml.",
        )
    require_replaceable(out, f"schema: {SCHEMA}")  # not as a diagnosis has it, of its base
    found = Diagnosis.read(diagnosis)
    wanted = list(effects) if effects else None
    added = apply.add_effects(found, diagnosis, base, wanted, catalogue)
    write_model(added.model, out, provenance={"base": base, "effects": added.names, **story})
    return added
