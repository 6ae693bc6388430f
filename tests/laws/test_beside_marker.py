"""What the next effect could be, where the motion is seen from a place beside CO."""

import pytest

from flown import observed
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.damping import QuadraticDamping
from rovsim.dynamics.effects.sensing import MarkerOffset
from rovsim.dynamics.effects.thruster_order import ThrusterOrder
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns

PLACE, DRAG = {"x": 0.15}, {"heave": 90.0}  # m, N s2/m2


@pytest.fixture(scope="module")
def searching(tmp_path_factory):
    """A workspace as a search begins, and the fit of the marker alone."""
    hidden = {MarkerOffset.id: PLACE, QuadraticDamping.id: DRAG}
    entries = tuple(EffectEntry(effect=name, parameters=values) for name, values in hidden.items())
    base, runs = observed(tmp_path_factory.mktemp("tank"), duration=30.0, effects=entries)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    listed = list_candidates(runs, built_in(), base.vehicle)
    drag = [c for c in listed if c.effect in (QuadraticDamping, MarkerOffset)]
    known = linearise_candidates(bank, Hypothesis(base), drag)
    workspace = SearchWorkspace.begin(WhiteColumns(bank, known, FIRST_NOISE), SearchSettings())
    return workspace, workspace.fit(Hypothesis(base, (Term(MarkerOffset(), ("x",)),)))


def proposed(workspace, found):
    """The quadratic drag in heave that a workspace proposes, to first order."""
    each = {p.term.id: p.term.effect for p in workspace.first_order.propose(found)}
    return each[QuadraticDamping.id]["heave"]


def test_drag_is_foreseen_beside_a_marker_that_is_not_at_co(searching):
    workspace, found = searching
    again = workspace.relinearise_if_changed(found)
    assert again.sensitivities.added_ids == (MarkerOffset.id,)
    before, after = (abs(proposed(w, found) / DRAG["heave"] - 1.0) for w in (workspace, again))
    assert after < 0.25
    assert after < 0.5 * before


def test_nothing_is_looked_at_again_beside_the_same(searching):
    workspace, found = searching
    again = workspace.relinearise_if_changed(found)
    assert again.relinearise_if_changed(found) is again


def test_columns_that_have_not_changed_are_kept(searching):
    workspace, found = searching
    drag = Hypothesis(found.hypothesis.base, (Term(QuadraticDamping(), ("surge",)),))
    assert workspace.relinearise_if_changed(workspace.fit(drag)) is workspace


def test_an_effect_that_is_tried_and_not_fitted_changes_no_columns(searching):
    """Thrusters in another order: it has no number that could be fitted."""
    workspace, found = searching
    order = Hypothesis(found.hypothesis.base, (Term(ThrusterOrder(), ()),))
    assert workspace.relinearise_if_changed(workspace.fit(order)) is workspace
