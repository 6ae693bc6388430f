"""What seems sure only beside undetermined values of another effect is not kept."""

from functools import reduce
from operator import add

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.selection.imitation import drop_imitations
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.damping import LinearDamping
from rovsim.dynamics.effects.onboard_control import OnboardControl
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns

LOOP = {"gain_yaw": 1.1, "bandwidth_yaw": 2.0}


def search_for_loops(base, runs, truth):
    """A search for loops on board and drag, with filters that suit the true model."""
    bank = FilterBank.design(runs, truth, FIRST_NOISE)
    noise, _ = bank.fit_noise(bank.innovations(truth), FIRST_NOISE)
    bank = bank.redesign(truth, noise)
    listed = list_candidates(bank.runs, built_in(), base.vehicle)
    loops_and_drag = [c for c in listed if c.effect in (OnboardControl, LinearDamping)]
    columns = linearise_candidates(bank, Hypothesis(base), loops_and_drag)
    return SearchWorkspace.begin(WhiteColumns(bank, columns, noise), SearchSettings())


@pytest.mark.parametrize("surge", [0.0, 20.0], ids=["a loop", "a loop, and drag elsewhere"])
def test_drag_on_the_axis_of_a_loop_is_the_loops(tmp_path, surge):
    """Only the sum of both can be seen, and from afar it seems that drag is needed."""
    drag, loop = LinearDamping(surge=surge), OnboardControl(**LOOP)
    hidden = (loop, drag) if surge else (loop,)
    entries = tuple(EffectEntry(effect=one.id, parameters=one.given()) for one in hidden)
    base, runs = observed(tmp_path, duration=40.0, effects=entries, log={"kind": "demand"})
    workspace = search_for_loops(base, runs, reduce(add, hidden, base))
    free = ("yaw", "surge") if surge else ("yaw",)
    far = OnboardControl(gain_yaw=35.0, bandwidth_yaw=0.06)
    terms = (Term(far, tuple(LOOP)), Term(LinearDamping(yaw=1.0, surge=surge), free))
    stuck = workspace.fit(Hypothesis(base, terms))
    assert stuck.hypothesis.terms[0].effect["gain_yaw"] > 10.0
    assert stuck.z_scores[2] > 5.0  # of drag about yaw
    fit = drop_imitations(workspace, stuck)
    assert workspace.score(fit) > workspace.score(stuck)
    found, *others = fit.hypothesis.terms
    assert np.allclose([found.effect[name] for name in LOOP], list(LOOP.values()), rtol=0.1)
    assert [term.free for term in others] == ([("surge",)] if surge else [])
