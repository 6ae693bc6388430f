"""What lasts is foreseen: a model that lacks a force is not flown as if its noise were all."""

import numpy as np
import pytest

from flown import observed
from rovsim.design.adequacy import warn_of_misfit, warn_of_wider
from rovsim.design.from_train_runs import fit_prior
from rovsim.design.low_frequency_disturbance import LowFrequencyDisturbance
from rovsim.design.recording_setup import describe_setup
from rovsim.design.scenarios import draw_scenarios
from rovsim.design.settings import Question
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry, Value
from rovsim.dynamics.effects.buoyancy import NetBuoyancy
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.estimation.observer.noise import Noise

FORCE, HEAVE = 3.0, 2
NOISE = Noise(np.full(6, 0.02), np.ones(6), np.full(6, 1e-3))
QUESTION = Question(know=("linear_damping.surge",))


def test_what_the_noise_explains_does_not_last():
    chance = 0.02 * np.sqrt(2.0 * 0.1 * 0.9)  # of means over 10 s
    blocks = 0.8 * chance * np.array([[1.0] * 6, [-1.0] * 6])
    found = LowFrequencyDisturbance.of_blocks(blocks, 10.0, NOISE)
    assert not found.mean.any()
    assert not found.large.any()
    assert not found.spread.any()
    alone = LowFrequencyDisturbance.of_blocks(np.full((1, 6), 2.5 * chance), 10.0, NOISE)
    assert alone.mean.all()
    assert not alone.large.any()
    assert not LowFrequencyDisturbance.of_blocks(np.empty((0, 6)), 10.0, NOISE).mean.any()


def test_a_mean_and_a_spread_beyond_the_noise_last():
    blocks = np.zeros((4, 6))
    blocks[:, HEAVE], blocks[:, 0] = -0.1, [0.1, -0.1, 0.1, -0.1]
    found = LowFrequencyDisturbance.of_blocks(blocks, 10.0, NOISE)
    assert found.mean == pytest.approx(np.eye(6)[HEAVE] * -0.1)
    assert found.spread[0] > 0.1
    assert not found.spread[1:].any()
    assert list(np.flatnonzero(found.large)) == [HEAVE]


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """The nominal model, and the run of a vehicle that something on board makes float."""
    force = EffectEntry(effect="net_buoyancy", parameters={"force": Value(value=FORCE)})
    folder = tmp_path_factory.mktemp("floating")
    return observed(folder, duration=30.0, effects=(force,))


def test_a_force_that_the_model_lacks_pushes_all_that_could_happen(flown):
    model, runs = flown
    found = fit_prior(model, runs, QUESTION, built_in())
    missing = -FORCE / model.M[HEAVE, HEAVE]
    assert found.low_frequency[0].mean[HEAVE] == pytest.approx(missing, rel=0.3)
    setup = describe_setup(runs, 10.0, None, QUESTION.replay, built_in())
    scenarios = draw_scenarios([[model] * 20], found, setup, np.random.default_rng(0))
    assert scenarios.disturbances[0, :, HEAVE] == pytest.approx(found.low_frequency[0].mean[HEAVE])
    assert scenarios.disturbances[..., HEAVE].mean() == pytest.approx(missing, rel=0.4)
    (told,) = warn_of_misfit(found, QUESTION)
    assert "m/s² in heave" in told
    assert "after 5 s it is" in told


def test_a_model_that_has_it_is_not_doubted(flown):
    model = flown[0] + NetBuoyancy(force=FORCE)
    found = fit_prior(model, flown[1], QUESTION, built_in())
    assert abs(found.low_frequency[0].mean[HEAVE]) < 0.2 * FORCE / model.M[HEAVE, HEAVE]
    assert warn_of_misfit(found, QUESTION) == ()


def test_deviations_that_a_model_file_has_wider_are_told():
    known = NetBuoyancy(force=3.0).with_std({"force": 0.3})
    base = nominal(load_vehicle("bluerov2_heavy")) + known
    (said,) = warn_of_wider(base, {"net_buoyancy.force": 0.1})
    assert "net_buoyancy.force" in said
    assert "all forces have in common" in said
    assert warn_of_wider(base, {"net_buoyancy.force": 0.29, "lift.coefficient": None}) == ()
