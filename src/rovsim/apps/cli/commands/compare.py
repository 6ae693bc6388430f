"""Replay every run with every model and measure the errors.

rovsim compare campaign=DIR model=[nominal,FILE,…] out=OUT

Writes OUT/comparison.json (errors per model, run, axis and horizon), OUT/where.json (under which
conditions each model fails), OUT/budget.json (who pushes how much), figures and OUT/report.html,
and prints a summary. Of models that `rovsim add` made also OUT/bands.json: how much of the test
runs lies within what they leave open. A report.html of `rovsim diagnose` there is kept beside it.
"""

from pathlib import Path

from rovsim.application.pipeline.comparison import compare
from rovsim.application.pipeline.models import load_models
from rovsim.application.provenance import provenance
from rovsim.application.settings import CampaignSettings
from rovsim.apps.cli.opening import measure_campaign
from rovsim.apps.cli.output import join_files, say
from rovsim.core.files import appearing_together
from rovsim.core.second_process import second_process
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.html.kept import find_outdated, keep_other
from rovsim.reporting.report_data import ReportData
from rovsim.reporting.words.terminal import tell_comparison, tell_doubts

# a second process imports it while this one compares
DRAWING_MODULE = "rovsim.reporting.html.folder"


class Settings(CampaignSettings):
    """What `rovsim compare` takes."""


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Compare, then write numbers, figures and the report."""
    with second_process(DRAWING_MODULE) as other:
        data, out = measure_campaign(settings, "compare")
        models = load_models(settings.model, data.vehicle, catalogue)
        results = compare(data, models, settings)
        assert results.comparison is not None
        assert results.where is not None
        outdated = find_outdated(out / "report.html", "compare", settings.campaign)
        notice = keep_other(out / "report.html", "compare")
        origin = provenance(settings, catalogue, data.campaign)
        with appearing_together(out, last="comparison.json") as folder:
            _write(folder, results)
            from rovsim.reporting.html.folder import present

            figures = present(folder, data.campaign.name, results, origin, catalogue, other=other)
    outdated.remove(figures)
    if results.band_coverage is None:
        (out / "bands.json").unlink(missing_ok=True)  # of an earlier comparison
    errors = {step.model: step.windows_2s for step in results.steps}
    away = [step.model for step in results.steps if not step.scored]
    tested = bool(data.runs.of("test"))
    text = tell_comparison(errors, results.where, tested, results.band_coverage, away)
    files = f"{out / 'comparison.json'}, {out / 'where.json'} and {out / 'report.html'}"
    message = join_files(text + tell_doubts(data.quality), files, notice, outdated.notice)
    say(settings, message, results.comparison.to_json())


def _write(folder: Path, report: ReportData) -> None:
    results = {
        "where": report.where,
        "budget": report.budget_totals,
        "bands": report.band_coverage,
        "comparison": report.comparison,
    }
    for name, result in results.items():
        if result is not None:
            result.write(folder / f"{name}.json")
