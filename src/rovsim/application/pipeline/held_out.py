"""A held-out run: scored with models that never saw it, beside published errors, with pitfalls."""

from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.application.pipeline.replays import replay_models, score_replays
from rovsim.application.sections import SimulationSettings
from rovsim.core.files import write_json
from rovsim.dynamics.model import Model
from rovsim.evaluation.held_out.pitfalls import SCHEMA, measure_pitfalls
from rovsim.evaluation.held_out.published_errors import against, demanded, read_published
from rovsim.learning.learner import LearnerSettings
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.tables import published_errors_table


def score_held_out(
    models: Sequence[Model], motion: Motion, settings: SimulationSettings
) -> dict[str, Any]:
    """`comparison.json` of one run."""
    return score_replays([motion], replay_models(models, [motion], settings))


def compare_with_published(
    published: Path,
    comparisons: Mapping[str, Mapping[str, Any]],
    motions: Sequence[Motion],
    out: Path,
    tables: Path,
) -> None:
    """Write `published_errors.json` to `out`, and its tables into the folder `tables`.

    Args:
        published: csv of the errors of others.
        comparisons: `comparison.json` by held-out run.
        motions: these runs.
        out: the file.
        tables: the folder.

    Raises:
        BadInput: the published errors cannot be read, or are of other runs.
    """
    moved = {motion.run.id: demanded(motion.commands) for motion in motions}
    found = against(read_published(published), comparisons, moved)
    published_errors_table(found).write(tables, "published_errors")
    write_json(out, found)


def measure_pitfalls_by_run(
    motions: Sequence[Motion],
    models: Sequence[Model],
    learners: Mapping[str, LearnerSettings],
    settings: SimulationSettings,
) -> dict[str, Any]:
    """`pitfalls.json`; `models`: the effects found while that run was held out."""
    runs = {
        test.run.id: measure_pitfalls(
            model, [m for m in motions if m is not test], test, dict(learners),
            settings.signals, settings.replay,
        )
        for test, model in zip(motions, models, strict=True)
    }  # fmt: skip
    return {"schema": SCHEMA, "runs": runs}
