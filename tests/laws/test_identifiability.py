"""Values known only together, from covariances made up for the purpose."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.core.axes import AXES
from rovsim.diagnosis.advice import ADVICE_ON_DOUBT, LEAVE_OUT_ENDS, advise
from rovsim.diagnosis.checks.run_differences import RunDifference, RunValues
from rovsim.diagnosis.differing_runs import (
    COMPARE_TEST_RUNS,
    NOTHING_WRONG,
    HeldOutRuns,
    advise_on_difference,
)
from rovsim.diagnosis.selection.accepted_effects import AcceptedEffect, name_drift
from rovsim.diagnosis.selection.beside_law import (
    doubt_beside_law,
    keep_beside_law,
    list_rivals_beside,
)
from rovsim.diagnosis.selection.ranking import OrderedEffect
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.diagnosis.selection.withdrawn_probability import (
    find_constant_heave,
    find_leading,
    find_negative,
    find_small,
    withdraw_probability,
)
from rovsim.diagnosis.train_diagnosis import TrainDiagnosis
from rovsim.diagnosis.uncertainty.identifiability import (
    find_doubtful,
    find_perhaps_absent,
    group_joint_parameters,
)
from rovsim.dynamics.catalogue import Catalogue, built_in
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.buoyancy import NetBuoyancy
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.dynamics.effects.damping import LinearDamping, QuadraticDamping
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.effects.thruster_order import ThrusterOrder
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.dynamics.laws.law import Law
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.estimation.file_effects import free_terms
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.drifting_current import DriftFit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.random_walk import WalkRate
from rovsim.estimation.observer.residual_source import Linearised
from rovsim.estimation.observer.usable_runs import UsableRuns
from rovsim.results.diagnosis import DisturbedEnd
from worlds import motion, sticks

TERMS = ("linear_damping", "net_buoyancy")  # surge … yaw, and a force
NOISE = Noise(np.ones(6), np.ones(6), np.ones(6))


def fit(covariance, x=None):
    base = nominal(load_vehicle("bluerov2_heavy"))
    h = Hypothesis(base, free_terms(base, AXES, [built_in()[name] for name in TERMS]))
    seen = Linearised(h.at(np.zeros(7) if x is None else x), [], [])
    return Fit(seen, NOISE, 0.0, covariance)


def alike(*pairs):
    covariance = np.diag([4.0, 1.0, 9.0, 1.0, 1.0, 1.0, 2.0])
    std = np.sqrt(np.diag(covariance))
    for a, b, r in pairs:
        covariance[a, b] = covariance[b, a] = r * std[a] * std[b]
    return covariance


def test_what_is_sure_by_itself_is_in_no_group():
    assert group_joint_parameters(fit(alike())) == []
    assert group_joint_parameters(fit(alike((0, 6, 0.9)))) == []


def test_groups_are_chains_of_values_that_go_together_whatever_their_sign():
    found = group_joint_parameters(fit(alike((0, 6, -0.99), (6, 2, 0.98), (3, 4, 0.97))))
    assert found == [
        ["linear_damping.surge", "linear_damping.heave", "net_buoyancy.force"],
        ["linear_damping.roll", "linear_damping.pitch"],
    ]


def test_a_value_that_is_surely_there_is_known_by_itself():
    covariance = alike((0, 6, 0.99), (3, 4, 0.97))
    assert group_joint_parameters(fit(covariance, np.array([5.0, 0, 0, 0, 0, 0, 0]))) == [
        ["linear_damping.roll", "linear_damping.pitch"]
    ]


def test_a_term_is_doubtful_where_all_its_values_may_be_those_of_absence():
    sure, unsure = np.array([9.0, 0, 0, 0, 0, 0, 9.0]), np.array([9.0, 0, 0, 0, 0, 0, 1.0])
    assert find_doubtful(fit(alike(), sure)) is None
    assert find_doubtful(fit(alike(), unsure)) == 1
    assert find_doubtful(fit(alike(), np.array([0, 0, 0, 0, 0, 0, 9.0]))) == 0
    together = fit(alike((2, 6, 0.99)), unsure)
    assert find_doubtful(together) is None  # known together with drag
    assert find_perhaps_absent(together) == {"net_buoyancy"}  # no sure name all the same
    assert find_perhaps_absent(fit(alike(), sure)) == set()


def test_what_to_record_is_what_reveals_the_effect_most_of_them_belong_to():
    found = TrainDiagnosis(
        fit(alike()).hypothesis.base, UsableRuns((), (), (), (), 60.0), fit(alike())
    )
    loops = [f"onboard_control.gain_{axis}" for axis in AXES[:2]]
    advice = advise(found, [], [["added_mass.surge", "net_buoyancy.force"], loops], built_in())
    reveals = built_in()["onboard_control"].revealed_by
    assert advice == f"To know {loops[0]}, {loops[1]} one by one: {reveals}"
    assert advise(found, [], [], built_in()).startswith("Nothing is needed")
    assert advise(found, [], [], built_in(), HeldOutRuns(True)) == COMPARE_TEST_RUNS
    late = advise(found, [], [], built_in(), HeldOutRuns(True, {"t": 0.1}))
    assert "`commands_shift_s: 0.100` to t" in late
    end = DisturbedEnd(run="a", from_s=0.0, to_s=4.0, times=5.0)
    disturbed = replace(found, disturbed_ends=(end,))
    assert advise(disturbed, [], [], built_in()) == LEAVE_OUT_ENDS


def test_an_effect_that_does_not_say_what_reveals_it_asks_for_a_planned_flight():
    base = fit(alike()).hypothesis.base
    law = OrderedEffect(Term(Law(c1=1.0), ("c1", "x")), {"c1": 0.1, "x": 0.1}, 1.0, 0.5)
    found = TrainDiagnosis(base, UsableRuns((), (), (), (), 60.0), fit(alike()), selected=(law,))
    plan = "plan a flight with `rovsim design campaign=DIR model=FILE 'know=[law.c1,law.x]'`."
    assert advise(found, [], [], built_in()) == f"To be surer of law: {plan}"
    own = Catalogue({**built_in(), "law": Law})
    known = advise(found, [], [["law.c1", "law.x"]], own)
    assert known == f"To know law.c1, law.x one by one: {plan}"


@pytest.mark.parametrize(
    ("effect", "told"),
    [
        (ThrusterGain(all=9.8), "thruster_gain.all is 9.8:"),
        (ThrusterGain(all=0.1), "thruster_gain.all is 0.1:"),
        (ThrusterGain(all=-9.8), "thruster_gain.all is −9.8:"),
        (ThrusterGain(all=-1.0), ""),
        (ThrusterGain(all=0.5, t1=0.0), ""),  # weak, and one of them dead
        (LinearDamping(surge=1000.0), "linear_damping.surge comes to "),
        (LinearDamping(surge=50.0, sway=1000.0), ""),  # the file states none in sway
        (AddedMass(surge=500.0, heave=1.0), "added_mass.surge comes to "),
        (QuadraticDamping(surge=80.0, sway=90.0), ""),
        (ConstantWrench(surge=100.0), ""),  # of which no file says anything
    ],
)
def test_a_value_that_no_vehicle_file_is_off_by_asks_for_the_units(effect, told):
    base = nominal(load_vehicle("bluerov2_heavy"))
    term = Term(effect, tuple(effect.given()))
    found = TrainDiagnosis(
        base,
        UsableRuns((), (), (), (), 60.0),
        fit(alike()),
        selected=(OrderedEffect(term, {}, 1.0, 0.5),),
    )
    advice = advise(found, [], [], built_in())
    assert advice.startswith(told)
    assert ("check the units" in advice) == bool(told)
    if told and effect.id in base.body.stated:
        (axis,) = re.findall(r"\.(\w+) comes", advice)
        stated = base.body.stated[effect.id][AXES.index(axis)]
        times = (stated + effect[axis]) / stated
        assert f"{times:.0f} times what the vehicle file states" in advice
        assert times > 20.0


def flown(commands, kind):
    """What stands for a run that was commanded so."""
    return SimpleNamespace(motion=motion(commands, kind))


def advised(*usable):
    """What to record where nothing was selected, and what was never commanded."""
    found = TrainDiagnosis(fit(alike()).hypothesis.base, UsableRuns(*usable), fit(alike()))
    return advise(found, [], [], built_in()), found.not_commanded


def test_a_model_that_runs_away_is_not_adequate():
    usable, found = UsableRuns((), (), (), (), 60.0), fit(alike())
    assert TrainDiagnosis(found.hypothesis.base, usable, found).verdict == "adequate"
    lost = replace(usable, diverged_from={"a": 15.9})
    assert TrainDiagnosis(found.hypothesis.base, lost, found).verdict == "insufficient_data"


def test_a_thruster_that_was_never_commanded_is_named():
    idle = sticks() * (np.arange(8) != 2)
    runs = (flown(idle, "thruster"), flown(0.5 * idle, "thruster"))
    advice, named = advised(runs, (), (), (), 60.0)
    assert named == ("t3",)
    assert advice == "Command t3 in a train run, alone for some seconds each time."
    assert advised((*runs, flown(sticks(), "thruster")), (), (), (), 60.0)[1] == ()
    assert advised((), (), (), (), 60.0)[1] == ()  # nothing was logged


def test_an_axis_that_was_never_pushed_is_named_unless_nothing_moved_in_it():
    run = flown(sticks()[:, :6] * [1, 0, 1, 1, 0, 0], "demand")
    assert advised((run,), ("pitch",), (), (), 60.0)[1] == ("sway", "yaw")


def test_what_was_not_measured_is_what_to_record():
    advice, _ = advised((), (), ("surge", "sway", "yaw"), (), 60.0)
    assert "Record a position (x_m, y_m) or a velocity" in advice
    assert "what acts in surge, sway." in advice
    assert "Record a heading (yaw_rad)" in advice
    assert "Nothing is needed" not in advice
    assert "depth" not in advice


def test_what_a_law_makes_unnecessary_is_not_sure():
    """A jet in one corner was a current at a probability of one; beside the jet there is none."""
    found = fit(alike())
    drag, thrust = (AcceptedEffect(term, {}, 1.0) for term in found.hypothesis.terms[:2])
    kept, idle = doubt_beside_law([drag, thrust], [drag])
    assert (kept.probability, kept.doubt) == (1.0, None)
    assert (idle.probability, idle.doubt) == (None, "stand_in")


def test_what_a_proposed_law_does_without_is_not_selected():
    """Play of thrusters was a lag, a curve and six more; beside the play there is none of them."""
    drag, gain = (
        AcceptedEffect(Term(LinearDamping(sway=9.0), ("sway",)), {"sway": 1.0}, 0.9),
        AcceptedEffect(Term(ThrusterGain(all=0.9), ("all",)), {"all": 0.1}, 1.0),
    )
    there = AcceptedEffect(Term(LinearDamping(sway=10.0), ("sway",)), {"sway": 0.5}, None)
    (kept,) = keep_beside_law([drag, gain], [there])
    assert (kept.term, kept.std, kept.probability) == (there.term, there.std, 0.9)
    rivals = [
        Rival("lift", "linear_damping", 3.0, fit(alike())),
        Rival("lift", "thruster_gain", 1.0),
    ]
    assert list_rivals_beside(rivals, [kept]) == [Rival("lift", "linear_damping", 3.0)]
    assert list_rivals_beside(rivals, [kept])[0].fit is None


@pytest.mark.parametrize(
    ("fraction", "sure"),
    [(0.3, (1.0, None)), (0.1, (1.0, 1.0)), (1.0, (1.0, None)), (0.0, (1.0, 1.0))],
)
def test_what_removes_less_than_may_be_left_is_not_sure(fraction, sure):
    """Wakes that hit thrusters were gains of 0.98 to 1.03, each at a probability of one."""
    drag = Term(LinearDamping(sway=9.0), ("sway",))
    gain = Term(ThrusterGain(all=0.98), ("all",))
    named = [OrderedEffect(drag, {}, 1.0, 0.6), OrderedEffect(gain, {}, 1.0, 0.05)]
    told = withdraw_probability(named, find_small(named, fraction, 0.0), "unexplained")
    assert tuple(one.probability for one in told) == sure


def test_what_removes_less_than_the_law_beside_it_is_not_sure():
    """Jets that came back from a wall: a law that is not theirs, and a coupling of drag at one."""
    gain = Term(ThrusterGain(all=0.8), ("all",))
    drag = Term(LinearDamping(sway=9.0), ("sway",))
    named = [OrderedEffect(gain, {}, 1.0, 0.5), OrderedEffect(drag, {}, 1.0, 0.02)]
    assert find_small(named, 0.0, removed_by_law=0.09) == {"linear_damping"}


def test_swapped_thrusters_are_not_sure_beside_unknown_physics():
    """A moment by u w was two swapped thrusters at a probability of one, for 47 % of the error."""
    swapped = OrderedEffect(Term(ThrusterOrder(first=2.0, second=4.0), ()), {}, 1.0, 0.47)
    assert find_small([swapped], 0.5, removed_by_law=0.0) == {"thruster_order"}


def test_effects_that_cancel_one_another_are_judged_by_their_sum():
    """A tether on the floor: a constant moment and a centre of buoyancy, -0.55 and 0.83."""
    moment = Term(ConstantWrench(pitch=-0.4), ("pitch",))
    centre = Term(NetBuoyancy(force=1.0), ("force",))
    named = [OrderedEffect(moment, {}, 1.0, -0.55), OrderedEffect(centre, {}, 1.0, 0.83)]
    assert find_small(named, 0.0, removed_by_law=0.4) == {"constant_wrench", "net_buoyancy"}
    assert find_small(named, 0.0, removed_by_law=0.2) == {"constant_wrench"}


@pytest.mark.parametrize(("left", "doubted"), [(0.4, True), (0.8, False), (-0.1, True)])
def test_a_name_that_changes_by_half_beside_a_law_stood_in_for_it(left, doubted):
    """A brush was a coupled damping of 3.6 N m s/m at a probability of one; beside it -0.4."""
    own, other = (
        AcceptedEffect(Term(LinearDamping(sway=10.0 * part), ("sway",)), {}, 1.0)
        for part in (1.0, left)
    )
    for beside_law in (doubt_beside_law, keep_beside_law):
        (named,) = beside_law([own], [other])
        assert named.doubt == ("stand_in" if doubted else None)


@pytest.mark.parametrize(("delay", "doubted"), [(-0.02, True), (0.02, False)])
def test_a_filter_may_look_ahead_where_the_vehicle_seems_to_answer_too_early(delay, doubted):
    smooths = AcceptedEffect(Term(PoseFilter(cutoff=6.0), ("cutoff",)), {"cutoff": 0.1}, 1.0)
    late = AcceptedEffect(Term(InputDelay(delay=delay), ("delay",)), {"delay": 1e-3}, 1.0)
    (named,) = withdraw_probability([late], find_leading([late]), "looks_ahead")
    assert (named.probability is None) == doubted
    selected = [
        OrderedEffect(one.term, one.std, one.probability, 0.5, doubt=one.doubt)
        for one in (smooths, named)
    ]
    found = TrainDiagnosis(
        fit(alike()).hypothesis.base,
        UsableRuns((), (), (), (), 60.0),
        fit(alike()),
        selected=selected,
    )
    assert (ADVICE_ON_DOUBT["looks_ahead"] in advise(found, [], [], built_in())) == doubted


@pytest.mark.parametrize(
    ("effect", "free", "doubted"),
    [
        (NetBuoyancy(force=4.0), ("force",), True),
        (ConstantWrench(heave=4.0), ("heave",), True),
        (ConstantWrench(surge=4.0, heave=4.0), ("surge", "heave"), True),
        (ConstantWrench(surge=4.0), ("surge",), False),
        (LinearDamping(heave=4.0), ("heave",), False),
    ],
)
def test_a_constant_force_in_heave_only_shifts_the_depth_of_what_floats(effect, free, doubted):
    """A pilot who pushed a floating vehicle down was a wrench of -45 N at a probability of one."""
    named = AcceptedEffect(Term(effect, free), {}, 1.0)
    assert find_constant_heave([named]) == ({effect.id} if doubted else set())


@pytest.mark.parametrize(
    ("change", "std", "doubted"),
    [(-5.0, 1.0, False), (-20.0, 1.0, True), (-20.0, 5.0, False), (5.0, 1.0, False)],
)
def test_water_does_not_push(change, std, doubted):
    """The file states a damping in surge of 13.7 N s/m."""
    body = nominal(load_vehicle("bluerov2_heavy")).body
    drag = AcceptedEffect(Term(LinearDamping(surge=change), ("surge",)), {"surge": std}, 1.0)
    gain = AcceptedEffect(Term(ThrusterGain(all=-0.9), ("all",)), {"all": 0.1}, 1.0)
    assert find_negative([drag, gain], body) == ({"linear_damping"} if doubted else set())


def test_an_effect_keeps_its_first_doubt():
    named = AcceptedEffect(Term(LinearDamping(sway=9.0), ()), {}, 1.0)
    (once,) = withdraw_probability([named], {"linear_damping"}, "stand_in")
    (twice,) = withdraw_probability([once], {"linear_damping"}, "unexplained")
    assert twice.doubt == "stand_in"


def test_what_wanders_may_be_what_has_no_name():
    drift = DriftFit(WalkRate(0.01, std=0.001, lr_statistic=120.0), lr_margin=100.0)
    assert name_drift(drift, leaves_physics=False).probability == pytest.approx(1.0)
    assert name_drift(drift, leaves_physics=True).probability is None


def gains(**by_run):
    """A difference in the gains of thrusters."""
    effect = built_in()["thruster_gain"]
    return RunDifference(
        {run: RunValues(Term(effect(**own), tuple(own)), {}) for run, own in by_run.items()}
    )


def test_a_thruster_that_is_weak_in_one_run_is_named():
    found = gains(a={"t6": 1.02}, b={"t6": 0.61}, c={"t6": 1.01})
    named = ["", "", "", "", "", "stern"]
    assert "stern (t6) in b (0.61 of its thrust):" in advise_on_difference(
        found, NOTHING_WRONG, named
    )
    battery = gains(a={"all": 1.0}, b={"all": 0.8})
    assert "the battery" in advise_on_difference(battery, NOTHING_WRONG, named)
