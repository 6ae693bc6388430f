"""Score proposed equations against the laws that were hidden."""

from typing import Sequence

import numpy as np

from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.known_laws import LAWS, KnownLaw
from rovsim.results.base import or_nan
from rovsim.results.blind_benchmark import LawRates
from rovsim.results.diagnosis import Diagnosis, ProposedEquation

MIN_ERROR_DROP = 0.5  # of the way to the noise floor


def rate_laws(answers: Sequence[KeptAnswer]) -> dict[str, LawRates]:
    """Rate the equations of all answers of one method.

    Returns:
        Rates by law, then of all laws, then of the cases that hide no law; empty where no law was
        hidden.
    """
    by_law = {name: [a for a in answers if _hides(a) == name] for name in LAWS}
    rates = {name: _rate(group, LAWS[name]) for name, group in by_law.items() if group}
    if not rates:
        return {}
    count = np.array([rate.cases for rate in rates.values()])
    keys = ("unexplained", "proposed", "right", "half")
    means = {key: _mean([getattr(rate, key) for rate in rates.values()], count) for key in keys}
    rates["all laws"] = LawRates(cases=int(count.sum()), **means)
    without_law = [a for a in answers if _hides(a) is None]
    if without_law:
        rates["no law"] = _rate(without_law, None)
    return rates


def _mean(shares: Sequence[float], count: np.ndarray) -> float:
    return float(np.average(shares, weights=count))


def _hides(one: KeptAnswer) -> str | None:
    """Return the name of the law that a case hides, if any."""
    names = [o.name for o in one.case.outside if o.name in LAWS]
    return names[0] if names and one.case.kind == "law" else None


def _rate(answers: Sequence[KeptAnswer], law: KnownLaw | None) -> LawRates:
    diagnoses = [answer.diagnosis for answer in answers]
    laws = [
        answer.unexplained.proposal if isinstance(answer, Diagnosis) else None
        for answer in diagnoses
    ]
    right = [p is not None and law is not None and is_right(p, law) for p in laws]
    half = [isinstance(d, Diagnosis) and error_drop(d) >= MIN_ERROR_DROP for d in diagnoses]
    return LawRates(
        cases=len(answers),
        unexplained=float(
            np.mean([d is not None and d.verdict == "unexplained" for d in diagnoses])
        ),
        proposed=float(np.mean([p is not None for p in laws])),
        right=float(np.mean(right)),
        half=float(np.mean(half)),
    )


def is_right(proposal: ProposedEquation, law: KnownLaw) -> bool:
    """Whether an equation is right.

    Its largest term has to act where the law does, and its terms there have to be made of the law's
    quantities, no more and no fewer.
    """
    largest = max(proposal.terms, key=lambda term: or_nan(term.size))
    quantities = {q for term in proposal.terms if term.on in law.on for q in term.quantities}
    quantities = (quantities - {"speed"}) | {"u", "v", "w"} if "speed" in quantities else quantities
    return largest.on in law.on and quantities == law.quantities


def error_drop(diagnosis: Diagnosis) -> float:
    """Return how far the equation takes the error from the selected effects to the noise floor.

    Returns:
        0 where the equation does not help, 1 where the error reaches the noise floor; NaN where
        there is no equation.
    """
    if diagnosis.unexplained.proposal is None:
        return float("nan")
    with_equation = or_nan(diagnosis.ladder.models[-1].windows_2s)
    with_effects, noise_floor = (
        or_nan(diagnosis.error.with_effects),
        or_nan(diagnosis.error.noise_floor),
    )
    return (with_effects - with_equation) / (with_effects - noise_floor)
