"""What the next effect could be, where loops on board take demands from the mixer."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.damping import QuadraticDamping
from rovsim.dynamics.effects.onboard_control import OnboardControl
from rovsim.dynamics.effects.thrusters import PropellerTorque
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.fit import fit_noise_only
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns
from rovsim.simulation.synthetic_tank.settings import Log

LOOP = {"gain_yaw": 1.4, "bandwidth_yaw": 2.5}
RATIO = 0.02  # m


def workspace_of_torque(tmp_path, hidden):
    entries = tuple(EffectEntry(effect=name, parameters=values) for name, values in hidden.items())
    base, runs = observed(tmp_path, duration=20.0, effects=entries, log=Log(kind="demand"))
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    listed = list_candidates(runs, built_in(), base.vehicle)
    torque = [c for c in listed if c.effect is PropellerTorque]
    known = linearise_candidates(bank, Hypothesis(base), torque)
    return SearchWorkspace.begin(WhiteColumns(bank, known, FIRST_NOISE), SearchSettings())


def test_the_torque_of_propellers_is_foreseen_beside_a_loop_about_yaw(tmp_path):
    hidden = {OnboardControl.id: LOOP, PropellerTorque.id: {"ratio": RATIO}}
    first = workspace_of_torque(tmp_path, hidden)
    loop = Hypothesis(first.bank.model, (Term(OnboardControl(**LOOP), ()),))
    workspace = first.with_noise(loop, FIRST_NOISE)
    (proposal,) = workspace.first_order.propose(workspace.fit(loop))
    assert proposal.term.effect["ratio"] == pytest.approx(RATIO, rel=0.1)
    assert proposal.net_decrease > 0.0


def test_noise_stays_what_it_was_where_its_filters_do_not_hold_what_was_found(tmp_path):
    """On the thesis' runs a drift took all of heave's disturbance: nothing held a model there."""
    first = workspace_of_torque(tmp_path, {OnboardControl.id: LOOP})
    base = first.bank.model
    pushed = Term(QuadraticDamping(**dict.fromkeys(("surge", "sway", "heave"), -180.0)), ("heave",))
    h = Hypothesis(base, (Term(OnboardControl(**LOOP), ("gain_yaw",)), pushed))
    found = fit_noise_only(first.bank.linearise(h), first.bank, FIRST_NOISE)
    assert found.is_finite
    sure = replace(FIRST_NOISE, disturbance_std=np.full(6, 1e-20), measurement_std=np.ones(6))
    workspace = first.with_noise(Hypothesis(base), sure)
    assert not workspace.columns.sensitivities_at(h).is_finite
    for after in (workspace.update_after(found), workspace.relinearise_if_changed(found)):
        assert np.isfinite(after.noise.disturbance_std).all()
        assert np.isfinite(after.columns.gram(found.linearised)).all()


def test_a_gram_matrix_is_made_once_and_anew_under_another_noise(tmp_path):
    columns = workspace_of_torque(tmp_path, {PropellerTorque.id: {"ratio": RATIO}}).columns
    seen = columns.bank.linearise(Hypothesis(columns.bank.model))
    G = columns.gram(seen)
    assert columns.gram(seen) is G
    louder = replace(FIRST_NOISE, disturbance_std=2.0 * FIRST_NOISE.disturbance_std)
    assert columns.under(columns.bank, louder).gram(seen)[0, 0] < G[0, 0]
