"""Say which physical effects a model lacks, and how sure that is.

rovsim diagnose campaign=DIR out=OUT [model=nominal|FILE] [search.false_alarm=0.003]

Writes OUT/diagnosis.json, figures, OUT/report.html, OUT/proposed_effect.py where a law is found for
what no effect explains, and an MLflow run where rovsim[tracking] is installed. Only train runs are
used to decide; the test runs are opened once, for the errors that are reported. The model with the
effects is then written by `rovsim add diagnosis=OUT/diagnosis.json model=NEW.yaml`.
"""

from concurrent.futures import Future

from pydantic import Field

from rovsim.application.pipeline.diagnosis import diagnose
from rovsim.application.pipeline.models import load_one_model
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
from rovsim.reporting.html.kept import keep_other
from rovsim.reporting.report_data import ReportData
from rovsim.results.error_conditions import ErrorConditions
from rovsim.simulation.compiled_ahead import is_compiled

# The second process imports these; this one does without them, to begin sooner.
DRAWING, SHOWING = "rovsim.reporting.html.folder", "rovsim.application.pipeline.shown_diagnosis"
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
    others = (DRAWING, SHOWING, *(LOGGING if tracking else ()))
    with second_process(*others, first=None if is_compiled() else COMPILING) as other:
        drawing: dict[str, Future] = {}

        def draw(known: ReportData) -> None:
            for figure in known.figures:
                if figure not in drawing:
                    drawing[figure] = other.submit(
                        call, f"{DRAWING}:draw_one", out, figure, "", known
                    )

        def draw_early(where: ErrorConditions) -> None:
            draw(ReportData(where=where, quality=data.quality))

        how = select(settings, DiagnosisSettings)
        read = digest_recordings(data.campaign)
        found = diagnose(data.runs, base, how, catalogue, read, draw_early)
        found.write(out / "diagnosis.json")
        shown = ReportData(
            quality=data.quality,
            ladder=found.diagnosis.ladder,
            where=found.where,
            diagnosis=found.diagnosis,
        )
        draw(shown)

        from rovsim.reporting.words.terminal import tell_diagnosis, tell_doubts, tell_roles

        files = f"{out / 'diagnosis.json'} and {out / 'report.html'}"
        text = tell_diagnosis(found.diagnosis, catalogue)
        if found.diagnosis.verdict == "insufficient_data":
            text += tell_roles(data.quality)
        text += tell_doubts(data.quality)
        kept = keep_other(out / "report.html", "diagnose")
        told = join_files(text, files, kept)
        say(settings, told, found.diagnosis.to_json())
        drawn = [future.result() for future in counted(list(drawing.values()), "drawing")]
        origin = provenance(settings, catalogue, data.campaign, read)
        last = other.submit(
            call,
            f"{SHOWING}:show_diagnosis",
            out,
            data.campaign.name,
            base.name,
            shown,
            drawn,
            origin,
            settings.effect_files,
            how.model_dump(mode="json"),
            tracking,
        )
        with reported("writing the page and logging" if tracking else "writing the page"):
            unlogged = last.result()
    if unlogged:
        warn(f"the diagnosis is complete, but MLflow does not have it: {unlogged}")
