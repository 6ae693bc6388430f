"""Summarize the scores of many cases: rates by kind of case and by effect, and detection limits."""

from dataclasses import dataclass
from typing import Callable, Iterable, Sequence

import numpy as np
from scipy.optimize import isotonic_regression

from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.calibration import calibrate
from rovsim.benchmarks.blind.case import Case
from rovsim.benchmarks.blind.law_score import rate_laws
from rovsim.benchmarks.blind.score import Score, score
from rovsim.results.blind_benchmark import EffectRates, MethodSummary, Rates
from rovsim.results.diagnosis import Answer, Diagnosis

WORSE_RATIO = 1.02  # of the nominal error: what a user would call worse; less is chance
HALF_SHARE = 0.5 - 1e-12  # one half, whichever way the mean of shares is rounded


@dataclass(frozen=True)
class ScoredCase:
    """A case and the score of its answer.

    Attributes:
        case: as it was flown.
        redrawn: whether it was flown with weaker effects, or by another pilot, than it declares.
        seconds: wall-clock time of the answer.
        score: of the answer; None where the method crashed.
        first: the first name; empty without one.
        verdict: of the answer; `error` where the method crashed.
        error: message of the crash.
        cpu_seconds: processor time of the answer.
        worse: whether its model errs more than the nominal one on test runs; None without a model.
    """

    case: Case
    redrawn: bool
    seconds: float
    score: Score | None
    first: str
    verdict: str
    error: str | None = None
    cpu_seconds: float | None = None
    worse: bool | None = None


def judge(answers: Sequence[KeptAnswer]) -> list[ScoredCase]:
    """Score the stored answers of one method."""
    return [_judge(answer) for answer in answers]


def _judge(one: KeptAnswer) -> ScoredCase:
    if one.diagnosis is None:
        return ScoredCase(
            one.case, one.redrawn, one.seconds, None, "", "error", one.error, one.cpu_seconds
        )
    selected, verdict = one.diagnosis.selected, one.diagnosis.verdict
    first = selected[0].effect if selected else ""
    worth = score(one.case, one.diagnosis)
    return ScoredCase(
        one.case,
        one.redrawn,
        one.seconds,
        worth,
        first,
        verdict,
        cpu_seconds=one.cpu_seconds,
        worse=_is_worse(one.diagnosis),
    )


def _is_worse(answer: Answer | Diagnosis) -> bool | None:
    """Whether a diagnosis ends with a model that is worse than the nominal one on the test runs."""
    if not isinstance(answer, Diagnosis) or answer.error.nominal is None:
        return None
    with_effects = answer.error.with_effects
    return with_effects is None or with_effects > WORSE_RATIO * answer.error.nominal


def summarize(answers: Sequence[KeptAnswer]) -> MethodSummary:
    """Rate one method by kind of case, by effect, and on physics outside the catalogue."""
    judged = judge(answers)
    outside = [j for j in judged if j.case.outside]
    return MethodSummary(
        cases=len(judged),
        failed=tuple(sorted(j.case.id for j in judged if j.score is None)),
        kinds={kind: rate(rows) for kind, rows in _grouped(judged, lambda j: j.case.kind)},
        effects={name: _rate_effect(rows) for name, rows in _by_effect(judged)},
        outside={n: rate(rows) for n, rows in _grouped(outside, lambda j: j.case.outside[0].name)},
        calibration=calibrate(answers),
        laws=rate_laws(answers),
    )


def _grouped(
    cases: Sequence[ScoredCase], key: Callable[[ScoredCase], str]
) -> Iterable[tuple[str, list[ScoredCase]]]:
    """Group cases; groups are in the order of their first member."""
    groups: dict[str, list[ScoredCase]] = {}
    for judged in cases:
        groups.setdefault(key(judged), []).append(judged)
    return groups.items()


def _by_effect(cases: Sequence[ScoredCase]) -> Iterable[tuple[str, list[ScoredCase]]]:
    """Group by effect the cases that hide one effect alone, with usual noise and length."""
    single = [j for j in cases if j.case.kind.split()[0] in ("single", "weak")]
    return _grouped(single, lambda j: j.case.hidden[0].effect)


