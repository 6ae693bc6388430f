"""What was not found of a vehicle file that is off widens the intervals of what was."""

import numpy as np
import pytest

from flown import observed
from rovsim import AXES
from rovsim.diagnosis.checks.rest_of_file import include_rest
from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.noise import FIRST_NOISE
from rovsim.diagnosis.selection.gauss_newton import fit
from rovsim.diagnosis.selection.nominal_terms import free_terms
from rovsim.dynamics.model_file import EffectEntry

OFF = 0.2  # of each coefficient
WEAK = 0.95  # thrusters of this strength
COEFFICIENTS = ("linear_damping", "quadratic_damping", "added_mass")


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    base, _ = observed(folder / "right", duration=2.0)
    body = base.body
    stated = dict(zip(COEFFICIENTS, (body.linear, body.quadratic, np.diag(body.M_A)), strict=True))
    off = {n: dict(zip(AXES, OFF * x, strict=True)) for n, x in stated.items()}
    off["thruster_gain"] = {"all": WEAK}
    hidden = tuple(EffectEntry(effect=name, parameters=own) for name, own in off.items())
    base, runs = observed(folder / "off", duration=20.0, effects=hidden)
    return base, runs, off


def fitted(flown, axes, names=COEFFICIENTS):
    base, runs, _ = flown
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    return fit(Hypothesis(base, free_terms(base, axes, names)), bank, FIRST_NOISE)


def miss(found, off):
    """Of each value, in standard deviations."""
    z = []
    for term, own in zip(found.hypothesis.terms, found.hypothesis.columns, strict=True):
        for p, k in zip(term.parameters, own, strict=True):
            z.append((term.effect[p.name] - off[term.id][p.name]) / (found.std[k] * p.scale))
    return np.array(z)


def test_what_the_rest_of_the_file_hides_is_in_the_intervals(flown):
    """Nothing is fitted of heave, rotations and thrust, which are as wrong."""
    _, runs, off = flown
    found = fitted(flown, ("surge", "sway"))
    wider, scale = include_rest(found, runs)
    assert np.abs(miss(found, off)).max() > 2.5
    assert np.abs(miss(wider, off)).max() < 2.5
    assert np.all(wider.std >= found.std)
    assert "added_mass.surge" in scale.parameters  # heavier, and pushed as much harder


def test_one_effect_may_be_all_that_is_wrong(flown):
    found = fitted(flown, AXES, ("added_mass",))
    assert include_rest(found, flown[1]) == (found, None)
