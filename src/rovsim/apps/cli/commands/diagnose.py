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
from rovsim.application.provenance import digest_recordings, provenance
from rovsim.application.settings import CampaignSettings, TrackingSettings, select
from rovsim.apps.cli.complaint import warn
from rovsim.apps.cli.opening import measure_campaign
from rovsim.apps.cli.output import join_files, say
from rovsim.core.extras import installed
from rovsim.core.progress import counted, reported
from rovsim.core.second_process import call, second_process
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
DRAWING = "rovsim.reporting.html.folder"
COMPILING = "rovsim.simulation.compiled_ahead:compile_ahead"
LOGGING = ("mlflow.tracking", "mlflow.store.tracking.sqlalchemy_store")


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
    others = (DRAWING, *(LOGGING if tracking else ()))
    with second_process(*others, first=None if is_compiled() else COMPILING) as other:
        outdated = find_outdated(out / "report.html", "diagnose", settings.campaign)
        drawing = _Drawing(other, out)

        def draw_early(where: ErrorConditions) -> None:
            drawing.begin(ReportData(where=where, quality=data.quality))

        how = select(settings, DiagnosisSettings)
        read = digest_recordings(data.campaign)
        found = diagnose(data.runs, base, how, catalogue, read, draw_early)
        found.write(out / "diagnosis.json")
        known = ReportData(
            quality=data.quality,
            ladder=found.diagnosis.ladder,
            where=found.where,
            diagnosis=found.diagnosis,
        )
        drawing.begin(known)
        _tell(settings, out, found.diagnosis, data.quality, catalogue, outdated.told)
        drawn = drawing.finish()
        shown = ShownDiagnosis(
            out=out,
            campaign=data.campaign.name,
            base=base.name,
            data=known,
            provenance=provenance(settings, catalogue, data.campaign, read),
            effect_files=settings.effect_files,
            params=how.model_dump(mode="json"),
        )
        last = other.submit(shown.show, drawn, tracking)
        with reported("writing the page and logging" if tracking else "writing the page"):
            unlogged = last.result()
        outdated.remove(path for one in drawn for path in one.files)
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
                    call, f"{DRAWING}:draw_one", self._out, figure, "", known
                )

    def finish(self) -> list[Drawn]:
        """All of them, once they are drawn."""
        return [one.result() for one in counted(list(self._begun.values()), "drawing")]


def _tell(
    settings: Settings,
    out: Path,
    found: Diagnosis,
    quality: Mapping[str, Quality],
    catalogue: Catalogue,
    replaced: str,
) -> None:
    """Say what was found, what speaks against the recordings, and where it is written."""
    from rovsim.reporting.words.terminal import tell_diagnosis, tell_doubts, tell_roles

    text = tell_diagnosis(found, catalogue)
    if found.verdict == "insufficient_data":
        text += tell_roles(quality)
    text += tell_doubts(quality)
    files = f"{out / 'diagnosis.json'} and {out / 'report.html'}"
    kept = keep_other(out / "report.html", "diagnose")
    say(settings, join_files(text, files, kept, replaced), found.to_json())
