"""A perfect model has the noise floor, wherever somebody knows what its thrusters were told."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.checks.noise_floor import simulate_noise_floor
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.estimation.fit import fit_noise_only
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.observed_run import prepare_run
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.measurement.signals.motion import Poses
from rovsim.simulation.settings import ReplaySettings

LAG = ThrusterLag(time_constant=0.2)


def begun_late(run):
    """Ten seconds of the run, from when its commands have just changed most."""
    log = run.motion.commands
    change = np.abs(log.held_at(log.time) - log.held_at(log.time - 0.3)).sum(axis=1)
    change[(log.time < run.motion.time[0] + 1.0) | (log.time > run.motion.time[-1] - 10.0)] = 0.0
    at = log.time[np.argmax(change)]
    begin, end = np.searchsorted(run.motion.time, [at, at + 10.0])
    kept = slice(int(begin), int(end))
    motion = run.motion.part(kept)
    log = motion.commands
    later = log.time >= motion.time[0]
    log = replace(log, time=log.time[later], value=log.value[later], before=0.0)
    motion = replace(motion, commands=log)
    stage = Poses(
        motion.run, motion.site, motion.time, run.frames[kept, :7], motion.usable, motion.commands
    )
    return prepare_run(stage, motion, ReplaySettings(), built_in(), np.ones(6, bool))


def test_what_thrusters_were_told_before_the_log_is_not_held_against_a_model(tmp_path):
    base, (run,) = observed(tmp_path, duration=30.0, unlisted=[LAG])
    truth = base + LAG
    bank = FilterBank.design([run], truth, FIRST_NOISE)
    noise = fit_noise_only(bank.linearise(Hypothesis(truth)), bank, FIRST_NOISE).noise
    whole = simulate_noise_floor(truth, [run], noise, SignalSettings())
    assert whole.times == pytest.approx(1.0, abs=0.25)
    late = simulate_noise_floor(truth, [begun_late(run)], noise, SignalSettings())
    assert late.times == pytest.approx(1.0, abs=0.25)
    wrong = simulate_noise_floor(base, [begun_late(run)], noise, SignalSettings())
    assert wrong.times > 2.0
