"""The study's scores, ladder and growth of errors, brought together."""

from pathlib import Path
from typing import Any, Sequence

from rovsim.application.pipeline.replays import Replays, climb, measure_growth
from rovsim.core.files import write_json
from rovsim.evaluation.error_conditions import merged
from rovsim.evaluation.ladder import with_diagnosis
from rovsim.evaluation.scores import comparison
from rovsim.measurement.signals.motion import Motion


def summarize(
    motions: Sequence[Motion],
    replays: Replays,
    scores: Sequence[dict[str, Any]],
    searches: Sequence[dict[str, Any]],
    diagnosis: dict[str, Any],
    out: Path,
) -> None:
    """Write `comparison.json`, `ladder.json`, `growth.json` and `where.json`.

    Args:
        motions: all runs.
        replays: by model, in the order of the ladder.
        scores: of every model on every run.
        searches: `where.json` of single models.
        diagnosis: `diagnosis.json`; its effects stand in the ladder one by one.
        out: the folder.
    """
    ladder = with_diagnosis(climb(motions, replays), diagnosis["ladder"]["steps"])
    write_json(out / "where.json", merged(searches))
    write_json(out / "growth.json", measure_growth(motions, replays))
    write_json(out / "ladder.json", ladder)
    write_json(out / "comparison.json", comparison(scores))
