"""Beside a delay a short lag shows in its curvature alone, and is found by that."""

import pytest

from flown import observed
from rovsim.core.axes import AXES
from rovsim.diagnosis.selection.curvature import list_curved
from rovsim.diagnosis.selection.forward_selection import add_best
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.file_effects import FILE_EFFECT_IDS, free_terms, has_loose_file
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns

DELAY, LAG = 0.06, 0.025  # s
OFF = {"surge": 30.0, "sway": -40.0, "heave": 20.0, "roll": 0.3, "pitch": -0.3, "yaw": 0.2}
CHANCE = 10.0  # twice the log likelihood


def fly(folder, delay, lag):
    """A workspace, and a fit of a loose vehicle file with a delay."""
    values = {
        "input_delay": {"delay": delay},
        "thruster_lag": {"time_constant": lag},
        "quadratic_damping": OFF,
        "added_mass": {"surge": 2.0, "sway": -2.0},
    }
    hidden = tuple(EffectEntry(effect=name, parameters=own) for name, own in values.items())
    base, runs = observed(folder, duration=40.0, effects=hidden)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    ids = (*FILE_EFFECT_IDS, InputDelay.id, ThrusterLag.id)
    some = [c for c in list_candidates(runs, built_in(), base.vehicle) if c.effect.id in ids]
    known = linearise_candidates(bank, Hypothesis(base), some)
    workspace = SearchWorkspace.begin(WhiteColumns(bank, known, FIRST_NOISE), SearchSettings())
    stated = ("quadratic_damping", "added_mass", "linear_damping")
    file = free_terms(base, AXES, [built_in()[name] for name in stated])
    late = Term(InputDelay(delay=delay + lag), ("delay",))
    rough = workspace.fit(Hypothesis(base, (*file, late)))
    workspace = workspace.with_noise(rough.hypothesis, rough.noise)
    return workspace, workspace.fit(rough.hypothesis)


@pytest.mark.parametrize("lag", [0.0, LAG])
def test_a_short_lag_is_found_beside_a_delay_in_a_loose_file(tmp_path, lag):
    workspace, current = fly(tmp_path, DELAY, lag)
    assert has_loose_file(current.hypothesis)
    added = add_best(workspace, current, CHANCE)
    found = {t.id: t.effect for t in added.hypothesis.terms} if added else {}
    assert (ThrusterLag.id in found) == bool(lag)
    if lag:
        assert found[InputDelay.id]["delay"] == pytest.approx(DELAY, abs=0.003)
        assert found[ThrusterLag.id]["time_constant"] == pytest.approx(LAG, abs=0.003)


def test_what_is_accepted_is_not_proposed_by_its_curvature(tmp_path):
    workspace, current = fly(tmp_path, DELAY, LAG)
    proposal = list_curved(workspace, current)[0]
    assert proposal.term.id == ThrusterLag.id
    assert proposal.net_decrease > CHANCE
    both = workspace.fit(current.hypothesis.with_term(proposal.term))
    assert ThrusterLag.id not in {p.term.id for p in list_curved(workspace, both)}
