"""An effect that was found in the wrong mode, with another that makes up for it."""

from types import SimpleNamespace

from flown import observed
from rovsim.diagnosis.selection.forward_selection import change_mode
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
from rovsim.simulation.synthetic_tank.settings import Log

ROTATION = ("roll", "pitch", "yaw")
LOOPS = {f"gain_{a}": 0.6 for a in ROTATION} | {f"bandwidth_{a}": 2.2 for a in ROTATION}
SLOW = {"gain_roll": 100.0, "gain_pitch": 100.0, "bandwidth_roll": 0.1, "bandwidth_pitch": 0.1}


def test_a_slow_hold_of_angles_with_drag_gives_way_to_a_hold_of_rates(tmp_path):
    entry = EffectEntry(effect=OnboardControl.id, parameters=LOOPS)
    base, runs = observed(tmp_path, duration=20.0, effects=(entry,), log=Log(kind="demand"))
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    loops = [
        c for c in list_candidates(runs, built_in(), base.vehicle) if c.effect is OnboardControl
    ]
    known = linearise_candidates(bank, Hypothesis(base), loops)
    workspace = SearchWorkspace.begin(WhiteColumns(bank, known, FIRST_NOISE), SearchSettings())
    angles = Term(OnboardControl(**(LOOPS | SLOW), attitude=1.0), tuple(LOOPS))
    drag = Term(LinearDamping(roll=0.95, pitch=0.9), ("roll", "pitch"))
    found = change_mode(workspace, workspace.fit(Hypothesis(base, (angles, drag))))
    (term,) = found.hypothesis.terms
    assert term.effect["attitude"] == 0.0
    for name in ("bandwidth_roll", "bandwidth_pitch"):
        assert abs(term.effect[name] - LOOPS[name]) < 0.2


def test_what_has_no_modes_is_left_alone(tmp_path):
    base, _ = observed(tmp_path, duration=2.0)
    found = SimpleNamespace(hypothesis=Hypothesis(base, (Term(LinearDamping(), ("surge",)),)))
    workspace = SimpleNamespace(list_modes=lambda term: [])
    assert change_mode(workspace, found) is found
