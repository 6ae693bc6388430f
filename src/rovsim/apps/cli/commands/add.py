"""Write a model file with the effects that a diagnosis found.

rovsim add diagnosis=OUT/diagnosis.json model=NEW.yaml [effects=[id,…]] [to=nominal|FILE]

Takes the selected effects with their fitted values and intervals, or the named ones of the ranking,
and adds them to the base model `to`. NEW.yaml is plain YAML, and a model wherever a model is asked.
"""

from pathlib import Path

from rovsim.application.provenance import provenance
from rovsim.application.settings import Settings
from rovsim.apps.cli.output import say
from rovsim.core.errors import BadInput
from rovsim.diagnosis.apply import added, read_diagnosis
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model_file import write_model


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Write the new model, and say what is in it."""
    if (
        settings.diagnosis is None
        or not isinstance(settings.model, str)
        or not Path(settings.model).suffix
    ):
        raise BadInput(
            "no diagnosis or no model file was named",
            where="command line",
            expected="diagnosis=OUT/diagnosis.json model=NEW.yaml",
            remedy="`rovsim diagnose campaign=DIR out=OUT` writes a diagnosis.",
        )
    source = Path(settings.diagnosis)
    model, names = added(read_diagnosis(source), source, settings.to, settings.effects, catalogue)
    known = provenance(settings)
    story = {"diagnosis": str(source), "base": settings.to}
    story |= {key: known[key] for key in ("code", "versions")}
    write_model(model, Path(settings.model), provenance=story)
    text = f"{settings.to} + {' + '.join(names)}"
    if not names:
        text = f"{settings.to} as it is, for the diagnosis selected no effect"
    say(settings, f"{settings.model}: {text}", {"model": settings.model, "effects": names})
