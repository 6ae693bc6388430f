"""Write a model file with the effects that a diagnosis found.

rovsim add diagnosis=OUT/diagnosis.json model=NEW.yaml [effects=[id,…]] [to=nominal|FILE]

Takes the selected effects with their fitted values and intervals, or the named ones of the ranking,
and adds them to the base model `to`; with effects_file=OUT/proposed_effect.py the law that the
diagnosis proposes and the effects beside it. NEW.yaml is plain YAML, and a model wherever a model
is asked. Another model of that name is kept beside it, as NEW.earlier.yaml.
"""

from pathlib import Path

from rovsim.application.pipeline.models import write_with_effects
from rovsim.application.provenance import describe_origin
from rovsim.application.settings import CommandSettings
from rovsim.apps.cli.output import say
from rovsim.core.columns import fold
from rovsim.core.errors import BadInput
from rovsim.core.model_names import NOMINAL
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.words.totals import warn_totals

OTHER_BASE_WARNING = (
    "The diagnosis is not of {base}: its values were found beside the effects of another model. "
    "Name that one with to=FILE to keep them."
)

FOUND_ALONE_WARNING = (
    "Some of these values were found without the other effects: what two of them explain is there "
    "twice. `rovsim diagnose campaign=DIR model={model}` tells what is missing then, or too much."
)

KEPT = "What stood there said something else. It is kept as {kept}."


class Settings(CommandSettings):
    """What `rovsim add` takes."""

    diagnosis: str | None
    model: str | list[str]
    to: str
    effects: list[str] | None


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Write the new model, and say what is in it."""
    base, model = settings.to, settings.model
    _require_ending(model)
    if settings.diagnosis is None or not isinstance(model, str) or not Path(model).suffix:
        raise BadInput(
            "no diagnosis or no model file was named",
            where="command line",
            expected="diagnosis=OUT/diagnosis.json model=NEW.yaml",
            remedy="`rovsim diagnose campaign=DIR out=OUT` writes a diagnosis.",
        )
    story = {"diagnosis": settings.diagnosis, **describe_origin(catalogue)}
    added, kept = write_with_effects(
        Path(settings.diagnosis), base, settings.effects, catalogue, Path(model), story
    )
    extended, names, diagnosed, one_by_one = added
    text = f"{base} + {' + '.join(names)}"
    if not names:
        source = "the diagnosis selected" if settings.effects is None else "effects=[] names"
        text = f"{base} as it is, for {source} no effect"
    if not diagnosed:
        text += f".\n{OTHER_BASE_WARNING.format(base=base)}"
    if one_by_one:
        text += f".\n{FOUND_ALONE_WARNING.format(model=model)}"
    if kept:
        text += f".\n{KEPT.format(kept=kept)}"
    warning = warn_totals(extended.body)
    if warning:
        text += f".\n{warning}"
    content = {
        "model": model,
        "effects": names,
        "diagnosed": diagnosed,
        "one_by_one": one_by_one,
        "kept": str(kept) if kept else None,
        "warning": warning,
    }
    lines = [line for paragraph in f"{model}: {text}".splitlines() for line in fold(paragraph)]
    say(settings, "\n".join(lines), content)


def _require_ending(model: str | list[str] | None) -> None:
    """Refuse a file to be written whose name could be that of a built-in model, or of a folder."""
    if isinstance(model, str) and model != NOMINAL and not Path(model).suffix:
        file = Path(model) / "NEW.yaml" if Path(model).is_dir() else f"{model}.yaml"
        raise BadInput(
            "is a folder" if Path(model).is_dir() else "has no ending",
            where=f"model={model}",
            expected="the name of the model file that is written, as model=NEW.yaml",
            remedy=f"Did you mean model={file}?",
        )
