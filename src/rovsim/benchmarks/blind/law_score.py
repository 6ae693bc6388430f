"""Equations judged against the laws that were hidden."""

from typing import Sequence

import numpy as np

from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.laws import LAWS, KnownLaw
from rovsim.results.base import or_nan
from rovsim.results.blind_benchmark import LawRates
from rovsim.results.diagnosis import Diagnosis, ProposedEquation

HALF = 0.5  # of the way to the noise floor


def rate_laws(answers: Sequence[KeptAnswer]) -> dict[str, LawRates]:
    """By law, then all of them, then the cases that hide none; empty where no law was hidden."""
    hidden = {name: [a for a in answers if _hides(a) == name] for name in LAWS}
    found = {name: _rate(own, LAWS[name]) for name, own in hidden.items() if own}
    if not found:
        return {}
    count = np.array([one.cases for one in found.values()])
    keys = ("unexplained", "proposed", "right", "half")
    means = {key: _mean([getattr(one, key) for one in found.values()], count) for key in keys}
    found["all laws"] = LawRates(cases=int(count.sum()), **means)
    others = [a for a in answers if _hides(a) is None]
    if others:
        found["no law"] = _rate(others, None)
    return found


def _mean(shares: Sequence[float], count: np.ndarray) -> float:
    return float(np.average(shares, weights=count))


def _hides(one: KeptAnswer) -> str | None:
    names = [o.name for o in one.case.outside if o.name in LAWS]
    return names[0] if names and one.case.kind == "law" else None


def _rate(answers: Sequence[KeptAnswer], law: KnownLaw | None) -> LawRates:
    said = [one.diagnosis for one in answers]
    laws = [one.unexplained.proposal if isinstance(one, Diagnosis) else None for one in said]
    right = [p is not None and law is not None and is_right(p, law) for p in laws]
    half = [isinstance(d, Diagnosis) and way(d) >= HALF for d in said]
    return LawRates(
        cases=len(answers),
        unexplained=float(np.mean([d is not None and d.verdict == "unexplained" for d in said])),
        proposed=float(np.mean([p is not None for p in laws])),
        right=float(np.mean(right)),
        half=float(np.mean(half)),
    )


def is_right(proposal: ProposedEquation, law: KnownLaw) -> bool:
    """Whether the largest term acts where the law does, and such terms have its quantities."""
    main = max(proposal.terms, key=lambda term: or_nan(term.size))
    named = {q for term in proposal.terms if term.on in law.on for q in term.quantities}
    named = (named - {"speed"}) | {"u", "v", "w"} if "speed" in named else named
    return main.on in law.on and named == law.quantities


def way(found: Diagnosis) -> float:
    """Share of the error between selected effects and noise floor that goes; NaN: unknown."""
    if found.unexplained.proposal is None:
        return float("nan")
    reached = or_nan(found.ladder.models[-1].windows_2s)
    before, floor = or_nan(found.error.with_effects), or_nan(found.error.noise_floor)
    return (before - reached) / (before - floor)