def rate(cases: Sequence[ScoredCase]) -> Rates:
    """Return the shares of cases in which answers are right.

    A crash is wrong in every respect, except that it names nothing false.
    """
    scores = [j.score for j in cases]
    of_names = [s for j, s in zip(cases, scores, strict=True) if j.case.names]
    parameters = [p for s in scores if s for p in s.parameters]
    errors = [p.error for p in parameters]
    cpu_seconds = [j.cpu_seconds for j in cases if j.cpu_seconds is not None]
    return Rates(
        cases=len(cases),
        verdict=share([bool(s and s.verdict) for s in scores]),
        first_strict=share([bool(s and s.first_strict) for s in of_names]),
        first=share([bool(s and s.first) for s in of_names]),
        exact_strict=share([bool(s and s.exact_strict) for s in scores]),
        exact=share([bool(s and s.exact) for s in scores]),
        unseen=share([bool(s and s.unseen) for s in scores]),
        false_names_strict=share([bool(s and s.false_strict) for s in scores]),
        false_names=share([bool(s and s.false) for s in scores]),
        unexplained=share([bool(s and s.flagged) for s in scores]),
        alike=_mean([s.alike for s in scores if s]),
        redrawn=share([j.redrawn for j in cases]),
        worse=share([j.worse for j in cases if j.worse is not None]),
        seconds=_quantile([j.seconds for j in cases], 0.5),
        seconds_95=_quantile([j.seconds for j in cases], 0.95),
        cpu_seconds=_quantile(cpu_seconds, 0.5),
        cpu_seconds_95=_quantile(cpu_seconds, 0.95),
        parameters=len(errors),
        error_median=_quantile(errors, 0.5),
        error_95=_quantile(errors, 0.95),
        coverage=share([p.covered for p in parameters if p.covered is not None]),
    )


def share(flags: Sequence[bool]) -> float | None:
    """Return the share of True; None without flags."""
    return float(np.mean(flags)) if len(flags) else None


def _quantile(values: Sequence[float], share_below: float) -> float | None:
    return float(np.quantile(values, share_below)) if values else None


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None


def _rate_effect(cases: Sequence[ScoredCase]) -> EffectRates:
    """Rate the cases that hide one effect alone, and find its detection limit.

    The rates are those at strength 1.
    """
    full = [j for j in cases if j.case.kind == "single"]
    first_right = [(j.case.strength, bool(j.score and j.score.first)) for j in cases]
    wrong_answers = {j.first or j.verdict for j in full if not (j.score and j.score.first)}
    return EffectRates(
        **dict(rate(full)), limit=detection_limit(first_right), instead=tuple(sorted(wrong_answers))
    )


def detection_limit(outcomes: Sequence[tuple[float, bool]]) -> float | None:
    """Return the strength at which half of the cases are named right.

    That is where an isotonic fit to the shares by strength passes one half, interpolated in the
    logarithm of the strength.

    Args:
        outcomes: strength of each case, and whether the effect was named.

    Returns:
        The strength; the lowest tried if half are named even there. None if fewer than half are
        named at the highest, or if only one strength was tried.
    """
    strengths = np.array(sorted({s for s, _ in outcomes}))
    if len(strengths) < 2:
        return None
    counts = np.array([[sum(s == x for s, _ in outcomes)] for x in strengths], dtype=float).ravel()
    shares = np.array([np.mean([ok for s, ok in outcomes if s == x]) for x in strengths])
    fit = isotonic_regression(shares, weights=counts).x  # the nearest shares that never fall
    if fit[-1] < HALF_SHARE:
        return None
    k = int(np.argmax(fit >= HALF_SHARE))
    if k == 0:
        return float(strengths[0])
    fraction = (0.5 - fit[k - 1]) / (fit[k] - fit[k - 1])
    a, b = np.log(strengths[k - 1]), np.log(strengths[k])
    return float(np.exp(a + fraction * (b - a)))
