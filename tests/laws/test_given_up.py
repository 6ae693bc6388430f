"""A fit is given up only where it would not have reached what it should."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.estimation.fit import fit, fit_or_give_up
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE

HIDDEN = EffectEntry(effect="quadratic_damping", parameters={"surge": 60.0, "sway": 80.0})


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    base, runs = observed(tmp_path_factory.mktemp("run"), duration=20.0, effects=(HIDDEN,))
    return FilterBank.design(runs, base, FIRST_NOISE)


def start(bank, name, *free):
    return Hypothesis(bank.model, (Term(built_in()[name](), free),))


@pytest.mark.parametrize(
    ("name", "free"),
    [
        ("quadratic_damping", ("surge", "sway")),
        ("added_mass", ("surge", "sway")),
        ("input_delay", ("delay",)),
    ],
)
def test_it_ends_where_it_would_or_is_given_up(bank, name, free):
    whole = fit(start(bank, name, *free), bank, FIRST_NOISE)
    first = bank.linearise(start(bank, name, *free))
    for J in first.J:
        J *= 1.2  # derivatives that are roughly right
    for least in whole.two_log_likelihood + np.array([-1e3, -1.0]):  # what it reaches, is reached
        found = fit_or_give_up(first, bank, FIRST_NOISE, least)
        assert found.two_log_likelihood == pytest.approx(whole.two_log_likelihood, abs=0.5)
        assert np.abs((found.hypothesis.x - whole.hypothesis.x) / whole.std).max() < 0.05


def test_what_cannot_reach_the_truth_is_given_up(bank, monkeypatch):
    true = fit(start(bank, "quadratic_damping", "surge", "sway"), bank, FIRST_NOISE)
    other = start(bank, "added_mass", "surge", "sway")
    assert fit(other, bank, FIRST_NOISE).two_log_likelihood < true.two_log_likelihood - 100.0
    first, asked = bank.linearise(other, true.linearised), []
    find = FilterBank.linearise
    monkeypatch.setattr(FilterBank, "linearise", lambda *a: asked.append(a) or find(*a))
    assert fit_or_give_up(first, bank, FIRST_NOISE, true.two_log_likelihood - 100.0) is None
    assert len(asked) == 1  # derivatives are found anew once


def test_derivatives_to_the_same_parameters_are_taken_over(bank):
    known = bank.linearise(start(bank, "quadratic_damping", "surge", "sway"))
    both = replace(
        known.hypothesis, terms=(*start(bank, "added_mass", "sway").terms, *known.hypothesis.terms)
    )
    seen, whole = bank.linearise(both, known), bank.linearise(both)
    for J, known_J, whole_J in zip(seen.J, known.J, whole.J, strict=True):
        assert (J[1:] == known_J).all()
        assert (J[0] == whole_J[0]).all()
