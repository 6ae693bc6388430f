"""What was not found of a vehicle file that is off: fitted as well, or in the intervals."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flown import observed
from rovsim.core.axes import AXES
from rovsim.diagnosis.selection.vehicle_file.whole_file import (
    fit_whole_file,
    free_rest,
    list_spreads,
)
from rovsim.diagnosis.uncertainty import file_values
from rovsim.diagnosis.uncertainty.file_values import is_right_elsewhere, settle_whole_file
from rovsim.diagnosis.uncertainty.rest_of_file import include_rest
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.estimation.file_effects import free_terms, penalize_gain
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.prior import Prior

OFF = 0.2  # of each coefficient
FEW_PER_CENT = 0.05  # of each coefficient
WEAK, WEAKER = 0.95, 0.75  # thrusters of this strength
COEFFICIENTS = ("linear_damping", "quadratic_damping", "added_mass")


def fly_off(folder, gain, special=None, share=OFF, duration=20.0):
    """The file, runs of a vehicle of which all is off and special effects act, and by how much."""
    base, _ = observed(folder / "right", duration=2.0)
    body = base.body
    stated = dict(zip(COEFFICIENTS, (body.linear, body.quadratic, np.diag(body.M_A)), strict=True))
    off = {n: dict(zip(AXES, share * x, strict=True)) for n, x in stated.items()}
    off["thruster_gain"] = {"all": gain}
    off |= special or {}
    hidden = tuple(EffectEntry(effect=name, parameters=own) for name, own in off.items())
    base, runs = observed(folder / "off", duration=duration, effects=hidden)
    return base, runs, off


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    return fly_off(tmp_path_factory.mktemp("run"), WEAK)


@pytest.fixture(scope="module")
def bank(flown):
    base, runs, _ = flown
    return FilterBank.design(runs, base, FIRST_NOISE)


def fitted(bank, axes, names=COEFFICIENTS):
    base = bank.model
    return fit(
        Hypothesis(base, free_terms(base, axes, [built_in()[name] for name in names])),
        bank,
        FIRST_NOISE,
    )


def fit_whole(found, bank):
    return fit_whole_file(found.hypothesis, bank, found.noise)


def miss(found, off):
    """Of each value, in standard deviations."""
    z = []
    for term, own in zip(found.hypothesis.terms, found.hypothesis.columns, strict=True):
        for p, k in zip(term.parameters, own, strict=True):
            truth = off.get(term.id, {}).get(p.name, p.default)
            z.append((term.effect[p.name] - truth) / (found.std[k] * p.scale))
    return np.array(z)


def test_what_the_rest_of_the_file_hides_is_in_the_intervals(flown, bank):
    """Nothing is fitted of heave, rotations and thrust, which are as wrong."""
    _, runs, off = flown
    found = fitted(bank, ("surge", "sway"))
    wider, scale = include_rest(found, runs, loose=True)
    assert np.abs(miss(found, off)).max() > 2.5
    assert np.abs(miss(wider, off)).max() < 2.5
    assert np.all(wider.std >= found.std)
    assert "added_mass.surge" in scale.parameters  # heavier, and pushed as much harder


def test_the_rest_of_the_file_is_found_beside_what_is_known_of_such_files(flown, bank):
    _, _, off = flown
    found = fitted(bank, ("surge", "sway"))
    whole = fit_whole(found, bank)
    (heave,) = (t.effect["heave"] for t in whole.hypothesis.terms if t.id == "quadratic_damping")
    assert heave == pytest.approx(off["quadratic_damping"]["heave"], rel=0.5)
    assert np.abs(miss(whole, off)).max() < 3.0
    nearest = {"thruster_gain", "net_buoyancy", "buoyancy_center"}
    assert {term.id for term in whole.hypothesis.terms} == {*COEFFICIENTS, *nearest}


def test_of_the_file_only_that_is_named_without_which_a_replay_is_worse(flown, bank):
    """With the file's gain, all forces are a twentieth too large; so must the restoring ones be."""
    _, _, off = flown
    found = fitted(bank, ("surge", "sway"))
    final, scale = settle_whole_file(fit_whole(found, bank), found.hypothesis, bank)
    assert {term.id for term in final.hypothesis.terms} == {*COEFFICIENTS, "buoyancy_center"}
    assert np.abs(miss(final, off)).max() < 3.0
    assert "added_mass.surge" in scale.parameters


def test_an_accepted_gain_that_only_stood_in_for_the_rest_of_the_file_is_set_back(tmp_path):
    base, runs, off = fly_off(tmp_path, 1.0)
    other = FilterBank.design(runs, base, FIRST_NOISE)
    found = fitted(other, ("surge", "sway"), (*COEFFICIENTS, "thruster_gain"))
    assert found.z_scores[-1] < -5.0  # without the drag of other axes, it seems sure
    final, _ = settle_whole_file(fit_whole(found, other), found.hypothesis, other)
    assert {term.id for term in final.hypothesis.terms} == set(COEFFICIENTS)
    assert np.abs(miss(final, off)).max() < 3.0


