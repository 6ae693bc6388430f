"""Say which physical effects a model lacks, and how sure that is.

rovsim diagnose campaign=DIR out=OUT [model=nominal|FILE] [search.false_alarm=0.01]

Writes OUT/diagnosis.json, figures, OUT/report.html, and an MLflow run where rovsim[tracking] is
installed. Only train runs are used to decide; the test runs are opened once, for the errors that
are reported. The model with the effects is then written by `rovsim add
diagnosis=OUT/diagnosis.json model=NEW.yaml`.
"""

from pathlib import Path

from rovsim.application.loading import Measured, measured, models, results_folder
from rovsim.application.pipeline import diagnose
from rovsim.application.provenance import provenance
from rovsim.application.settings import Settings
from rovsim.application.tracking import track_diagnosis
from rovsim.apps.cli.output import say
from rovsim.core.extras import installed
from rovsim.core.files import write_json
from rovsim.core.progress import reported
from rovsim.diagnosis.of_campaign import Diagnosed
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.html import terminal
from rovsim.reporting.report_data import Evidence

FIGURES = ("ranking", "where", "where_map", "ladder", "excitation")


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Diagnose one model, write what was found, and say it."""
    data = measured(settings, even_unusable=True)
    chosen = models(settings, data.vehicle, catalogue)
    out = results_folder(settings.out or f"results/{data.campaign.name}/diagnosis")
    found = diagnose(data, chosen, settings, catalogue)
    shown = _present(out, data, found, settings, catalogue)
    write_json(out / "diagnosis.json", found.content)
    files = f"{out / 'diagnosis.json'} and {out / 'report.html'}"
    say(settings, f"{terminal.diagnosed(found.content, catalogue)}\n\n{files}", found.content)
    if installed("tracking"):
        with reported("logging to MLflow"):
            track_diagnosis(
                settings.tracking, data.campaign.name, chosen[0].name, found.content,
                settings.diagnosing.model_dump(mode="json"), [out / "diagnosis.json", *shown],
            )  # fmt: skip


def _present(
    out: Path, data: Measured, found: Diagnosed, settings: Settings, catalogue: Catalogue
) -> list[Path]:
    from rovsim.reporting.html.folder import present

    evidence = Evidence(
        {}, {}, ladder=found.content["ladder"], quality=data.quality, where=found.where,
        diagnosis=found.content,
    )  # fmt: skip
    wanted = [(figure, "") for figure in FIGURES]
    return present(out, data.campaign.name, evidence, wanted, provenance(settings), catalogue)
