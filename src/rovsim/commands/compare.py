"""Replay every run with every model and measure the errors.

rovsim compare campaign=DIR model=[nominal,FILE,…] out=OUT

Writes OUT/comparison.json (errors per model, run, axis and horizon), OUT/where.json (under which
conditions each model fails), OUT/budget.json (who pushes how much), figures and OUT/report.html,
and prints a summary.
"""

from pathlib import Path

from rovsim.budget import Budget, budget, totals
from rovsim.config import Settings
from rovsim.evidence import PER_RUN, Evidence
from rovsim.files import write_json
from rovsim.ladder import step
from rovsim.loading import Measured, measured, models, results_folder
from rovsim.model import Model
from rovsim.progress import counted
from rovsim.provenance import provenance
from rovsim.replay import replay
from rovsim.report.terminal import compared
from rovsim.scores import comparison, growth, score
from rovsim.training import samples
from rovsim.where import content, judged


def run(settings: Settings) -> None:
    """Compare, then write numbers, figures and the report."""
    data = measured(settings)
    chosen = models(settings, data.vehicle)
    out = results_folder(settings.out or f"results/{data.campaign.name}/compare")
    evidence = _evidence(data, chosen, settings)
    _present(out, data.campaign.name, evidence, settings)
    write_json(out / "where.json", evidence.where)
    write_json(out / "budget.json", totals(list(evidence.budgets.values())))
    write_json(out / "comparison.json", evidence.comparison)
    motions = list(data.motions.values())
    ladder = [step(n, motions, list(runs.values())) for n, runs in evidence.replays.items()]
    print(compared({s["model"]: s["windows_2s"] for s in ladder}, evidence.where))
    print(f"\n{out / 'comparison.json'}, {out / 'where.json'} and {out / 'report.html'}")


def _evidence(data: Measured, chosen: list[Model], settings: Settings) -> Evidence:
    """Replays, scores, findings and budgets of all models."""
    replays: dict[str, dict] = {model.name: {} for model in chosen}
    jobs = [(model, motion) for model in chosen for motion in data.motions.values()]
    for model, motion in counted(jobs, "replaying"):
        replays[model.name][motion.run.id] = replay(
            model, motion, settings.signals, settings.replay
        )
    motions = list(data.motions.values())
    scores = [score(motion, replays[name][motion.run.id]) for name in replays for motion in motions]
    curves = {name: growth(motions, list(runs.values())) for name, runs in replays.items()}
    searched = counted([m for m in chosen if not m.inert], "searching")
    where = content([judged(m, motions, settings.signals, settings.replay) for m in searched])
    return Evidence(
        data.motions, replays, comparison(scores), {"models": curves}, quality=data.quality,
        where=where, budgets=_budgets(data, chosen[-1], settings),
    )  # fmt: skip


def _budgets(data: Measured, model: Model, settings: Settings) -> dict[str, Budget]:
    """Budget of the last model, by run."""
    return {
        run: budget(
            model, motion, samples(model, motion, settings.signals, settings.replay),
            settings.replay,
        )
        for run, motion in data.motions.items()
    }  # fmt: skip


def _present(out: Path, campaign: str, evidence: Evidence, settings: Settings) -> None:
    from rovsim.report.folder import present

    once = ("where", "where_map", "error_by_axis", "error_growth", "excitation")
    wanted = [(figure, "") for figure in once]
    wanted += [(figure, run) for run in evidence.motions for figure in PER_RUN]
    present(out, campaign, evidence, wanted, provenance(settings))
