"""Where runs differ, what only makes up for that goes, and what acts stays."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.checks.needless_effects import find_needless
from rovsim.diagnosis.checks.run_differences import RunDifference, RunValues
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.current import Current
from rovsim.dynamics.effects.damping import QuadraticDamping
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.simulation.drive import Drives

CURRENT = Current(north=0.08, east=0.05)
PENALTY = 11.5  # as of some sixty candidates


@pytest.fixture(scope="module")
def two_runs(tmp_path_factory):
    """The base, and two runs in a current: the log of the second is 0.1 s early."""
    base, (run,) = observed(tmp_path_factory.mktemp("raw"), duration=30.0, unlisted=[CURRENT])
    log = replace(run.motion.commands, time=run.motion.commands.time - 0.1)
    info = replace(run.motion.run, id="b")
    fine = np.linspace(run.edges[0], run.edges[-1], int(run.substeps.sum()) + 1)
    motion = replace(run.motion, run=info, commands=log)
    return base, (run, replace(run, motion=motion, drives=Drives(log, fine, "held", run.substeps)))


def needless(base, runs, *effects):
    terms = tuple(
        Term(effect, tuple(p.name for p in effect.parameters if p.fitted)) for effect in effects
    )
    accepted = Hypothesis(base, terms)
    bank = FilterBank.design(runs, accepted.model, FIRST_NOISE)
    found = fit(accepted, bank, FIRST_NOISE)
    delay = RunValues(Term(InputDelay(delay=0.05), ("delay",)), {})
    return find_needless(found, bank, RunDifference({"a": delay, "b": delay}), PENALTY)


def test_what_only_makes_up_for_the_difference_is_needless(two_runs):
    base, runs = two_runs
    drag = QuadraticDamping(surge=1.0)
    assert needless(base, runs, drag, CURRENT) == "quadratic_damping"


def test_what_acts_beside_the_difference_is_needed(two_runs):
    base, runs = two_runs
    assert needless(base, runs, CURRENT) is None
    assert needless(base, runs) is None
