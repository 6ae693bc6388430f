"""Bring together the scores, the ladder and the growth of errors of a study."""

from pathlib import Path
from typing import Sequence

from rovsim.application.pipeline.replays import Replays
from rovsim.evaluation.score_collector import ScoreCollector
from rovsim.measurement.signals.motion import Motion
from rovsim.results.comparison import Comparison
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.ladder import Ladder


def summarize(
    motions: Sequence[Motion],
    replays: Replays,
    scores: Sequence[Comparison],
    searches: Sequence[ErrorConditions],
    diagnosis: Diagnosis,
    out: Path,
) -> None:
    """Write `comparison.json`, `ladder.json`, `growth.json` and `where.json`.

    Args:
        motions: all runs.
        replays: by model, in the order of the ladder.
        scores: of each model.
        searches: conditions under which each model fails.
        diagnosis: whose effects are added to the ladder one by one.
        out: folder that is written to.
    """
    scored_runs = ScoreCollector.of(motions, replays)
    ladder = Ladder.with_diagnosis(scored_runs.steps, diagnosis.ladder.steps)
    ErrorConditions.merged(searches).write(out / "where.json")
    scored_runs.growth.write(out / "growth.json")
    ladder.write(out / "ladder.json")
    Comparison.merged(scores).write(out / "comparison.json")
