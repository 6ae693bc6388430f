"""Score held-out runs with models that never saw them; compare with published errors; pitfalls."""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.application.pipeline.replays import score_models
from rovsim.dynamics.model import Model
from rovsim.evaluation.held_out.pitfalls import measure_pitfalls
from rovsim.evaluation.held_out.published_errors import (
    compare_published,
    find_demanded,
    read_published,
)
from rovsim.learning.learner import learner_settings
from rovsim.measurement.signals.motion import Motion
from rovsim.results.comparison import Comparison
from rovsim.results.pitfalls import Pitfalls
from rovsim.simulation.settings import SimulationSettings


def score_held_out(
    models: Sequence[Model], motion: Motion, settings: SimulationSettings
) -> Comparison:
    """Replay and score one held-out run."""
    return score_models(models, {motion.run.id: motion}, settings).comparison


def compare_with_published(
    published: Path,
    comparisons: Sequence[Path],
    motions: Sequence[Motion],
    out: Path,
    tables: Path,
) -> None:
    """Write `published_errors.json` to `out`, and its tables into the folder `tables`.

    Args:
        published: csv of the errors of others.
        comparisons: files, for each held-out run, of the scores of models that never saw it.
        motions: these runs, in the same order.
        out: the file.
        tables: the folder.

    Raises:
        BadInput: the published errors cannot be read, or are of other runs.
    """
    from rovsim.reporting.tables import tabulate_published_errors  # a fold is scored without it

    demanded_axes = {motion.run.id: find_demanded(motion.commands) for motion in motions}
    scores = dict(zip(demanded_axes, map(Comparison.read, comparisons), strict=True))
    comparison = compare_published(read_published(published), scores, demanded_axes)
    tabulate_published_errors(comparison).write(tables, "published_errors")
    comparison.write(out)


def measure_pitfalls_by_run(
    motions: Sequence[Motion],
    models: Sequence[Model],
    learners: Mapping[str, Mapping[str, object]],
    settings: SimulationSettings,
) -> Pitfalls:
    """Measure on each held-out run what common mistakes cost.

    Args:
        motions: all runs.
        models: for each run, the model with the effects found while that run was held out.
        learners: by kind of residual, settings as in conf/residual.
        settings: how runs are cleaned and replayed.

    Raises:
        BadInput: a value in the settings of a learner is not allowed.
    """
    checked = {kind: learner_settings(dict(given)) for kind, given in learners.items()}
    runs = {
        test.run.id: measure_pitfalls(
            model,
            [m for m in motions if m.run.id != test.run.id],
            test,
            checked,
            settings,
        )
        for test, model in zip(motions, models, strict=True)
    }
    return Pitfalls(runs=runs)
