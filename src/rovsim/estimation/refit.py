"""The nominal parameters themselves refitted: how far the model comes without any new physics.

Damping, added mass, net buoyancy, its centre and one gain for all thrusters, all at once. What an
effect of another kind pushes goes into them as far as it will, which is why this is a step to
compare with and not a diagnosis.
"""

from dataclasses import replace
from typing import Sequence

from rovsim.core.model_names import REFITTED
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import FILE_EFFECTS, ONE_GAIN, free_terms
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Bounds, Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.usable_runs import select_usable

# A curve measured on the bench; gain, masses and drag are known to one scale only.
GAIN_BOUNDS = Bounds(0.5, 2.0)
FIT_ROUNDS = 3  # the filters suit the noise of the round before


def refit_nominal(base: Model, train: Sequence[ObservedRun]) -> Model:
    """The base with its own parameters at their most likely values on the train runs.

    An axis that no run moved keeps its coefficients; with too little to judge all of them stay.
    """
    usable = select_usable(train)
    if not usable.enough:
        return base.called(REFITTED)
    hypothesis, noise = _start(base, usable.moved), FIRST_NOISE
    for _ in range(FIT_ROUNDS):
        result = fit(hypothesis, FilterBank.design(usable.runs, base, noise), noise)
        hypothesis, noise = _fix_at_bounds(result.hypothesis), result.noise
    return hypothesis.model.called(REFITTED)


def _start(base: Model, moved: Sequence[str]) -> Hypothesis:
    """All parameters free and unchanged."""
    terms = free_terms(
        base, moved, [effect for effect in FILE_EFFECTS if effect is not ThrusterGain]
    )
    gain = Term(ThrusterGain(), ONE_GAIN, dict.fromkeys(ONE_GAIN, GAIN_BOUNDS))
    return Hypothesis(base, (*terms, gain))


def _fix_at_bounds(fitted: Hypothesis) -> Hypothesis:
    """With what came to rest at a bound fixed there."""

    def inside(term: Term) -> tuple[str, ...]:
        values = zip(term.parameters, (term.effect[name] for name in term.free), strict=True)
        return tuple(p.name for p, value in values if p.low < value < p.high)

    return replace(fitted, terms=tuple(replace(t, free=inside(t)) for t in fitted.terms))
