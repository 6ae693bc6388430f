"""Where readings of one stretch of time err alike, an effect is as sure as stretches make it."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.dynamics.catalogue import built_in
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.observed_run import number_blocks
from rovsim.estimation.observer.sandwich import estimate_covariance

DRAG = built_in()["quadratic_damping"]


@pytest.fixture(scope="module")
def fitted(tmp_path_factory):
    base, runs = observed(tmp_path_factory.mktemp("unsure"), duration=120.0)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    noise = bank.fit_noise(bank.innovations(base), FIRST_NOISE).noise
    return bank, fit(Hypothesis(base, (Term(DRAG(), ("surge",)),)), bank, noise)


def spread(bank, found, lasting):
    """Variance of the drag where innovations of each block have a push of that size in common."""
    blocks = number_blocks(bank.runs)
    random = np.random.default_rng(1)
    shown = bank.whiten(found.linearised.e, found.noise)
    scale = bank.run_filters[0].variance[:, None] ** 0.5
    pushes = random.normal(size=(blocks.max() + 1, 6, 1)) * scale
    settled = bank.runs[0].settled
    assert shown.shape[-1] == settled.sum()
    e = found.linearised.e[0].copy()
    e[:, settled] += lasting * np.concatenate([pushes[b] for b in blocks], axis=1)
    moved = replace(found, linearised=replace(found.linearised, e=[e]))
    return float(estimate_covariance(bank.whiten(moved.linearised.rows, moved.noise), blocks)[0, 0])


def test_blocks_of_independent_readings_tell_what_the_readings_do(fitted):
    bank, found = fitted
    assert 0.2 < spread(bank, found, 0.0) / found.covariance[0, 0] < 5.0


def test_what_blocks_have_in_common_makes_a_value_less_sure(fitted):
    bank, found = fitted
    assert spread(bank, found, 1.0) > 3.0 * spread(bank, found, 0.0)
