"""What a vehicle did while lines of the command log were lost is not held against a model."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from flown import observed
from rovsim.core.run import Commands
from rovsim.diagnosis.checks.unlogged_effects import drop_unlogged
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.structure.lost_commands import find_jumps, find_lost_commands
from rovsim.diagnosis.structure.residual import split_by_axis
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.simulation.drive import Drives
from rovsim.simulation.synthetic_tank.settings import Camera, Log, Turbulence

STILL = {"bursts_per_minute": 0.0, "outliers_per_minute": 0.0}


def test_lines_that_were_lost_while_commands_changed_are_known_to_be(tmp_path):
    base, (run,) = observed(tmp_path, duration=8.0, camera=Camera(**STILL))
    time = 0.02 * np.arange(400)
    still, ramp = np.zeros(200), np.full(200, 0.01)
    value = np.cumsum(np.concatenate([still, ramp]))[:, None]

    def find(kept, late=0.0):
        commands = Commands(time[kept] + late, value[kept], "thruster")
        motion = replace(run.motion, commands=commands)
        return find_lost_commands(
            replace(run, motion=motion, edges=run.edges + late), base.thrust_path
        )

    kept = np.isin(np.arange(400), (100, 300, 390), invert=True)
    found = find(kept)
    np.testing.assert_allclose(run.edges[0] + found, [[5.98, 6.02], [7.78, 7.82]])
    np.testing.assert_allclose(find(kept, 3.0), found)  # of a clock that was not set
    assert not len(find(np.ones(400, bool)))
    uneven = np.random.default_rng(0).uniform(size=400) < 0.5
    assert len(find(uneven)) <= 0.05 * uneven.sum()


def test_what_a_lost_line_may_do_is_the_change_of_thrust_over_the_inertia(tmp_path):
    base, (run,) = observed(tmp_path, duration=8.0, camera=Camera(**STILL))
    lost = np.array([[2.0, 2.04], [5.0, 5.04]])
    light = find_jumps(run, base, lost)
    heavy = find_jumps(run, base + AddedMass(heave=base.M[2, 2]), lost)  # twice as heavy
    assert light.shape == (2, 6)
    assert np.all(light[:, 2] > 0.01)
    np.testing.assert_allclose(heavy[:, 2], 0.5 * light[:, 2], rtol=0.02)


@pytest.mark.parametrize("at", [6.004, 6.026, 6.043])
def test_what_thrusters_did_under_a_lost_line_is_not_held_against_a_model(tmp_path, at):
    """Wherever between two readings it was lost, and commands were turned round."""
    base, (run,) = observed(tmp_path, duration=12.0, camera=Camera(**STILL))
    log = run.motion.commands
    turned = np.where(log.time[:, None] - run.edges[0] < at, log.value, -log.value)
    kept = np.arange(len(log.time)) != np.argmax(log.time - run.edges[0] >= at)
    logs = replace(log, value=turned), replace(log, time=log.time[kept], value=turned[kept])
    fine = np.linspace(run.edges[0], run.edges[-1], int(run.substeps.sum()) + 1)
    drives = [Drives(one, fine, "held", run.substeps) for one in logs]
    motions = [replace(run.motion, commands=one) for one in logs]
    each = zip(motions, drives, strict=True)
    told, lossy = (replace(run, motion=own, drives=driven) for own, driven in each)
    bank = FilterBank.design([told], base, FIRST_NOISE)
    other = replace(bank, runs=(lossy,))
    e = [other.innovations(base)[0] - bank.innovations(base)[0]]
    seen = SimpleNamespace(e=e, J=[np.empty((0, *e[0].shape))])
    found = SimpleNamespace(linearised=seen, noise=FIRST_NOISE, hypothesis=Hypothesis(base))
    left = np.stack([one.white[0] for one in split_by_axis(found, other)])
    assert np.linalg.norm(left) < 0.2 * np.linalg.norm(other.whiten(e, FIRST_NOISE))


@pytest.mark.parametrize("delay", [0.0, 0.02])
def test_a_delay_that_only_lost_lines_make_is_not_named(tmp_path, delay):
    """One line in 25 lost at 10 Hz is late by 4 ms; the runs are as quiet as simulated ones."""
    hidden = [{"effect": "input_delay", "parameters": {"delay": delay}}]
    calm, slow = Turbulence(force=0.05, moment=0.002), Log(rate=10.0, missing=0.04)
    base, runs = observed(tmp_path, duration=60.0, effects=hidden, turbulence=calm, log=slow)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    noise, _ = bank.fit_noise(bank.innovations(base), FIRST_NOISE)
    workspace = SimpleNamespace(bank=bank, penalty=12.0, fit=lambda h: fit(h, bank, noise))
    found = workspace.fit(Hypothesis(base, (Term(InputDelay(), ("delay",)),)))
    assert found.distance([0]) > workspace.penalty
    kept = drop_unlogged(SearchResult(workspace, found, ())).best.hypothesis.terms
    assert bool(kept) == bool(delay)
