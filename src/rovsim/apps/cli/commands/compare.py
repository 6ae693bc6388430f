"""Replay every run with every model and measure the errors.

rovsim compare campaign=DIR model=[nominal,FILE,…] out=OUT

Writes OUT/comparison.json (errors per model, run, axis and horizon), OUT/where.json (under which
conditions each model fails), OUT/budget.json (who pushes how much), figures and OUT/report.html,
and prints a summary.
"""

from pathlib import Path

from rovsim.application.loading import measured, models, results_folder
from rovsim.application.pipeline import compare
from rovsim.application.provenance import provenance
from rovsim.application.settings import Settings
from rovsim.apps.cli.output import say
from rovsim.core.files import write_json
from rovsim.dynamics.catalogue import Catalogue
from rovsim.evaluation.budget import totals
from rovsim.evaluation.ladder import step
from rovsim.reporting.html.terminal import compared
from rovsim.reporting.report_data import PER_RUN, Evidence


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Compare, then write numbers, figures and the report."""
    data = measured(settings)
    chosen = models(settings, data.vehicle, catalogue)
    out = results_folder(settings.out or f"results/{data.campaign.name}/compare")
    evidence = compare(data, chosen, settings)
    _present(out, data.campaign.name, evidence, settings, catalogue)
    write_json(out / "where.json", evidence.where)
    write_json(out / "budget.json", totals(list(evidence.budgets.values())))
    write_json(out / "comparison.json", evidence.comparison)
    motions = list(data.motions.values())
    ladder = [step(n, motions, list(runs.values())) for n, runs in evidence.replays.items()]
    text = compared({s["model"]: s["windows_2s"] for s in ladder}, evidence.where)
    files = f"{out / 'comparison.json'}, {out / 'where.json'} and {out / 'report.html'}"
    say(settings, f"{text}\n\n{files}", evidence.comparison)


def _present(
    out: Path, campaign: str, evidence: Evidence, settings: Settings, catalogue: Catalogue
) -> None:
    from rovsim.reporting.html.folder import present

    once = ("where", "where_map", "error_by_axis", "error_growth", "excitation")
    wanted = [(figure, "") for figure in once]
    wanted += [(figure, run) for run in evidence.motions for figure in PER_RUN]
    present(out, campaign, evidence, wanted, provenance(settings), catalogue)