def test_a_gain_that_is_surely_off_stays_though_no_replay_would_miss_it(tmp_path):
    """Else all values are off by its inverse, and each with the narrow interval of the scale."""
    base, runs, off = fly_off(tmp_path, WEAKER)
    other = FilterBank.design(runs, base, FIRST_NOISE)
    found = fitted(other, ("surge", "sway"))
    assert "thruster_gain.all" not in found.hypothesis.parameter_names
    final, _ = settle_whole_file(fit_whole(found, other), found.hypothesis, other)
    assert np.abs(miss(final, off)).max() < 3.5
    (gain,) = (t.effect["all"] for t in final.hypothesis.terms if t.id == "thruster_gain")
    assert gain == pytest.approx(WEAKER, abs=0.1)


def test_a_value_that_another_would_have_to_take_up_is_kept(tmp_path, monkeypatch):
    """As a payload does of a moved centre of buoyancy, however good replays are without that."""
    monkeypatch.setattr(file_values, "MAX_ERROR_GROWTH", 10.0)
    hidden = {
        "payload": {"mass": 0.45, "x": 0.15, "z": 0.1},
        "buoyancy_center": {"x": -2e-3, "y": 2e-3},
    }
    base, runs, off = fly_off(tmp_path, 1.0, hidden)
    other = FilterBank.design(runs, base, FIRST_NOISE)
    found = fitted(other, AXES, (*COEFFICIENTS, "payload"))
    final, _ = settle_whole_file(fit_whole(found, other), found.hypothesis, other)
    assert {term.id for term in final.hypothesis.terms} == {*COEFFICIENTS, *hidden}
    assert np.abs(miss(final, off)).max() < 3.0


@pytest.mark.parametrize("axes", [("surge", "sway"), ("surge", "sway", "heave", "yaw"), AXES])
def test_a_file_that_is_off_everywhere_is_not_right_elsewhere(bank, axes):
    """Its ballast is where it says, which tells nothing of drag."""
    found = fitted(bank, axes)
    assert not is_right_elsewhere(fit_whole(found, bank), found.hypothesis)


def test_a_file_may_be_right_but_for_what_was_selected(flown, tmp_path):
    _, _, off = flown
    some = tuple(
        EffectEntry(effect=name, parameters={axis: off[name][axis] for axis in ("surge", "sway")})
        for name in COEFFICIENTS
    )
    base, runs = observed(tmp_path, duration=20.0, effects=some)
    other = FilterBank.design(runs, base, FIRST_NOISE)
    found = fitted(other, ("surge", "sway"))
    assert is_right_elsewhere(fit_whole(found, other), found.hypothesis)


def test_what_is_too_little_to_be_found_is_in_the_intervals(tmp_path):
    base, runs, off = fly_off(tmp_path, 1.0, share=FEW_PER_CENT, duration=40.0)
    found = fitted(FilterBank.design(runs, base, FIRST_NOISE), AXES, COEFFICIENTS[1:])
    wider, _ = include_rest(found, runs, loose=False)
    assert np.abs(miss(found, off)).max() > 5.0
    assert np.abs(miss(wider, off)).max() < 2.5


def test_one_effect_may_be_all_that_is_wrong(tmp_path):
    base, _ = observed(tmp_path / "right", duration=2.0)
    off = {"added_mass": dict(zip(AXES, OFF * np.diag(base.body.M_A), strict=True))}
    hidden = (EffectEntry(effect="added_mass", parameters=off["added_mass"]),)
    base, runs = observed(tmp_path / "off", duration=20.0, effects=hidden)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    found = fitted(bank, AXES, ("added_mass",))
    wider, scale = include_rest(found, runs, loose=False)
    assert scale is None
    assert np.all(wider.std < 1.5 * found.std)
    assert fit_whole(found, bank) is None


def with_gain(base, gain, *names):
    terms = free_terms(base, AXES, [built_in()[name] for name in (*names, "thruster_gain")])
    terms = [t.at(np.array([gain / 0.1])) if t.id == "thruster_gain" else t for t in terms]
    return Hypothesis(base, tuple(terms))


def test_a_gain_far_from_the_file_is_doubted_beside_a_file_that_is_off(flown):
    base = flown[0]
    assert penalize_gain(with_gain(base, 1.6, "added_mass")) == 0.0
    near, far, fault = (penalize_gain(with_gain(base, g, *COEFFICIENTS)) for g in (1.05, 1.6, 0.1))
    assert 0.0 < near < 1.0 < far < fault < 12.0  # a fault costs no more than one parameter does


@pytest.mark.parametrize(("some", "each"), [(("t2", "t5"), 2), (("t2", "t5", "t6"), 8)])
def test_where_thrusters_differ_none_is_taken_for_known(flown, some, each):
    h = Hypothesis(flown[0], (Term(ThrusterGain(), some),))
    freed = free_rest(h)
    (gains,) = (term.free for term in freed.terms if term.id == "thruster_gain")
    assert len(gains) == each + 1  # that of all
    assert np.all(list_spreads(h, freed) > 0.0)


@given(x=st.floats(-50.0, 50.0), std=st.floats(0.1, 10.0), faulty=st.booleans())
def test_a_prior_pulls_as_its_cost_rises(x, std, faulty):
    prior = Prior(np.array([1.0]), np.array([std]), np.array([faulty]))
    at, step = np.array([x]), 1e-4
    slope = (prior.cost(at + step) - prior.cost(at - step)) / (2.0 * step)
    assert 2.0 * prior.weights(at) * (at - 1.0) == pytest.approx(slope, rel=1e-4, abs=1e-6)
