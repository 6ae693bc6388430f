"""Laws of sharing work: every job is done once, whoever shares it and with how many."""

import os
import time
from concurrent.futures import ThreadPoolExecutor
from threading import Event, Lock
from unittest.mock import patch

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.core.threads import Abandoned, map_on_cores, on_cores


def on(cores):
    """As if the machine had so many cores."""
    return patch.object(numba.config, "NUMBA_NUM_THREADS", cores)


def times_done(lengths):
    """How often each job was worked off."""
    done = np.zeros(len(lengths), int)

    def work(part):
        done[part] += 1

    on_cores(work, np.asarray(lengths))
    return done.tolist()


@given(st.lists(st.integers(0, 1000), max_size=40), st.integers(1, 5))
def test_every_job_is_done_once(lengths, cores):
    with on(cores):
        assert times_done(lengths) == [1] * len(lengths)


def test_several_may_share_at_once():
    with on(2), ThreadPoolExecutor(4) as threads:
        found = list(threads.map(lambda _: times_done([3] * 50), range(20)))
    assert found == [[1] * 50] * 20


def test_a_forked_process_has_threads_of_its_own():
    with on(2):
        assert times_done([1] * 9) == [1] * 9
        child = os.fork()
        if child == 0:
            os._exit(0 if times_done([1] * 9) == [1] * 9 else 1)
        assert os.waitpid(child, 0)[1] == 0


def test_what_goes_wrong_in_a_part_is_told():
    def work(part):
        raise ZeroDivisionError

    with on(2), pytest.raises(ZeroDivisionError):
        on_cores(work, np.ones(9))


@given(st.lists(st.integers(), max_size=20), st.integers(1, 5))
def test_calls_side_by_side_give_what_calls_one_by_one_give(numbers, cores):
    with on(cores):
        assert map_on_cores(pow, numbers, [2] * len(numbers)) == [k**2 for k in numbers]


def test_calls_share_kernels_and_may_map_in_turn():
    def call(k):
        return times_done([1] * k), map_on_cores(times_done, [[1], [1, 1]])

    with on(2):
        found = map_on_cores(call, range(9))
    assert found == [([1] * k, [[1], [1, 1]]) for k in range(9)]


def test_a_call_sees_how_numpy_treats_errors():
    with on(2), np.errstate(divide="ignore", over="raise"):
        found = map_on_cores(lambda _: np.geterr(), range(3))
    assert [(one["divide"], one["over"]) for one in found] == [("ignore", "raise")] * 3


def test_what_goes_wrong_in_a_call_is_told():
    with on(2), pytest.raises(ZeroDivisionError):
        map_on_cores(lambda k: 1 // k, range(3))


def test_the_first_call_that_fails_is_told_whichever_fails_first():
    later = Event()

    def call(k):
        if k == 0:
            assert later.wait(10.0)
        elif k == 3:
            later.set()
        raise ValueError(k)

    with on(4), pytest.raises(ValueError, match=r"^0$"):
        map_on_cores(call, range(4))


@given(st.integers(0, 3), st.integers(2, 4))
def test_shares_within_shares_never_wait_for_each_other(depth, cores):
    def count(level):
        return 1 if level == 0 else sum(map_on_cores(count, [level - 1] * 5))

    with on(cores):
        assert map_on_cores(count, [depth] * 5) == [5**depth] * 5


def test_no_more_threads_work_than_there_are_cores():
    working, most, lock = [], [], Lock()

    def work(k):
        with lock:
            working.append(k)
            most.append(len(working))
        time.sleep(1e-3)
        with lock:
            working.remove(k)

    with on(2):
        map_on_cores(lambda k: map_on_cores(work, [(k, i) for i in range(5)]), range(5))
    assert max(most) <= 2


def test_what_nobody_waits_for_any_more_ends():
    begun, ended = Event(), Event()

    def call(k):
        if k == 0:
            assert begun.wait(10.0)
            raise KeyboardInterrupt
        try:
            while True:
                begun.set()
                times_done([1] * 9)
        except Abandoned:
            ended.set()

    with on(2), pytest.raises(KeyboardInterrupt):
        map_on_cores(call, range(2))
    assert ended.wait(10.0)
