"""Choose the thresholds of the sparse regressions: python -m rovsim.benchmarks.blind.tuning.

They are chosen on development seeds, by the cases of the quick suite that hide effects of the
catalogue or nothing. The best setting is exact in the most cases, and among equals has the right
first name most often.
"""

import tempfile
from pathlib import Path
from typing import Any, Iterator

from rovsim.benchmarks.blind.case import Case
from rovsim.benchmarks.blind.flight import fly
from rovsim.benchmarks.blind.library import Problem
from rovsim.benchmarks.blind.score import Score, score
from rovsim.benchmarks.blind.sparse import Regression, answer, forward, of_campaign, thresholded
from rovsim.benchmarks.blind.suites import suite
from rovsim.core.progress import counted

THRESHOLDS = (0.05, 0.07, 0.1, 0.13, 0.15, 0.17, 0.2, 0.3, 0.4)
RIDGES = (1e-3, 0.01, 0.02, 0.03, 0.1, 0.3)
GAINS, LENGTHS = (0.4, 0.3, 0.2, 0.1, 0.05, 0.02), (2, 8)


def settings() -> Iterator[tuple[str, Regression]]:
    """Yield every setting that is tried, with its description."""
    for threshold in THRESHOLDS:
        for ridge in RIDGES:
            yield f"stlsq, threshold {threshold}, ridge {ridge}", thresholded(threshold, ridge)
    for gain in GAINS:
        for most in LENGTHS:
            yield f"frols, least gain {gain}, at most {most} terms", forward(gain, most)


def prepared(case: Case) -> tuple[Case, Problem]:
    """Fly a case; return it as flown, and its regression problem."""
    with tempfile.TemporaryDirectory() as folder:
        flown = fly(case, Path(folder, "campaign"))
        return flown, of_campaign(Path(folder, "campaign"))


def worth(scores: list[Score]) -> tuple[float, float]:
    """Return the share of exact answers and that of right first names."""
    firsts = [s.first for s in scores if s.first is not None]
    return sum(s.exact_strict for s in scores) / len(scores), sum(firsts) / len(firsts)


def tuned() -> dict[str, Any]:
    """Score every setting: shares of exact answers and of right first names, best first."""
    cases = [c for c in suite("quick", "development") if not c.outside]
    scores: dict[str, list[Score]] = {}
    for case in counted(cases, "tuning"):
        flown, problem = prepared(case)
        for name, regression in settings():
            scores.setdefault(name, []).append(score(flown, answer(problem, regression)))
    return dict(sorted(((k, worth(v)) for k, v in scores.items()), key=lambda kv: kv[1])[::-1])


if __name__ == "__main__":
    for name, (exact, first) in tuned().items():
        print(f"{name:50} exact {exact:.2f} first {first:.2f}")
