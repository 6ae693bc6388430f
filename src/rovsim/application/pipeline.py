"""The work behind `compare`, `diagnose` and `train`: for the commands and for the workbench."""

from pathlib import Path
from typing import Any, Sequence

from rovsim.application.loading import Measured
from rovsim.application.provenance import provenance
from rovsim.application.settings import Settings
from rovsim.core.errors import BadInput
from rovsim.core.progress import counted, reported, staged
from rovsim.diagnosis.of_campaign import STAGES, Diagnosed, diagnosed
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.learned.residual import write_residual
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import read_model, write_model
from rovsim.evaluation.budget import Budget, budget
from rovsim.evaluation.error_conditions import content, judged
from rovsim.evaluation.scores import comparison, growth, score
from rovsim.learning.pairs import choose_training_runs, sample_run, train_residual
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.report_data import Evidence
from rovsim.simulation.prediction import Replay
from rovsim.simulation.replay import replay


def compare(data: Measured, chosen: Sequence[Model], settings: Settings) -> Evidence:
    """Replays, scores, findings and budgets of all models."""
    replays = replayed(data, chosen, settings)
    motions = list(data.motions.values())
    curves = {name: growth(motions, list(runs.values())) for name, runs in replays.items()}
    searched = counted([m for m in chosen if not m.inert], "searching")
    where = content([judged(m, motions, settings.signals, settings.replay) for m in searched])
    return Evidence(
        data.motions, replays, scored(motions, replays), {"models": curves}, quality=data.quality,
        where=where, budgets=_budgets(data, chosen[-1], settings),
    )  # fmt: skip


def replayed(
    data: Measured, chosen: Sequence[Model], settings: Settings
) -> dict[str, dict[str, Replay]]:
    """Every run replayed with every model."""
    replays: dict[str, dict[str, Replay]] = {model.name: {} for model in chosen}
    jobs = [(model, motion) for model in chosen for motion in data.motions.values()]
    for model, motion in counted(jobs, "replaying"):
        replays[model.name][motion.run.id] = replay(
            model, motion, settings.signals, settings.replay
        )
    return replays


def scored(motions: Sequence[Motion], replays: dict[str, dict[str, Replay]]) -> dict[str, Any]:
    """`comparison.json` of replays by model and run."""
    return comparison(score(m, runs[m.run.id]) for runs in replays.values() for m in motions)


def _budgets(data: Measured, model: Model, settings: Settings) -> dict[str, Budget]:
    """Budget of the last model, by run."""
    return {
        run: budget(
            model, motion, sample_run(model, motion, settings.signals, settings.replay),
            settings.replay,
        )
        for run, motion in counted(list(data.motions.items()), "balancing forces")
    }  # fmt: skip


def diagnose(
    data: Measured, chosen: Sequence[Model], settings: Settings, catalogue: Catalogue
) -> Diagnosed:
    """Diagnose one model of physics on the campaign.

    Raises:
        BadInput: not exactly one model, or one that is no model of physics alone.
    """
    base = _base(chosen)
    with staged("diagnosing", STAGES) as stage:
        return diagnosed(data.runs, base, settings.diagnosing, catalogue, stage)


def _base(chosen: Sequence[Model]) -> Model:
    if len(chosen) == 1 and chosen[0].residual is None and not chosen[0].inert:
        return chosen[0]
    raise BadInput(
        f"cannot diagnose {', '.join(m.name for m in chosen)}",
        where="model",
        expected="one model of physics, without a trained residual",
        remedy="Give model=nominal, or one model file without a residual.",
    )


def train(
    data: Measured,
    base: Model,
    settings: Settings,
    catalogue: Catalogue,
    out: Path,
    name: str = "model",
) -> Model:
    """Train a residual on top of a model; writes `out`/`name`.yaml and returns it as read back."""
    used = choose_training_runs(list(data.motions.values()), settings.control)
    with reported(f"training {settings.learner.kind}") as progress:
        trained = train_residual(
            base, used, settings.control, settings.learner, settings.signals, settings.replay,
            settings.seed, progress,
        )  # fmt: skip
    description = write_residual(out, trained.residual(settings.control))
    story = provenance(settings) | {"train_runs": [m.run.id for m in used], "base": base.name}
    path = out / f"{name}.yaml"
    write_model(base, path, description, story)
    return read_model(path, catalogue)
