"""A current that wanders is told from still water, from a steady one, and from other pushes."""

from dataclasses import replace
from math import exp

import numpy as np
import pytest

from flown import observed
from rovsim.benchmarks.blind.laws import carried
from rovsim.core.odds import lr_statistic_of
from rovsim.diagnosis.selection.steady_current import challenge_steady, prefer_steady
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import DiagnosisSettings, SearchSettings
from rovsim.diagnosis.train_diagnosis import diagnose_train_runs
from rovsim.dynamics.catalogue import Catalogue, built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.base import Parameter, Wrench
from rovsim.dynamics.effects.current import Current
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.observer.drifting_current import MIN_LR_OF_DRIFT, MovingWater
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE, CurrentPath, DriftingCurrent
from rovsim.estimation.observer.random_walk import list_terms
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns


def rms(values):
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def hide(name, **values):
    """An effect with these values."""
    return EffectEntry(effect=name, parameters=values)


def test_a_diagnosis_names_it_and_finds_its_rate(tmp_path):
    rate = 0.004  # (m/s) / s^0.5: as slow as one that can be told from turbulence
    hidden = (hide("current_drift", rate=rate), hide("net_buoyancy", force=4.0))
    base, runs = observed(tmp_path, duration=60.0, effects=hidden)
    found = diagnose_train_runs(base, runs, DiagnosisSettings(), built_in())
    assert found.verdict == "missing_effects"
    named = {one.term.id: one for one in found.selected}
    assert set(named) == {"net_buoyancy", "current_drift"}
    drift = named["current_drift"]
    assert abs(drift.term.effect["rate"] - rate) < 4.0 * drift.std["rate"]
    assert drift.std["rate"] < 0.3 * rate
    assert drift.probability > 0.99


@pytest.mark.thorough
@pytest.mark.parametrize(
    "hidden",
    [
        (),
        (hide("current", north=0.1),),
        (hide("constant_wrench", surge=4.0),),
        (
            hide(
                "tether_tension",
                stiffness=6.0,
                slack_length=0.5,
                anchor_x=5.0,
                anchor_y=2.0,
                anchor_z=3.0,
            ),
        ),
    ],
    ids=["nothing", "current", "wrench", "tether"],
)
def test_nothing_else_is_taken_for_it(tmp_path, hidden):
    base, runs = observed(tmp_path, duration=60.0, effects=hidden)
    found = diagnose_train_runs(base, runs, DiagnosisSettings(), built_in())
    assert {one.term.id for one in found.selected} == {one.effect for one in hidden}
    assert found.fit.noise.drift is None


class Eddy(Wrench):
    """Water that turns about one place, and rests far from it."""

    id = "eddy"
    listed = False
    equation = r"v_c = \omega e^{-r^2 / 2 s^2} \hat z \times r"
    neglects = "walls, and the force of water that accelerates"
    source = "a test"
    parameters = (Parameter("rate", "1/s", r"\omega", scale=0.3),)

    @staticmethod
    def wrench(at, p):
        """Drag of the water that turns."""
        north, east = at.position[0] - 5.0, at.position[1] + 2.5
        rate = p.rate * exp(-(north * north + east * east))
        X, Y, Z = carried(at, -rate * east, rate * north)
        return X, Y, Z, 0.0, 0.0, 0.0


def settled_noise(base, runs):
    """A filter bank that suits the noise of the nominal model, and that noise."""
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    noise, _ = bank.fit_noise(bank.innovations(base), FIRST_NOISE)
    return bank.redesign(base, noise), noise


def test_what_wanders_leaves_the_disturbance_its_own(tmp_path):
    rate, little = 0.004, {"force": 0.05, "moment": 0.005}
    hidden = (hide("current_drift", rate=rate),)
    known = {"duration": 60.0, "turbulence": little}
    calm = settled_noise(*observed(tmp_path / "calm", **known))[1]
    base, runs = observed(tmp_path / "wandering", effects=hidden, **known)
    bank, noise = settled_noise(base, runs)
    for _ in range(4):
        noise = bank.fit_noise(bank.innovations(base), noise, thorough=True).noise
        bank = bank.redesign(base, noise)
    assert abs(noise.drift.rate / rate - 1.0) < 0.2
    # what wanders faster than the walk's terms is the disturbance's, too
    assert (noise.disturbance_std[:2] > 0.8 * calm.disturbance_std[:2]).all()


def look_for_current(bank, base, noise):
    """Where a search for a steady current begins, under that noise."""
    listed = [
        c for c in list_candidates(bank.runs, built_in(), base.vehicle) if c.effect is Current
    ]
    known = linearise_candidates(bank, Hypothesis(base), listed)
    return SearchWorkspace.begin(WhiteColumns(bank, known, noise), SearchSettings())


