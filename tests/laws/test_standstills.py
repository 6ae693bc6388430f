"""A vehicle that is held still is told from a model that is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from rovsim.diagnosis.checks.standstills import find_standstills
from rovsim.reporting.words.shown import held_sentences
from rovsim.simulation.samples import Samples
from worlds import motion, sticks

ROLL, STIFF, HELD, STEP = 3, 4.0, 3.0, 0.01


def decay(angle=0.3, held=HELD, offset=0.0, seconds=20.0):
    """A roll decay, held at first; `offset` of the acceleration that the model gets wrong."""
    plain = motion(sticks(), seconds=seconds)
    t = np.maximum(plain.time - held, 0.0)
    swing = angle * np.exp(-0.05 * t) * np.cos(np.sqrt(STIFF) * t)
    rate = np.gradient(swing, STEP)
    real, model = np.gradient(rate, STEP), -STIFF * swing - 0.1 * rate + offset
    nu, a_sim, a_res = (np.zeros((len(t), 6)) for _ in range(3))
    nu[:, ROLL], a_sim[:, ROLL], a_res[:, ROLL] = rate, model, real - model
    run = replace(plain, nu=nu, state_nu=nu)
    every = np.arange(len(t))
    return run, Samples(every, nu, run.eta[:, 3:], nu, a_sim, a_res)


def test_a_held_start_is_found_with_its_seconds():
    (found,) = find_standstills([decay()])
    assert (found.run, found.axis) == ("r", "roll")
    assert found.from_s == 0.0
    assert found.to_s == pytest.approx(HELD, abs=0.1)
    assert found.gained == pytest.approx(STIFF * 0.3 * HELD, rel=0.05)
    ((begin, end),) = found.use
    assert (begin, end) == (pytest.approx(found.to_s, abs=0.02), 20.0)
    (said,) = held_sentences([found])
    assert f"`use: [[{begin}, 20.0]]`" in said


def test_a_floor_in_the_middle_leaves_both_sides():
    run, samples = decay()
    later = np.roll(np.arange(len(run.time)), 1000)  # held from 10 to 13 s
    moved = Samples(*(x[later] for x in vars(samples).values()))
    moved = replace(moved, index=samples.index)
    (found,) = find_standstills([(run, moved)])
    assert [a for a, _ in found.use] == [0.0, pytest.approx(13.0, abs=0.1)]
    assert found.use[0][1] == pytest.approx(10.0, abs=0.1)


@pytest.mark.parametrize(
    "free",
    [
        {"held": 0.0},  # rests at its end
        {"angle": 0.0},  # held where it would stay anyway
        {"held": 0.5},  # no longer than a vehicle that turns back
        {"offset": 1.2},  # wrong as much while it moves: not held, but a wrong model
    ],
)
def test_what_may_be_free_is_not_called_held(free):
    assert find_standstills([decay(**free)]) == ()


def test_nothing_is_said_where_no_such_force_ever_moved_the_vehicle():
    run, samples = decay()
    silent = np.where(samples.nu[:, [ROLL]] == 0.0, 1.0, 0.1)
    weak = replace(samples, a_sim=samples.a_sim * silent)
    assert find_standstills([(run, weak)]) == ()
    assert find_standstills([]) == ()
