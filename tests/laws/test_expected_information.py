"""What a flight is expected to tell."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.design.adequacy import require_information
from rovsim.design.expected_information import (
    MIN_INFORMATION_GAIN,
    ExpectedInformation,
    measure_information,
    surprise,
)
from rovsim.design.from_train_runs import check_fitted, widen
from rovsim.design.prior_information import FittedHypothesis, PriorInformation
from rovsim.dynamics.effects.damping import LinearDamping
from rovsim.dynamics.effects.onboard_control import OnboardControl
from rovsim.dynamics.effects.proximity import WallProximity
from rovsim.dynamics.effects.thruster_order import ThrusterOrder
from rovsim.estimation.observer.hypothesis import Hypothesis, Term

N = 4096


def one_sum(left, lasting):
    """Noise that can only grow, not change its spectrum."""
    n = lasting * left.shape[1]
    return float(np.sum(n * np.log1p(np.sum(left**2, axis=1) / n)))


@given(st.floats(0.1, 10.0), st.floats(1.0, 5.0), st.integers(0, 100))
def test_white_innovations_are_taken_for_more_of_the_same_noise(size, lasting, seed):
    left = size * np.random.default_rng(seed).normal(size=(6, N))
    assert surprise(left, lasting) == pytest.approx(one_sum(left, lasting), rel=0.05)


@given(st.floats(1e-4, 0.4), st.floats(0.1, 10.0), st.floats(1.0, 5.0))
def test_noise_that_may_change_its_spectrum_takes_up_more(frequency, size, lasting):
    left = size * np.sin(2.0 * np.pi * frequency * np.arange(N))[None] * np.ones((6, 1))
    assert 0.0 < surprise(left, lasting) < one_sum(left, lasting)


def test_what_is_small_counts_by_its_square():
    left = 1e-3 * np.random.default_rng(0).normal(size=(6, N))
    assert surprise(left, 1.0) == pytest.approx(np.sum(left**2), rel=1e-3)


def test_a_rival_that_is_ruled_out_does_not_count():
    gain = np.array([30.0, 2.0])
    for likely, told in (([True, True], 2.0), ([True, False], 30.0)):
        assert ExpectedInformation((), (), gain, np.array(likely)).utility == told


@pytest.mark.parametrize("n", [401, 402, 1024, 3])
def test_octaves_hold_all_the_power_once(n):
    left = 1e-4 * np.random.default_rng(n).normal(size=(6, n))
    assert surprise(left, 1.0) == pytest.approx(np.sum(left**2), rel=1e-6)


def test_a_rival_with_odds_of_a_thousand_against_it_is_ruled_out():
    def known(*likelihoods):
        own = np.eye(1), np.array([0])
        rivals = [FittedHypothesis(None, *own, one, None, np.eye(1)) for one in likelihoods]
        return PriorInformation((), (), tuple(rivals), None, ())

    assert list(known(0.0, -13.7).likely) == [True, True]
    assert list(known(-13.9, 0.0).likely) == [False, True]
    assert list(known(3.0).likely) == [True]


def test_a_rival_frees_what_its_effect_can_change_from_where_it_is():
    loop = Term(OnboardControl(gain_heave=2.0, bandwidth_heave=1.0), ("gain_heave",))
    drag = Term(LinearDamping(sway=1.0), ("sway",))
    loops, other = widen(Hypothesis(None, (loop, drag)), "onboard_control").terms
    assert set(loops.free) == {"gain_heave", "bandwidth_heave"}
    assert other is drag
    assert set(widen(Hypothesis(None, (drag,)), "linear_damping").terms[0].free) == set(AXES)


def test_a_flight_takes_no_information_away():
    train, flight = np.random.default_rng(0).normal(size=(2, 3, 6, 50))  # of three parameters
    bank = SimpleNamespace(flatten=lambda rows, noise: np.concatenate(rows, axis=-1).reshape(3, -1))
    own = SimpleNamespace(J=[0.1 * train, flight], hypothesis=SimpleNamespace(x=np.zeros(3)))
    known = SimpleNamespace(noise=None)
    rival = FittedHypothesis(None, np.eye(3) * 1e6, np.arange(3), 0.0, None, np.eye(3))
    told = measure_information(bank, own, rival, known)
    assert told == pytest.approx(flight.reshape(3, -1) @ flight.reshape(3, -1).T)
    assert (rival.std(told) <= rival.std()).all()


def of_ratio(ratio):
    """Of one value, whose deviation becomes so many times smaller."""
    return ExpectedInformation((np.array([ratio]),), (np.ones(1),), np.empty(0), np.array([True]))


def test_a_flight_that_tells_nothing_is_refused():
    drag = Hypothesis(None, (Term(LinearDamping(sway=1.0), ("sway",)),))
    rival = FittedHypothesis(drag, np.eye(1), np.array([0]), 0.0, None, np.eye(1))
    known = PriorInformation((), (), (rival,), None, ())
    for ratio in (1.0, np.sqrt(1.0 + MIN_INFORMATION_GAIN)):
        expected = of_ratio(ratio)
        with pytest.raises(BadInput, match=r"tells anything about linear_damping\.sway"):
            require_information(expected, known)
    require_information(of_ratio(1.1), known)


def test_what_is_only_tried_is_refused_by_name():
    with pytest.raises(BadInput, match="first is tried, not fitted"):
        check_fitted("thruster_order.first", ThrusterOrder)
    with pytest.raises(BadInput, match=r"attitude is tried, not fitted.*gain_surge"):
        check_fitted("onboard_control.attitude", OnboardControl)
    with pytest.raises(BadInput, match=r"unknown parameter 'swai'.*'sway'"):
        check_fitted("linear_damping.swai", LinearDamping)
    check_fitted("wall_proximity.length_scale", WallProximity)  # free only when asked for
