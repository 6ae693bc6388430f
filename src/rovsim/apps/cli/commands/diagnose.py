"""Say which physical effects a model lacks, and how sure that is.

rovsim diagnose campaign=DIR out=OUT [model=nominal|FILE] [search.false_alarm=0.01]

Writes OUT/diagnosis.json, figures, OUT/report.html, OUT/proposed_effect.py where a law is found for
what no effect explains, and an MLflow run where rovsim[tracking] is installed. Only train runs are
used to decide; the test runs are opened once, for the errors that are reported. The model with the
effects is then written by `rovsim add diagnosis=OUT/diagnosis.json model=NEW.yaml`.
"""

from pathlib import Path

from pydantic import Field

from rovsim.application.pipeline.diagnosis import diagnose
from rovsim.application.pipeline.models import load_one_model
from rovsim.application.pipeline.recordings import Measured, measure, open_campaign
from rovsim.application.provenance import provenance
from rovsim.application.settings import CampaignSettings, TrackingSettings, select
from rovsim.application.tracking import track_diagnosis
from rovsim.apps.cli.output import choose_folder, say
from rovsim.core.extras import installed
from rovsim.core.files import write_text
from rovsim.core.progress import reported
from rovsim.diagnosis.equations.proposal import FILE as PROPOSAL
from rovsim.diagnosis.of_campaign import Diagnosed
from rovsim.diagnosis.settings import DiagnosisSettings, SearchSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.html import terminal
from rovsim.reporting.report_data import ReportData

FIGURES = ("ranking", "where", "where_map", "ladder", "excitation")


class Settings(CampaignSettings):
    """What `rovsim diagnose` takes."""

    search: SearchSettings
    seed: int = Field(ge=0)
    tracking: TrackingSettings


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Diagnose one model, write what was found, and say it."""
    data = measure(open_campaign(settings.campaign), settings.signals, even_unusable=True)
    base = load_one_model(settings.model, data.vehicle, catalogue)
    out = choose_folder(settings, f"results/{data.campaign.name}/diagnosis")
    how = select(settings, DiagnosisSettings)
    found = diagnose(data.runs, base, how, catalogue)
    shown = _present(out, data, found, settings, catalogue)
    if found.effect_file is not None:
        write_text(out / PROPOSAL, found.effect_file)
    found.diagnosis.write(out / "diagnosis.json")
    files = f"{out / 'diagnosis.json'} and {out / 'report.html'}"
    text = terminal.tell_diagnosis(found.diagnosis, catalogue)
    say(settings, f"{text}\n\n{files}", found.diagnosis.to_json())
    if installed("tracking"):
        with reported("logging to MLflow"):
            track_diagnosis(
                settings.tracking, data.campaign.name, base.name, found.diagnosis,
                how.model_dump(mode="json"), [out / "diagnosis.json", *shown],
            )  # fmt: skip


def _present(
    out: Path, data: Measured, found: Diagnosed, settings: Settings, catalogue: Catalogue
) -> list[Path]:
    from rovsim.reporting.html.folder import present

    shown = ReportData(
        quality=data.quality,
        ladder=found.diagnosis.ladder,
        where=found.where,
        diagnosis=found.diagnosis,
    )
    force = found.diagnosis.unexplained.disturbance
    wanted = [(figure, "") for figure in (*FIGURES, *(["disturbance"] if force else []))]
    origin = provenance(settings, catalogue, data.campaign)
    return present(out, data.campaign.name, shown, wanted, origin, catalogue)
