"""Where all of it is wrong at once: what the demands command, and how much drag there is."""

import numpy as np
import pytest

from flown import observed
from rovsim.core.axes import AXES
from rovsim.diagnosis.answer import settle
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation
from rovsim.diagnosis.selection.joint_fit import add_found, fit_jointly, prune_together
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.diagnosis.uncertainty.identifiability import group_joint_parameters
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.residual_source import Linearised
from rovsim.estimation.observer.usable_runs import select_usable
from rovsim.estimation.replay_fit import Replays, fit_to_replays
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns
from rovsim.simulation.synthetic_tank.settings import Log

GAIN = dict(zip(AXES, (0.9, 0.8, 0.7, 2.0, 2.0, 2.0), strict=True))
WIDTH = dict(zip(AXES, (1.5, 1.5, 1.5, 4.0, 4.0, 4.0), strict=True))
HIDDEN = (
    EffectEntry(
        effect="onboard_control",
        parameters={f"gain_{a}": g for a, g in GAIN.items()}
        | {f"bandwidth_{a}": w for a, w in WIDTH.items()},
    ),
    EffectEntry(effect="quadratic_damping", parameters={"surge": -90.0, "sway": -150.0}),
)


class OpenScale:
    """Drag is twice what the file says; while the gain is free, no value is sure."""

    penalty = 10.0

    def fit(self, h, prior_std):
        free = {term.id for term in h.terms}
        std = np.full(len(h.x), 100.0 if "thruster_gain" in free else 0.1)
        return Fit(Linearised(h, [], []), FIRST_NOISE, 0.0, np.diag(std**2))

    def score(self, found):
        free = {term.id for term in found.hypothesis.terms}
        return (100.0 if "quadratic_damping" in free else 0.0) - self.penalty * len(free)


def test_of_an_open_scale_the_gain_goes_and_what_differs_stays():
    base = nominal(load_vehicle("bluerov2_heavy"))
    terms = (
        Term(built_in()["added_mass"](), ("surge",)),
        Term(built_in()["quadratic_damping"](surge=80.0), ("surge",)),
        Term(built_in()["thruster_gain"](all=2.0), ("all",)),
    )
    start = Hypothesis(base, terms)
    found = prune_together(OpenScale(), OpenScale().fit(start, np.inf))
    assert [term.id for term in found.hypothesis.terms] == ["quadratic_damping"]


@pytest.mark.parametrize(("found", "kept"), [("quadratic_damping", True), ("lift", False)])
def test_what_a_search_found_competes_beside_all_that_may_be_wrong(found, kept):
    base = nominal(load_vehicle("bluerov2_heavy"))
    mass = Term(built_in()["added_mass"](surge=2.0), ("surge",))
    joint = OpenScale().fit(Hypothesis(base, (mass,)), np.inf)
    effect = built_in()[found]
    search = (
        Term(built_in()["added_mass"](surge=9.0), ("surge",)),
        Term(effect(), effect.free_at({})),
    )
    terms = add_found(OpenScale(), joint, search).hypothesis.terms
    assert [term.id for term in terms] == ["added_mass", *([found] if kept else [])]
    assert terms[0] == mass  # of the joint fit


def test_loops_and_drag_that_are_all_wrong_come_back_together(tmp_path):
    base, runs = observed(tmp_path, duration=20.0, effects=HIDDEN, log=Log(kind="demand"))
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    listed = list_candidates(runs, built_in(), base.vehicle)
    some = [c for c in listed if c.effect.id in ("added_mass", "linear_damping")]
    known = linearise_candidates(bank, Hypothesis(base), some)
    workspace = SearchWorkspace.begin(WhiteColumns(bank, known, FIRST_NOISE), SearchSettings())
    selection = fit_jointly(workspace, base, AXES)
    found, bank = selection.best, selection.workspace.bank
    terms = {t.id: t.effect for t in found.hypothesis.terms}
    assert "thruster_gain" not in terms
    assert all(r.deviance_difference > 0.0 for r in selection.rivals)
    loops, body = terms["onboard_control"], found.hypothesis.model.body
    for axis in AXES:
        pushed = loops[f"gain_{axis}"] * loops[f"bandwidth_{axis}"]
        assert pushed == pytest.approx(GAIN[axis] * WIDTH[axis], rel=0.2), axis
    for i, axis in enumerate(AXES[:3]):
        # a loop and linear drag do the same about a velocity: only their sum is known
        decay = loops[f"bandwidth_{axis}"] + body.linear[i] / body.M[i, i]
        true = WIDTH[axis] + base.body.linear[i] / base.body.M[i, i]
        assert decay == pytest.approx(true, rel=0.35), axis
    settled = settle(selection, select_usable(runs), HoldoutValidation((), runs))
    left = {t.id: t.free for t in settled.fit.hypothesis.terms}
    assert left == {t.id: t.free for t in found.hypothesis.terms}  # all of it, though none is sure
    again = fit_to_replays(found, bank)
    assert [t.id for t in again.hypothesis.terms] == [t.id for t in found.hypothesis.terms]
    assert np.isfinite(again.std).all()
    joint = [set(group) for group in group_joint_parameters(again)]
    loop = "linear_damping.surge", "onboard_control.gain_surge", "onboard_control.bandwidth_surge"
    assert set(loop) in joint  # as said above
    assert any({"quadratic_damping.surge", "added_mass.surge"} <= g for g in joint)  # one scale
    before, after = Replays(tuple(runs)).evaluate([found.hypothesis.model, again.hypothesis.model])[
        0
    ]
    assert np.sum(after**2) <= np.sum(before**2)
