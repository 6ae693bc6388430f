"""Effects of the catalogue that stand in for a law: the law is seen behind them."""

import pytest

from flown import observed
from rovsim.diagnosis.equations.masked import find_masked_laws
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.force_curve import CurveExponent
from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.dynamics.laws.propeller_lag import PropellerLag
from rovsim.dynamics.laws.thruster_play import ThrusterPlay
from rovsim.dynamics.laws.thruster_rate import ThrustRate
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns

LAG, CURVE = ThrusterLag(time_constant=0.1), CurveExponent(exponent=1.2)
SHAPED = tuple(
    EffectEntry(effect=e.id, parameters={p.name: e[p.name] for p in e.parameters})
    for e in (LAG, CURVE)
)


@pytest.mark.parametrize(
    ("hidden", "masked"),
    [
        ({"unlisted": [ThrusterPlay(band=2.2)]}, True),
        ({"unlisted": [ThrustRate(ramp=0.07)]}, True),
        ({"unlisted": [PropellerLag(time_constant=0.15)]}, True),
        ({"effects": SHAPED}, False),
    ],
)
def test_how_thrusters_answer_is_seen_behind_what_shapes_the_thrust(tmp_path, hidden, masked):
    """Play was a lag, a curve and six more, five of them at a probability of one."""
    base, runs = observed(tmp_path, duration=30.0, **hidden)
    terms = (Term(LAG, ("time_constant",)), Term(CURVE, ("exponent",)))
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    noise, _ = bank.fit_noise(bank.innovations(base), FIRST_NOISE)
    candidates = list_candidates(runs, built_in(), base.vehicle)
    sensitivities = linearise_candidates(bank, Hypothesis(base), candidates[:4])
    columns = WhiteColumns(bank, sensitivities, noise)
    workspace = SearchWorkspace.begin(columns, SearchSettings())
    accepted = SearchResult(workspace, workspace.fit(Hypothesis(base, terms)), ())
    found = find_masked_laws(accepted, 0.0)
    assert [one.what for one in found] == ["thrust with a memory"] * masked
