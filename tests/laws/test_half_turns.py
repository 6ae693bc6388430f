"""A body that is found again half a turn off is told from one that turned by itself."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovsim.core import rotations
from rovsim.measurement.signals.half_turns import find_half_turned
from rovsim.measurement.signals.outliers import VelocityGate

RATE, NOISE, SLOT = 100.0, 2e-3, 600  # Hz, rad, frames of 6 s with at most one fault
COUNT = 7 * SLOT
TIME = np.arange(COUNT) / RATE
HALF_TURNS = np.eye(4)  # as it is, and half a turn about body x, y, z


def swaying(seed, rate=0.8):
    """Attitudes (n, 4) of a body that sways about all axes, at up to about `rate` in rad/s."""
    rng = np.random.default_rng(seed)
    w, phase = rng.uniform(0.8, 3.0, 3), rng.uniform(0, 6, 3)
    angle = rate * np.array([0.2, 0.2, 0.9]) / w * np.sin(w * TIME[:, None] + phase)
    return noisy(rotations.from_euler(*angle.T), rng)


def noisy(attitude, rng):
    return rotations.multiply(attitude, rotations.exp(NOISE * rng.normal(size=(len(attitude), 3))))


def spinning(rate):
    """Attitudes (n, 4) of a body that turns round and round."""
    return noisy(rotations.from_euler(0 * TIME, 0 * TIME, rate * TIME), np.random.default_rng(1))


def turn(attitude, frames, axis):
    attitude[frames] = rotations.multiply(attitude[frames], HALF_TURNS[axis])


def half_turned(attitude, found):
    """Mask (n,) of what is found to be half a turn off among the found frames."""
    mask = np.zeros(COUNT, bool)
    gate = VelocityGate()
    mask[found] = find_half_turned(
        TIME[found], attitude[found], 1 / RATE, gate.max_rate, gate.angle_tolerance
    )
    return mask


def rejected(attitude, found):
    """Mask (n,) of what the gate rejects among the found frames of a body that stays in place."""
    mask = np.zeros(COUNT, bool)
    place = np.zeros((found.sum(), 3))
    mask[found] = VelocityGate().rejected(TIME[found], place, attitude[found], 1 / RATE)
    return mask


FAULTS = st.lists(
    st.tuples(
        st.integers(1, 3),  # axis
        st.integers(0, 100),  # frames lost before
        st.integers(1, 250),  # frames half a turn off
        st.integers(0, 100),  # frames lost after
    ),
    min_size=1,
    max_size=6,
)


def planted(seed, faults):
    """A swaying body, the frames in which it was found, and those in which it is turned."""
    attitude = swaying(seed)
    found, turned = np.ones(COUNT, bool), np.zeros(COUNT, bool)
    for slot, (axis, before, length, after) in enumerate(faults):
        first = slot * SLOT + 150 + before
        found[first - before : first] = False
        found[first + length : first + length + after] = False
        turned[first : first + length] = True
        turn(attitude, slice(first, first + length), axis)
    return attitude, found, turned


@settings(deadline=None, max_examples=40)
@given(seed=st.integers(0, 2**32 - 1), faults=FAULTS)
def test_frames_that_are_half_a_turn_off_are_found_and_no_others(seed, faults):
    attitude, found, turned = planted(seed, faults)
    np.testing.assert_array_equal(half_turned(attitude, found), turned)
    np.testing.assert_array_equal(rejected(attitude, found), turned)


@settings(deadline=None, max_examples=20)
@given(seed=st.integers(0, 2**32 - 1), faults=FAULTS, swaps=st.integers(0, 40))
def test_what_is_found_is_found_only_once(seed, faults, swaps):
    """Run again without what it rejected, the gate rejects nothing, swaps or not."""
    attitude, found, _ = planted(seed, faults)
    rng = np.random.default_rng(seed)
    swapped = rng.choice(COUNT, swaps, replace=False)
    attitude[swapped] = rotations.exp(rng.normal(size=(swaps, 3)))
    found &= ~rejected(attitude, found)
    assert not rejected(attitude, found).any()
    assert not half_turned(attitude, found).any()


@settings(deadline=None, max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    rate=st.floats(0, 3.0),
    lost=st.lists(st.integers(1, 400), max_size=6),
    dropped=st.floats(0, 0.3),
)
def test_a_body_that_sways_by_itself_is_kept(seed, rate, lost, dropped):
    found = np.random.default_rng(seed).random(COUNT) >= dropped
    for slot, length in enumerate(lost):
        found[slot * SLOT + 150 : slot * SLOT + 150 + length] = False
    assert not half_turned(swaying(seed, rate), found).any()


@settings(deadline=None, max_examples=40)
@given(rate=st.floats(0.1, 4.0), start=st.integers(100, 2000), more=st.floats(0.9, 1.1))
def test_a_body_that_turns_half_round_while_it_is_lost_is_kept(rate, start, more):
    found = np.ones(COUNT, bool)
    found[start : start + round(more * np.pi / rate * RATE)] = False
    assert not half_turned(spinning(rate), found).any()


@settings(deadline=None, max_examples=20)
@given(takes=st.floats(1.3, 5.0), seed=st.integers(0, 2**32 - 1))
def test_a_body_that_only_turns_at_the_ends_of_a_tank_which_no_camera_sees_is_kept(takes, seed):
    leg = 12.0
    into = np.clip((TIME % leg - (leg - takes)) / takes, 0.0, 1.0)
    yaw = np.pi * (TIME // leg + into)
    attitude = noisy(rotations.from_euler(0 * TIME, 0 * TIME, yaw), np.random.default_rng(seed))
    assert not half_turned(attitude, into == 0.0).any()


def test_a_body_that_turns_already_when_it_is_lost_is_kept():
    """Nothing else in the run turns as far; of the turn, 0.2 s before and after are seen."""
    yaw = 2.5 * np.clip(TIME - 20.0, 0.0, np.pi / 2.5 + 0.4)
    attitude = noisy(rotations.from_euler(0 * TIME, 0 * TIME, yaw), np.random.default_rng(2))
    found = (yaw < 0.5) | (yaw > np.pi + 0.5)
    assert not half_turned(attitude, found).any()


def test_a_body_that_sways_fast_does_not_turn_far():
    """At 2.4 rad/s it would turn half round within the loss; but it sways, by 0.4 rad."""
    roll = 0.4 * np.sin(2 * np.pi * TIME)
    attitude = noisy(rotations.from_euler(roll, 0 * TIME, 0.1 * TIME), np.random.default_rng(3))
    found = np.ones(COUNT, bool)
    turn(attitude, slice(1975, 2275), 3)
    found[1875:1975] = found[2275:2375] = False
    np.testing.assert_array_equal(np.flatnonzero(half_turned(attitude, found)), range(1975, 2275))


@pytest.mark.parametrize("axis", [1, 2, 3])
@pytest.mark.parametrize("lost", [0, 40, 100])
def test_a_body_that_stays_turned_to_the_end_of_the_run_is_found(axis, lost):
    attitude, found = swaying(5), np.ones(COUNT, bool)
    found[2500 - lost : 2500] = False
    turn(attitude, slice(2500, None), axis)
    np.testing.assert_array_equal(np.flatnonzero(half_turned(attitude, found)), range(2500, COUNT))


def test_half_a_turn_about_one_axis_after_another_is_one_about_the_third():
    attitude, found = swaying(6), np.ones(COUNT, bool)
    for first, axis in ((1000, 1), (1300, 2), (1600, 3)):
        found[first - 60 : first] = False
        turn(attitude, slice(first, first + 240), axis)
    found[1840:1900] = False
    expected = found & (np.arange(COUNT) >= 1000) & (np.arange(COUNT) < 1840)
    np.testing.assert_array_equal(half_turned(attitude, found), expected)


def test_between_two_long_losses_nobody_knows():
    attitude, found = swaying(7, rate=0.2), np.ones(COUNT, bool)
    turn(attitude, slice(2000, 2200), 3)
    found[1300:2000] = found[2200:2900] = False
    assert not half_turned(attitude, found).any()


def test_after_a_long_loss_frames_are_judged_by_themselves():
    attitude, found = swaying(9, rate=0.2), np.arange(COUNT) < 3500
    turn(attitude, slice(2200, 2600), 3)
    found[1500:2200] = found[2600:2660] = False
    np.testing.assert_array_equal(np.flatnonzero(half_turned(attitude, found)), range(2200, 2600))


def test_a_swap_at_the_edge_of_a_loss_is_nothing_to_compare_with():
    attitude, found = swaying(8), np.ones(COUNT, bool)
    turn(attitude, slice(1500, 1700), 3)
    found[1450:1500] = found[1700:1750] = False
    for edge in (1449, 1500, 1699, 1750):
        attitude[edge] = rotations.multiply(attitude[edge], rotations.exp([0.9, 0.9, 0.9]))
    expected = set(range(1501, 1699))
    assert set(np.flatnonzero(half_turned(attitude, found))) == expected
    assert set(np.flatnonzero(rejected(attitude, found))) == expected | {1449, 1500, 1699, 1750}


@pytest.mark.parametrize("count", [1, 2])
def test_of_hardly_a_frame_nothing_is_said(count):
    found = np.arange(COUNT) < count
    assert not half_turned(spinning(1.0), found).any()
