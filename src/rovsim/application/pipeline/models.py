"""Load models by name or file, and add the effects of a diagnosis to one of them."""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.core.errors import BadInput
from rovsim.core.files import require_replaceable, write_beside
from rovsim.core.model_names import BUILT_IN
from rovsim.core.names import as_list, is_name
from rovsim.diagnosis import apply
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import SCHEMA, load_model, model_text
from rovsim.dynamics.vehicle import Vehicle
from rovsim.results.diagnosis import Diagnosis


def load_models(specs: str | Sequence[str], vehicle: Vehicle, catalogue: Catalogue) -> list[Model]:
    """Load models, each once.

    A model is named after its file's stem. Where files share a stem, or have a built-in model's
    name, they become `folder-stem`, with as many folders as necessary.

    Args:
        specs: names of built-in models, or model files.
        vehicle: of built-in models.
        catalogue: all effects.

    Raises:
        BadInput: a model cannot be loaded, or two are of the same file.
    """
    distinct = list(dict.fromkeys(as_list(specs)))
    loaded = [load_model(spec, vehicle, catalogue) for spec in distinct]
    names = tell_apart([model.name for model in loaded], distinct)
    return [model.called(name) for model, name in zip(loaded, names, strict=True)]


def tell_apart(names: Sequence[str], specs: Sequence[str]) -> list[str]:
    """Make names of models different by putting the folders of their files in front.

    Args:
        names: of the models, a file's stem or that of a built-in model.
        specs: the files, or the built-in models' names.

    Raises:
        BadInput: no folder tells two of them apart.
    """
    files = [None if spec in BUILT_IN else Path(spec).resolve() for spec in specs]
    deepest = max((len(file.parts) for file in files if file), default=0)
    unique = list(names)
    for depth in range(1, deepest):
        ambiguous = {name for name in unique if name in BUILT_IN or unique.count(name) > 1}
        unique = [
            _with_folders(stem, file, depth) if file and name in ambiguous else name
            for stem, name, file in zip(names, unique, files, strict=True)
        ]
    doubles = [k for k, name in enumerate(unique) if unique.count(name) > 1]
    if not doubles:
        return unique
    raise BadInput(
        f"two models are called '{names[doubles[0]]}' ({', '.join(specs[k] for k in doubles)})",
        where="model",
        expected="each model once (it is called by its file's stem, and by folders if need be)",
        remedy="Leave one of them out, or rename its file.",
    )


def _with_folders(name: str, file: Path, depth: int) -> str:
    """Put the last `depth` folders of a file in front of a name, or fewer if there are fewer."""
    folders = [part for part in file.parent.parts[1:][-depth:] if is_name(part)]
    return "-".join([*folders, name])


def load_one_model(specs: str | Sequence[str], vehicle: Vehicle, catalogue: Catalogue) -> Model:
    """Load the one model that was named.

    Raises:
        BadInput: several were named, or it cannot be loaded.
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
    """Refuse a model that is not of physics alone.

    Args:
        model: that is checked.
        doing: what cannot be done with it, such as "diagnose", for the message.

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


def write_with_effects(
    diagnosis: Path,
    base: str,
    effects: Sequence[str] | None,
    catalogue: Catalogue,
    out: Path,
    story: Mapping[str, object],
) -> tuple[apply.Added, Path | None]:
    """Write a model file: a base with effects that a diagnosis fitted.

    Another model of that name, in which values may have been changed by hand, is kept beside it.

    Args:
        diagnosis: its file.
        base: a built-in model, or a model file.
        effects: ids; None: those that the diagnosis selected.
        catalogue: all effects.
        out: the model file.
        story: further entries of its provenance.

    Returns:
        The model, and the file in which another one of that name is kept, if there was one.

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
    fitted = Diagnosis.read(diagnosis)
    added = apply.add_effects(fitted, diagnosis, base, effects, catalogue)
    text = model_text(added.model, provenance={"base": base, "effects": added.names, **story})
    return added, write_beside(out, text)
