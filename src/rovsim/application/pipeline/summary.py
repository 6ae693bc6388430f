"""Score the models of a study: errors, ladder, growth of errors and conditions in one place."""

from pathlib import Path
from typing import Sequence

from rovsim.application.pipeline.replays import Replays
from rovsim.evaluation.score_collector import ScoreCollector
from rovsim.measurement.signals.motion import Motion
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.ladder import Ladder


def summarize(
    motions: Sequence[Motion],
    replays: Replays,
    searches: Sequence[ErrorConditions],
    diagnosis: Diagnosis,
    out: Path,
) -> None:
    """Write `comparison.json`, `ladder.json`, `growth.json` and `where.json`.

    Args:
        motions: all runs.
        replays: by model, in the order of the ladder.
        searches: conditions under which each model fails.
        diagnosis: whose effects are added to the ladder one by one.
        out: folder that is written to.
    """
    scored_runs = ScoreCollector.of(motions, replays)
    ladder = Ladder.with_diagnosis(scored_runs.steps, diagnosis.ladder.steps)
    ErrorConditions.merged(searches).write(out / "where.json")
    scored_runs.growth.write(out / "growth.json")
    ladder.write(out / "ladder.json")
    scored_runs.comparison.write(out / "comparison.json")
