"""The mistakes of others, made on purpose: the clock is wrong by what is said, each costs."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.evaluation.held_out.pitfalls import (
    ASSUMED_BIN_WIDTH_S,
    measure_pitfalls,
    on_wrong_clock,
)
from rovsim.learning.learner import learner_settings
from rovsim.results.pitfalls import PITFALLS
from rovsim.simulation.settings import SimulationSettings

QUICK = {"max_points": 300, "tuning_points": 100, "iterations": 15}
LEARNERS = {
    kind: learner_settings({"kind": kind} | more)
    for kind, more in (("knn", {"k": 5}), ("gp", QUICK))
}
HIDDEN = (
    EffectEntry(effect="quadratic_damping", parameters={"surge": 150.0, "sway": 150.0}),
    EffectEntry(effect="linear_damping", parameters={"yaw": 3.0}),
)


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """The nominal model, and four runs of a tank in which it drags too little."""
    runs = []
    for k, (name, control) in enumerate(zip("abcd", ("3dof", "6dof", "6dof", "6dof"), strict=True)):
        model, (one,) = observed(
            tmp_path_factory.mktemp(name), control, duration=20.0, seed=k, effects=HIDDEN
        )
        runs.append(replace(one.motion, run=replace(one.motion.run, id=name)))
    return model, runs


def cost(model, runs, test):
    return measure_pitfalls(model, runs, test, LEARNERS, SimulationSettings())


def test_what_is_wrong_costs(flown):
    model, (*runs, test) = flown
    found = cost(model, runs, test)
    assert set(found) == set(PITFALLS) - {"wrong clock"}  # sampled: there are no bins
    for one in found.values():
        assert one.wrong < one.right < 1.0
    assert found["lost data"].right > 0.3
    assert found["lost data"].wrong == pytest.approx(0.0, abs=1e-3)  # the prior knows nothing
    alone = cost(model, runs[1:], test)
    assert "copied runs" not in alone


def test_the_wrong_clock_moves_bins_and_commands_alike(flown):
    motion = flown[1][0]
    edges = np.cumsum(np.tile([0.1, 0.2, 0.15], 20))
    n = len(edges) - 1
    binned = replace(
        motion,
        time=edges[:-1],
        end=float(edges[-1]),
        binned=True,
        eta=motion.eta[:n],
        nu=motion.nu[:n],
        nu_dot=motion.nu_dot[:n],
        state_nu=motion.nu[:n],
        usable=np.ones(n, bool),
        commands=replace(motion.commands, time=edges[:-1] + 0.05, value=motion.commands.value[:n]),
    )
    wrong = on_wrong_clock(binned)
    assert np.allclose(np.diff(np.append(wrong.time, wrong.end)), ASSUMED_BIN_WIDTH_S)
    assert wrong.time[0] == binned.time[0]
    before = np.searchsorted(binned.time, binned.commands.time, side="right")
    assert np.array_equal(before, np.searchsorted(wrong.time, wrong.commands.time, side="right"))
    assert np.allclose(wrong.nu_dot[1:] * ASSUMED_BIN_WIDTH_S, np.diff(binned.nu, axis=0))
