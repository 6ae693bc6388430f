"""Every effect of the catalogue is found again, with its values, in a tank that hides it."""

import pytest

from rovsim.application.configuration import compose
from rovsim.application.pipeline.measured_campaign import measure, open_campaign
from rovsim.benchmarks.blind.flight import fly
from rovsim.benchmarks.blind.suites import hiding
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import build_effect
from rovsim.dynamics.effects.base import MeasurementFilter, StochasticCurrent
from rovsim.dynamics.model import nominal
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.train_runs import prepare_train

MINUTE = {"runs": [{"id": "train", "control": "6dof", "split": "train"}]}


# Told by the noise: recovery/test_camera.py, recovery/test_drifting_current.py.
EVERY = [
    name
    for name, cls in built_in().items()
    if not issubclass(cls, MeasurementFilter | StochasticCurrent)
]


@pytest.fixture(scope="module")
def settings():
    """What a diagnosis runs by."""
    return compose([])


@pytest.mark.parametrize("name", EVERY)
def test_a_tank_that_hides_it_gives_it_back(name, settings, tmp_path):
    flown = fly(hiding("single", (name,), 2, "development", tank=MINUTE), tmp_path / "raw")
    data = measure(open_campaign(str(tmp_path / "raw")), settings.signals)
    base = nominal(data.vehicle)
    runs = list(prepare_train(data.runs, settings.replay, built_in(), base.body.free).runs)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    hidden = build_effect(flown.hidden[0], built_in()).given()
    listed = [c for c in list_candidates(runs, built_in(), base.vehicle) if c.effect.id == name]
    if not listed[0].free:  # tried, not fitted
        fits = [fit(Hypothesis(base, (c.term(),)), bank, FIRST_NOISE) for c in listed]
        best = max(fits, key=lambda one: one.two_log_likelihood)
        assert best.hypothesis.terms[0].effect.given() == hidden
        return
    known = [c for c in listed if set(hidden) <= set(c.free)]
    starts = [_moved_away(_free_all(c, hidden), hidden) for c in known]
    fits = [fit(Hypothesis(base, (term,)), bank, FIRST_NOISE) for term in starts]
    best = max(fits, key=lambda one: one.two_log_likelihood)
    fresh = bank.redesign(best.hypothesis.model, best.noise)
    best = fit(best.hypothesis, fresh, best.noise)
    (term,) = best.hypothesis.terms
    sure = dict(zip(term.free, best.std * [p.scale for p in term.parameters], strict=True))
    for parameter, value in hidden.items():
        size = _declared(term, parameter).size(value)
        assert abs(term.effect[parameter] - value) < max(0.1 * size, 4.0 * sure[parameter])
        assert sure[parameter] < 0.5 * size


def _declared(term, name):
    return next(p for p in term.effect.parameters if p.name == name)


def _free_all(candidate, hidden):
    """All parameters free, but not one and its eight parts at once: `all` thrusters, and each."""
    if "all" in hidden:
        return candidate.term(["all"])
    return candidate.term([name for name in candidate.free if name != "all"])


def _moved_away(start, hidden):
    """What is hidden at least a quarter of its change from the truth."""
    values = {}
    for name, value in hidden.items():
        known = _declared(start, name)
        if abs(start.effect[name] - value) < 0.25 * known.size(value):
            values[name] = known.combine(known.neutral_value, value, 0.7)
    return Term(start.effect.with_values(values), start.free)