def wander(bank, base, noise, rate):
    """The same, under a current that wanders."""
    return look_for_current(bank, base, replace(noise, drift=DriftingCurrent(rate)))


@pytest.mark.parametrize(
    ("hidden", "steady"),
    [(hide("current", north=0.1), True), (hide("current_drift", rate=0.015), False)],
    ids=["steady", "wandering"],
)
def test_a_steady_current_takes_the_place_of_one_that_hardly_wanders(tmp_path, hidden, steady):
    base, runs = observed(tmp_path, duration=60.0, effects=(hidden,))
    bank, noise = settled_noise(base, runs)
    wandering = wander(bank, base, noise, 0.003 if steady else 0.015)
    workspace, found = prefer_steady(wandering, wandering.fit(Hypothesis(base)))
    assert (workspace.noise.drift is None) is steady
    assert [term.id for term in found.hypothesis.terms] == steady * ["current"]
    if steady:
        assert abs(found.hypothesis.model.effects[-1]["north"] - 0.1) < 0.01


@pytest.mark.parametrize(
    ("hidden", "steady"),
    [(hide("current", north=0.02), True), (hide("current_drift", rate=0.004), False)],
    ids=["steady", "wandering"],
)
def test_a_current_that_wanders_slowly_takes_the_place_of_a_steady_one(tmp_path, hidden, steady):
    base, runs = observed(tmp_path, duration=60.0, effects=(hidden,))
    bank, noise = settled_noise(base, runs)
    calm = look_for_current(bank, base, noise)
    accepted = calm.fit(Hypothesis(base, (Term(Current(), Current.telling),)))
    workspace, fit, rivals = challenge_steady(calm, accepted)
    assert (workspace.noise.drift is None) is steady
    assert [term.id for term in fit.hypothesis.terms] == steady * ["current"]
    assert [rival.effect for rival in rivals] == steady * ["current_drift"]
    if steady:  # odds of a hundred at least
        assert rivals[0].deviance_difference > lr_statistic_of(odds=100.0)


def test_the_noise_beside_it_is_that_of_what_it_leaves(tmp_path):
    """A current that wanders may take nearly all of another effect: little noise is left by it."""
    hidden = (hide("current", north=0.1), hide("thruster_gain", all=0.7))
    base, runs = observed(tmp_path, duration=60.0, effects=hidden)
    bank, noise = settled_noise(base, runs)
    little = replace(noise, disturbance_std=0.01 * noise.disturbance_std)
    wandering = wander(bank, base, little, 0.003)
    workspace, found = prefer_steady(wandering, wandering.fit(Hypothesis(base)))
    assert [term.id for term in found.hypothesis.terms] == ["current"]
    left = bank.fit_noise(bank.innovations(found.hypothesis.model), FIRST_NOISE).noise
    ratio = workspace.noise.disturbance_std[:3] / left.disturbance_std[:3]
    assert np.all(np.abs(np.log(ratio)) < np.log(1.5))


@pytest.mark.parametrize(
    ("hidden", "by_place"),
    [(hide("eddy", rate=0.6), True), (hide("current_drift", rate=0.015), False)],
    ids=["eddy", "wandering"],
)
def test_a_flow_that_differs_from_place_to_place_does_not_wander(tmp_path, hidden, by_place):
    known = Catalogue({**built_in(), Eddy.id: Eddy})
    base, runs = observed(tmp_path, duration=60.0, effects=(hidden,), catalogue=known)
    bank, noise = settled_noise(base, runs)
    e = bank.innovations(base)
    assert bank.measure_drift(e, noise).rate.lr_statistic > MIN_LR_OF_DRIFT
    assert bank.varies_with_place(e, noise) is by_place


def test_water_that_moves_shows_as_a_current_does(tmp_path):
    base, runs = observed(tmp_path, duration=20.0)
    steady = np.array([0.08, -0.05])
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    (settled,) = (run.settled for run in bank.runs)
    (expected,) = bank.innovations(base + Current(north=steady[0], east=steady[1]))
    (still,) = bank.innovations(base)

    def err(paths):
        about = replace(bank, paths=paths)
        walk = MovingWater(base, bank.runs, bank.run_filters, paths).walk
        begins = list_terms(runs[0])[0, 0]  # the first term of a walk is a steady current
        linear = np.tensordot(steady / begins, walk.columns[0][:2], axes=1)
        return rms((about.innovations(base)[0] - linear - expected)[:, settled])

    path = CurrentPath(runs[0].time, np.tile(steady, (len(runs[0].time), 1)))
    assert err((path,)) < 0.15 * rms((expected - still)[:, settled])
    assert err((path,)) < err(())
