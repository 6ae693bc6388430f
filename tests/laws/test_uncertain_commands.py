"""What a vehicle did while lines of the command log were lost is not held against a model."""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

from flown import observed
from rovsim.core.axes import AXES
from rovsim.core.run import Commands
from rovsim.diagnosis.checks.unlogged_effects import drop_unlogged
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.structure.residual import split_by_axis
from rovsim.diagnosis.structure.uncertain_commands import (
    UncertainCommands,
    find_gaps,
    find_jittering,
    find_jumps,
)
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.lost_lines import MAX_LOST_IN_A_ROW, fill_lost_lines
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
        found = UncertainCommands.of(replace(run, motion=motion, edges=run.edges + late), base)
        assert found.lost.all()
        return found.times

    kept = np.isin(np.arange(400), (100, 300, 390), invert=True)
    found = find(kept)
    np.testing.assert_allclose(run.edges[0] + found, [[6.0, 6.02], [7.8, 7.82]])  # since it was due
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


def with_log(run, log):
    """The run with another log, of which no lost line is put back."""
    fine = np.linspace(run.edges[0], run.edges[-1], int(run.substeps.sum()) + 1)
    motion = replace(run.motion, commands=log)
    return replace(run, motion=motion, drives=Drives(log, fine, "held", run.substeps))


def make_wrong(base, run, right, wrong):
    """Innovations (6, n) that a wrong log of a run makes, all of them and once they are cleared."""
    runs = [with_log(run, log) for log in (right, wrong)]
    bank = FilterBank.design(runs[:1], base, FIRST_NOISE)
    other = replace(bank, runs=(runs[1],))
    e = [other.innovations(base)[0] - bank.innovations(base)[0]]
    seen = SimpleNamespace(e=e, J=[np.empty((0, *e[0].shape))])
    found = SimpleNamespace(linearised=seen, noise=FIRST_NOISE, hypothesis=Hypothesis(base))
    left = np.stack([one.white[0] for one in split_by_axis(found, other)])
    return other.whiten(e, FIRST_NOISE), left


@pytest.mark.parametrize("at", [6.004, 6.026, 6.043])
def test_what_thrusters_did_under_a_lost_line_is_not_held_against_a_model(tmp_path, at):
    """Wherever between two readings it was lost, and commands were turned round."""
    base, (run,) = observed(tmp_path, duration=12.0, camera=Camera(**STILL))
    log = run.motion.commands
    turned = np.where(log.time[:, None] - run.edges[0] < at, log.value, -log.value)
    kept = np.arange(len(log.time)) != np.argmax(log.time - run.edges[0] >= at)
    right, lossy = replace(log, value=turned), replace(log, time=log.time[kept], value=turned[kept])
    wrong, left = make_wrong(base, run, right, lossy)
    assert np.linalg.norm(left) < 0.2 * np.linalg.norm(wrong)


def test_a_lost_line_may_have_been_like_any_line_nearby(tmp_path):
    """Of a controller that chatters, between two lines that are the same."""
    base, (run,) = observed(tmp_path, duration=12.0, camera=Camera(**STILL))
    log = run.motion.commands
    odd = np.arange(len(log.time)) % 2 == 1
    chatter = 0.3 * np.where(odd[:, None], 1.0, -1.0) * np.sign(log.value[0] + 0.01)
    lost = int(np.argmax(log.time - run.edges[0] >= 6.0))
    kept = np.arange(len(log.time)) != lost
    right, lossy = (
        replace(log, value=chatter),
        replace(log, time=log.time[kept], value=chatter[kept]),
    )
    wrong, left = make_wrong(base, run, right, lossy)
    assert np.linalg.norm(wrong) > 3.0
    assert np.linalg.norm(left) < 0.3 * np.linalg.norm(wrong)


@pytest.mark.parametrize("at", [6.004, 6.026, 6.043])
def test_when_a_jittering_line_acted_is_not_held_against_a_model(tmp_path, at):
    base, (run,) = observed(tmp_path, duration=12.0, camera=Camera(**STILL))
    log = run.motion.commands
    line = int(np.argmax(log.time - run.edges[0] >= at))
    push = 0.2 * np.where(log.value[0] < 0.0, -1.0, 1.0)
    steady = np.where(np.arange(len(log.time))[:, None] < line, push, -push)
    stamps = log.time + np.random.default_rng(5).uniform(-0.006, 0.006, len(log.time))
    right, jittering = replace(log, value=steady), replace(log, time=stamps, value=steady)
    wrong, left = make_wrong(base, run, right, jittering)
    roll = AXES.index("roll")
    assert np.linalg.norm(wrong[roll]) > 0.8 * np.linalg.norm(wrong)
    assert np.linalg.norm(left[roll]) < 0.3 * np.linalg.norm(wrong[roll])


def test_only_a_regular_log_can_jitter():
    rng = np.random.default_rng(6)
    value = np.where(np.arange(200) < 90, -0.5, 0.5)[:, None]

    def find(time):
        return find_jittering(Commands(time, value, "thruster"))

    regular = 0.05 * np.arange(200)
    ((begin, end),) = find(regular + rng.normal(0.0, 0.003, 200))
    assert begin < regular[90] < end
    assert end - begin == pytest.approx(4 * 0.003, rel=0.3)
    assert not len(find(regular))
    assert not len(find(np.cumsum(rng.exponential(0.05, 200))))
    assert not len(find_gaps(Commands(regular, value, "thruster")))


def find_delay(folder, delay, missing=0.0, outage=0):
    """A fit of a delay to runs as quiet as simulated ones, whose logs at 10 Hz lost lines.

    A share of them is `missing`, and so many in a row every 3 s.
    """
    hidden = [{"effect": "input_delay", "parameters": {"delay": delay}}]
    calm, slow = Turbulence(force=0.05, moment=0.002), Log(rate=10.0, missing=missing)
    base, runs = observed(folder, duration=60.0, effects=hidden, turbulence=calm, log=slow)
    if outage:
        log = runs[0].motion.commands
        kept = np.arange(len(log.time)) % 30 >= outage
        runs = [with_log(runs[0], replace(log, time=log.time[kept], value=log.value[kept]))]
        assert fill_lost_lines(runs[0].motion.commands) is runs[0].motion.commands
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    noise, _ = bank.fit_noise(bank.innovations(base), FIRST_NOISE)
    workspace = SimpleNamespace(bank=bank, penalty=12.0, fit=lambda h: fit(h, bank, noise))
    workspace.weigh_term = partial(SearchWorkspace.weigh_term, workspace)
    return workspace, workspace.fit(Hypothesis(base, (Term(InputDelay(), ("delay",)),)))


def test_a_few_lost_lines_are_no_delay(tmp_path):
    """One in 25 would be late by 4 ms in the mean, if it were not put back."""
    workspace, found = find_delay(tmp_path, delay=0.0, missing=0.04)
    assert found.wald_statistic([0]) < workspace.penalty


@pytest.mark.parametrize("delay", [0.0, 0.02])
def test_a_delay_that_only_lost_lines_make_is_not_named(tmp_path, delay):
    """Lines that are lost for long are not put back."""
    workspace, found = find_delay(tmp_path, delay, outage=MAX_LOST_IN_A_ROW + 1)
    assert found.wald_statistic([0]) > workspace.penalty
    kept = drop_unlogged(SearchResult(workspace, found, ())).best.hypothesis.terms
    assert bool(kept) == bool(delay)
