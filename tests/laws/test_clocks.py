"""Logs of commands that have another clock, found without a model of the vehicle."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests import worlds

from rovsim.core.run import RunInfo
from rovsim.diagnosis.checks.clocks import find_clock_difference, find_lag, find_shifts
from rovsim.simulation.measured_states import drive_as_measured
from rovsim.simulation.settings import SimulationSettings

SECONDS, BASE, SETTINGS = 40.0, worlds.model(), SimulationSettings()


def late(lag, seed=0, gain=0.7, drag=1.5, seconds=SECONDS, name="r"):
    """A run in which another vehicle than the model's follows its commands by a lag, in s."""
    still = worlds.motion(worlds.sticks(seed, rows=int(seconds)), seconds=seconds)
    wrench = drive_as_measured(BASE, still, SETTINGS.replay).wrench
    pushed = [np.interp(still.time - lag, still.time, x) for x in (wrench @ BASE.body.M_inv.T).T]
    filtered = SETTINGS.signals.suited(still).filter.smoothed(gain * np.array(pushed).T, 0.01)
    nu, nu_dot = np.zeros((len(still.time), 6)), np.zeros((len(still.time), 6))
    for k in range(len(nu) - 1):
        nu_dot[k] = filtered[k] - drag * nu[k]
        nu[k + 1] = nu[k] + 0.01 * nu_dot[k]
    nu_dot += 0.02 * np.random.default_rng(seed).normal(size=nu_dot.shape)
    return replace(still, run=RunInfo(name, "6dof", "train"), nu=nu, nu_dot=nu_dot)


def difference(*motions):
    """What runs differ in."""
    return find_clock_difference(BASE, [SimpleNamespace(motion=m) for m in motions], SETTINGS)


@settings(max_examples=10, deadline=None)
@given(st.floats(-0.4, 0.4), st.integers(0, 99), st.floats(0.4, 2.0), st.floats(0.2, 3.0))
def test_a_lag_is_found_whatever_the_vehicle(lag, seed, gain, drag):
    found = find_lag(BASE, [late(lag, seed, gain, drag)], SETTINGS)
    assert found.value == pytest.approx(lag, abs=0.01)
    assert found.std < 0.01


def test_runs_of_another_clock_are_found():
    found = difference(late(0.02, 1, name="a"), late(0.1, 2, name="b"), late(0.02, 3, name="c"))
    assert found.effect_id == "input_delay"
    delays = {run: one.term.effect["delay"] for run, one in found.by_run.items()}
    assert delays == pytest.approx({"a": 0.02, "b": 0.1, "c": 0.02}, abs=0.01)


@pytest.mark.parametrize("lag", [0.0, 0.2])
def test_clocks_agree_whatever_the_lag_of_all(lag):
    assert difference(late(lag, 1, name="a"), late(lag, 2, gain=0.5, name="b")) is None


def test_a_run_that_is_too_short_or_never_commanded_tells_nothing():
    assert find_lag(BASE, [late(0.1, seconds=12.0)], SETTINGS) is None
    idle = worlds.motion(np.zeros((40, 8)), seconds=SECONDS)
    assert find_lag(BASE, [idle], SETTINGS) is None
    assert difference(late(0.1, name="a"), idle) is None


def test_parts_of_a_run_are_one_run():
    motion = late(0.1)
    half = np.arange(len(motion.time)) < len(motion.time) // 2
    parts = [replace(motion, usable=motion.usable & x) for x in (half, ~half)]
    assert find_lag(BASE, parts, SETTINGS).value == pytest.approx(0.1, abs=0.01)
    assert difference(*parts) is None


def test_axes_that_nothing_moves_do_not_count():
    motion = late(0.1)
    rounding = 1e-17 * np.random.default_rng(1).normal(size=(len(motion.time), 3))
    flat = replace(
        motion,
        nu=np.hstack([motion.nu[:, :3], rounding]),
        nu_dot=np.hstack([motion.nu_dot[:, :3], rounding]),
    )
    assert find_lag(BASE, [flat], SETTINGS).value == pytest.approx(0.1, abs=0.01)
    assert find_lag(BASE, [replace(flat, nu_dot=0.0 * flat.nu_dot)], SETTINGS) is None


def test_logs_of_test_runs_are_compared_with_those_of_train_runs():
    like = [late(0.1, 1, name="a"), late(0.1, 2, name="b")]
    tests = [
        late(0.11, 3, name="same"),
        late(0.25, 4, gain=0.5, name="later"),
        late(0.0, 5, name="z"),
    ]
    found = find_shifts(BASE, like, tests, SETTINGS)
    assert found == pytest.approx({"later": 0.15, "z": -0.1}, abs=0.01)
    idle = replace(like[0], commands=replace(like[0].commands, value=0 * like[0].commands.value))
    assert find_shifts(BASE, [idle], tests, SETTINGS) == {}
