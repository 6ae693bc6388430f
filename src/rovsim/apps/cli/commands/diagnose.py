"""Say which physical effects a model lacks, and how sure that is.

rovsim diagnose campaign=DIR out=OUT [model=nominal|FILE] [search.false_alarm=0.003]

Writes OUT/diagnosis.json, figures, OUT/report.html, OUT/proposed_effect.py where a law is found for
what no effect explains, and an MLflow run where rovsim[tracking] is installed. Only train runs are
used to decide; the test runs are opened once, for the errors that are reported. The model with the
effects is then written by `rovsim add diagnosis=OUT/diagnosis.json model=NEW.yaml`.
"""

from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Mapping

from pydantic import Field

from rovsim.application.pipeline.diagnosis import diagnose
from rovsim.application.pipeline.models import load_one_model
from rovsim.application.pipeline.shown_diagnosis import ShownDiagnosis
from rovsim.application.provenance import provenance
from rovsim.application.settings import CampaignSettings, TrackingSettings, select
from rovsim.apps.cli.complaint import warn
from rovsim.apps.cli.opening import measure_campaign
from rovsim.apps.cli.output import join_files, say
from rovsim.core.extras import installed
from rovsim.core.progress import counted, reported
from rovsim.core.second_process import call, second_process
from rovsim.diagnosis.campaign_diagnosis import CampaignDiagnosis
from rovsim.diagnosis.settings import DiagnosisSettings, SearchSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.html.kept import find_outdated, keep_other
from rovsim.reporting.html.picture import Drawn
from rovsim.reporting.report_data import ReportData
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.quality import Quality
from rovsim.simulation.compiled_ahead import is_compiled

# The second process imports these; this one does without them, to begin sooner.
DRAWING_MODULE = "rovsim.reporting.html.folder"
COMPILING_CALL = "rovsim.simulation.compiled_ahead:compile_ahead"
LOGGING_MODULES = ("mlflow.tracking", "mlflow.store.tracking.sqlalchemy_store")


class Settings(CampaignSettings):
    """What `rovsim diagnose` takes."""

    search: SearchSettings
    seed: int = Field(ge=0)
    tracking: TrackingSettings


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Diagnose one model, write what was found, say it, show it, and log it."""
    data, out = measure_campaign(settings, "diagnosis", even_unusable=True)
    base = load_one_model(settings.model, data.vehicle, catalogue)
    tracking = settings.tracking if installed("tracking") else None
    modules = (DRAWING_MODULE, *(LOGGING_MODULES if tracking else ()))
    with second_process(*modules, first=None if is_compiled() else COMPILING_CALL) as other:
        outdated = find_outdated(out / "report.html", "diagnose", settings.campaign)
        drawing = _Drawing(other, out)

        def draw_early(where: ErrorConditions) -> None:
            drawing.begin(ReportData(where=where, quality=data.quality))

        options = select(settings, DiagnosisSettings)
        result = diagnose(data.campaign, data.runs, base, options, catalogue, draw_early)
        result.write(out / "diagnosis.json")
        report_data = _data_to_show(result, data.quality)
        drawing.begin(report_data)
        _tell(settings, out, result.diagnosis, data.quality, catalogue, outdated.notice)
        figures = drawing.finish()
        page = ShownDiagnosis(
            out=out,
            campaign=data.campaign.name,
            base=base.name,
            data=report_data,
            provenance=provenance(settings, catalogue, data.campaign, result.diagnosis.recordings),
            effect_files=settings.effect_files,
            params=options.model_dump(mode="json"),
        )
        task = other.submit(page.show, figures, tracking)
        with reported("writing the page and logging" if tracking else "writing the page"):
            unlogged = task.result()
        outdated.remove(path for figure in figures for path in figure.files)
    if unlogged:
        warn(f"the diagnosis is complete, but MLflow does not have it: {unlogged}")


class _Drawing:
    """Figures that another process draws, each once, as soon as what it shows is known."""

    def __init__(self, other: Executor, out: Path) -> None:
        self._other, self._out = other, out
        self._begun: dict[str, Future[Drawn]] = {}

    def begin(self, known: ReportData) -> None:
        """Have drawn what is known and was not begun before."""
        for figure in known.figures:
            if figure not in self._begun:
                self._begun[figure] = self._other.submit(
                    call, f"{DRAWING_MODULE}:draw_one", self._out, figure, "", known
                )

    def finish(self) -> list[Drawn]:
        """All of them, once they are drawn."""
        return [future.result() for future in counted(list(self._begun.values()), "drawing")]


def _data_to_show(result: CampaignDiagnosis, quality: Mapping[str, Quality]) -> ReportData:
    return ReportData(
        quality=quality,
        ladder=result.diagnosis.ladder,
        where=result.where,
        diagnosis=result.diagnosis,
    )


def _tell(
    settings: Settings,
    out: Path,
    diagnosis: Diagnosis,
    quality: Mapping[str, Quality],
    catalogue: Catalogue,
    replaced: str,
) -> None:
    """Say what was found, what speaks against the recordings, and where it is written."""
    from rovsim.reporting.words.terminal import tell_diagnosis, tell_doubts, tell_roles

    text = tell_diagnosis(diagnosis, catalogue)
    if diagnosis.verdict == "insufficient_data":
        text += tell_roles(quality)
    text += tell_doubts(quality)
    files = f"{out / 'diagnosis.json'} and {out / 'report.html'}"
    notice = keep_other(out / "report.html", "diagnose")
    say(settings, join_files(text, files, notice, replaced), diagnosis.to_json())
