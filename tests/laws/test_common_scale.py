"""More thrust, inertia and drag by one share move alike: what is said of a fit that shows it."""

import numpy as np
import pytest

from flown import observed
from rovsim.core.axes import AXES
from rovsim.diagnosis.advice import FIX_SCALE, advise
from rovsim.diagnosis.selection.vehicle_file.whole_file import fit_whole_file, sharpen_covariance
from rovsim.diagnosis.train_diagnosis import TrainDiagnosis
from rovsim.diagnosis.uncertainty.common_scale import include_scale
from rovsim.diagnosis.uncertainty.nuisance_parameters import free_nuisance
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.estimation.file_effects import GAIN_RELATIVE_STD, GAIN_SCALE, free_terms
from rovsim.estimation.fit import fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.usable_runs import UsableRuns
from rovsim.reporting.words.verdict import explain
from rovsim.results.diagnosis import ScaleOfForces
from synthetic_study import study

WEAK = 0.9  # thrusters of this strength, which nobody knows
COEFFICIENTS = ("linear_damping", "quadratic_damping", "added_mass")
EVERYTHING = (*COEFFICIENTS, "net_buoyancy", "buoyancy_center")


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    hidden = (EffectEntry(effect="thruster_gain", parameters={"all": WEAK}),)
    return observed(tmp_path_factory.mktemp("run"), duration=20.0, effects=hidden)


def fitted(flown, names):
    """The fit of these effects, nothing else, to thrusters taken for nominal ones."""
    base, runs = flown
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    return fit(
        Hypothesis(base, free_terms(base, AXES, [built_in()[name] for name in names])),
        bank,
        FIRST_NOISE,
    )


def named(found):
    return [f"{t.id}.{p.name}" for t in found.hypothesis.terms for p in t.parameters]


def test_what_only_a_scale_fixes_is_said_and_intervals_hold_it(flown):
    base, runs = flown
    found = fitted(flown, EVERYTHING)
    wider, scale = include_scale(found, runs)
    assert scale.std == pytest.approx(0.1, rel=0.1)  # what a vehicle file is taken to know
    surge = named(found).index("added_mass.surge")
    assert "added_mass.surge" in scale.parameters
    unit = found.hypothesis.terms[2].parameters[0].scale
    value, total = found.hypothesis.x[surge] * unit, base.body.M[0, 0]
    assert value == pytest.approx(total * (1.0 / WEAK - 1.0), rel=0.1)  # right up to the scale
    assert value > 10.0 * found.std[surge] * unit  # which nothing said: the truth is zero
    assert value < 1.96 * wider.std[surge] * unit


def test_values_follow_the_scale_as_newtons_law_demands(flown):
    base, runs = flown
    found = fitted(flown, EVERYTHING)
    wider, scale = include_scale(found, runs)
    added = np.sqrt(np.diag(wider.covariance - found.covariance))
    for axis in ("surge", "sway", "heave"):
        k, i = named(found).index(f"added_mass.{axis}"), AXES.index(axis)
        unit = found.hypothesis.terms[2].parameters[i].scale
        total = base.body.M[i, i] + found.hypothesis.x[k] * unit
        assert added[k] * unit == pytest.approx(scale.std * total, rel=0.05)


def test_runs_tell_nothing_of_it_however_precise_they_are(flown):
    """Differences to one side seem to, by 0.01 here, and by 12 in four runs of a light vehicle."""
    found = fitted(flown, EVERYTHING)
    freed = found.hypothesis.with_term(Term(ThrusterGain(), ("all",)))
    assert abs(free_nuisance(found, freed, flown[1]).information[0, 0]) < 1e-3


def test_a_whole_file_knows_no_more_of_it_than_was_known_before(flown):
    base, runs = flown
    selected = fitted(flown, EVERYTHING).hypothesis
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    whole = sharpen_covariance(fit_whole_file(selected, bank, FIRST_NOISE), selected, bank)
    gain = named(whole).index("thruster_gain.all")
    known = (GAIN_SCALE / GAIN_RELATIVE_STD) ** 2
    assert 1.0 / whole.covariance[gain, gain] == pytest.approx(known, abs=1e-3)


def test_a_known_centre_of_buoyancy_fixes_it(flown):
    found = fitted(flown, (*COEFFICIENTS, "net_buoyancy"))
    wider, scale = include_scale(found, flown[1])
    assert scale is None
    assert np.all(wider.std >= found.std)
    assert np.median(wider.std / found.std) < 1.5


@pytest.mark.parametrize("names", [COEFFICIENTS[:2], ("added_mass", "net_buoyancy")])
def test_without_both_inertia_and_drag_nothing_changes(flown, names):
    found = fitted(flown, names)
    assert include_scale(found, flown[1]) == (found, None)


def test_a_gain_that_was_selected_says_itself_how_open_the_scale_is(flown):
    found = fitted(flown, (*EVERYTHING, "thruster_gain"))
    same, scale = include_scale(found, flown[1])
    assert same is found
    k = named(found).index("thruster_gain.all")
    assert scale.std == pytest.approx(0.1 * found.std[k])
    assert scale.std > 0.1
    assert {"thruster_gain.all", "added_mass.surge"} <= set(scale.parameters)


def test_it_is_said_in_plain_words_with_what_to_measure(flown):
    found = fitted(flown, EVERYTHING)
    wider, scale = include_scale(found, flown[1])
    asked = TrainDiagnosis(flown[0], UsableRuns((), (), (), (), 60.0), wider, scale=scale)
    assert FIX_SCALE in advise(asked, [], [], built_in())
    told = ScaleOfForces(std=scale.std, parameters=scale.parameters)
    one = study()["diagnosis"].model_copy(update={"common_scale": told})
    said = [r for r in explain(one, built_in()).remarks if "up to one common factor" in r]
    assert len(said) == 1
    assert "added_mass" in said[0]
    assert not any(
        "up to one common factor" in r for r in explain(study()["diagnosis"], {}).remarks
    )
