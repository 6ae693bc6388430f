"""Say which physical effects a model lacks, and how sure that is.

rovsim diagnose campaign=DIR out=OUT [model=nominal|FILE] [search.false_alarm=0.01]

Writes OUT/diagnosis.json, figures, OUT/report.html and an MLflow run. Only train runs are used to
decide; the test runs are opened once, for the errors that are reported. The model with the effects
is then written by `rovsim add diagnosis=OUT/diagnosis.json model=NEW.yaml`.
"""

from pathlib import Path

from rovsim.config import Settings
from rovsim.diagnosing import Diagnosed, diagnosed
from rovsim.errors import BadInput
from rovsim.evidence import Evidence
from rovsim.files import write_json
from rovsim.loading import Measured, measured, models, results_folder
from rovsim.model import Model
from rovsim.progress import staged
from rovsim.provenance import provenance
from rovsim.report import terminal
from rovsim.tracking import track_diagnosis

FIGURES = ("ranking", "where", "where_map", "ladder", "excitation")


def run(settings: Settings) -> None:
    """Diagnose one model, write what was found, and say it."""
    data = measured(settings, even_unusable=True)
    base = _base(models(settings, data.vehicle))
    out = results_folder(settings.out or f"results/{data.campaign.name}/diagnosis")
    with staged("diagnosing") as stage:
        found = diagnosed(data.runs, base, settings.diagnosing, stage)
    shown = _present(out, data, found, settings)
    write_json(out / "diagnosis.json", found.content)
    print(terminal.diagnosed(found.content))
    print(f"\n{out / 'diagnosis.json'} and {out / 'report.html'}")
    track_diagnosis(
        settings.tracking, data.campaign.name, base.name, found.content,
        settings.diagnosing.model_dump(mode="json"), [out / "diagnosis.json", *shown],
    )  # fmt: skip


def _base(chosen: list[Model]) -> Model:
    if len(chosen) == 1 and chosen[0].residual is None and not chosen[0].inert:
        return chosen[0]
    raise BadInput(
        f"cannot diagnose {', '.join(m.name for m in chosen)}",
        where="model",
        expected="one model of physics, without a trained residual",
        remedy="Give model=nominal, or one model file without a residual.",
    )


def _present(out: Path, data: Measured, found: Diagnosed, settings: Settings) -> list[Path]:
    from rovsim.report.folder import present

    evidence = Evidence(
        {}, {}, ladder=found.content["ladder"], quality=data.quality, where=found.where,
        diagnosis=found.content,
    )  # fmt: skip
    wanted = [(figure, "") for figure in FIGURES]
    return present(out, data.campaign.name, evidence, wanted, provenance(settings))
