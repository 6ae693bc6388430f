"""Ends of runs in which hands move the vehicle are told where they hold most of what is left."""

from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.diagnosis.checks.disturbed_ends import find_disturbed_ends

PERIOD, SECONDS = 0.05, 40.0


def run(name, before=0.0, after=0.0):
    """A run of innovations that are read on all axes, 100 s after the clock began."""
    time = np.arange(0.0, SECONDS, PERIOD)
    settled = time > 1.0
    motion = SimpleNamespace(
        run=SimpleNamespace(id=name),
        commands=SimpleNamespace(before=before, after=after),
        time=100.0 + time,
        end=100.0 + SECONDS,
    )
    return SimpleNamespace(
        time=time,
        settled=settled,
        innovation_mask=np.ones((len(time), 6), bool),
        edges=100.0 + np.array([0.0]),
        motion=motion,
    )


def found(runs, *disturbed, seed=0):
    """What is found where the variance is nine times as large in spans (run, begin, end), s."""
    random, white = np.random.default_rng(seed), []
    for k, one in enumerate(runs):
        time = one.time[one.settled]
        e = random.normal(size=(6, len(time)))
        for place, begin, end in disturbed:
            e *= np.where((place == k) & (time >= begin) & (time < end), 3.0, 1.0)
        white.append(e)
    bank = SimpleNamespace(runs=runs, whiten=lambda e, noise: e)
    fit = SimpleNamespace(linearised=SimpleNamespace(e=np.hstack(white)), noise=None)
    return find_disturbed_ends(fit, bank)


RUNS = [run("a"), run("b"), run("c")]


def test_ends_are_told_with_what_is_left_of_their_runs():
    first, last = found(RUNS, (0, 0.0, 6.0), (2, 33.0, 40.0))
    assert (first.run, first.from_s) == ("a", 100.0)
    assert first.to_s == pytest.approx(106.0, abs=1.0)
    assert first.times == pytest.approx(9.0, rel=0.2)
    assert (last.run, last.to_s) == ("c", 140.0)
    assert last.from_s == pytest.approx(133.0, abs=1.0)


@pytest.mark.parametrize(
    "disturbed",
    [
        (),
        ((1, 15.0, 22.0),),  # in the middle: no end
        ((0, 0.0, 6.0), (1, 10.0, 30.0)),  # most of it is elsewhere
        tuple((k, 0.0, 40.0) for k in range(3)),  # everywhere
    ],
)
def test_nothing_is_said_of_what_is_not_at_the_ends(disturbed):
    assert found(RUNS, *disturbed) == ()


def test_a_border_between_parts_of_a_run_is_no_end():
    parts = [run("a", after=40.0), run("a", before=40.0)]
    assert found(parts, (0, 34.0, 40.0)) == ()
    (last,) = found(parts, (1, 34.0, 40.0))
    assert last.to_s == 140.0


def test_blocks_without_readings_do_not_count():
    seldom = run("seldom")
    seldom.innovation_mask[(seldom.time % 3.0) > 1.0] = False
    assert found([seldom]) == ()
    (first,) = found([seldom, *RUNS], (0, 0.0, 8.0))
    assert first.run == "seldom"
    seldom.innovation_mask[:] = False
    assert found([seldom]) == ()
