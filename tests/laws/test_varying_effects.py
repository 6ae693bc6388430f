"""An effect that acts in one run alone is not sure, however sure its mean over the runs looks."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.checks.by_run import ProductsByRun
from rovsim.diagnosis.checks.varying_effects import find_varying, score_difference
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE


def push(force):
    return (EffectEntry(effect="net_buoyancy", parameters={"force": force}),) if force else ()


@pytest.fixture(scope="module")
def fly(tmp_path_factory):
    """A bank of two runs with these net buoyancies, and the base that lacks them."""

    def make(*forces):
        runs = []
        for k, force in enumerate(forces):
            folder = tmp_path_factory.mktemp("run")
            base, (run,) = observed(folder, duration=15.0, seed=k, effects=push(force))
            info = replace(run.motion.run, id=f"run-{k}")
            runs.append(replace(run, motion=replace(run.motion, run=info)))
        return base, FilterBank.design(runs, base, FIRST_NOISE)

    return make


def fitted(base, bank):
    term = Term(built_in()["net_buoyancy"](), ("force",))
    return fit(Hypothesis(base, (term,)), bank, FIRST_NOISE)


def test_what_acts_in_one_run_alone_varies(fly):
    base, bank = fly(4.0, 0.0)
    assert find_varying(fitted(base, bank), bank) == {"net_buoyancy"}


@pytest.mark.parametrize("forces", [(3.0, 3.0), (20.0, 21.0)])
def test_what_acts_in_all_runs_does_not_vary_nor_does_what_hardly_varies(fly, forces):
    base, bank = fly(*forces)
    assert find_varying(fitted(base, bank), bank) == set()


def test_the_statistic_is_that_of_values_for_each_run():
    """By least squares with and without a column for each run, on random columns."""
    random = np.random.default_rng(2)
    J, e, number = random.normal(size=(3, 90)), random.normal(size=90), np.repeat([0, 1, 2], 30)
    parts = [J[:, number == k] for k in range(3)]
    gram = np.array([part @ part.T for part in parts])
    b = np.array([part @ e[number == k] for k, part in enumerate(parts)])

    def left(columns):
        residual = e - columns.T @ np.linalg.lstsq(columns.T, e, rcond=None)[0]
        return residual @ residual

    own = np.array([J[1] * (number == k) for k in range(3)])
    statistic, freedom = score_difference(ProductsByRun(gram, b), [1])
    assert freedom == 2
    assert statistic == pytest.approx(left(J) - left(np.vstack([J, own])))
