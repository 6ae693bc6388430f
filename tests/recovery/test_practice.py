"""Independent synthetic exports and real recordings, where they are present."""

import numpy as np
import pytest

from rovsim.application.pipeline.recordings import load_campaign_vehicle
from rovsim.dynamics.model import nominal
from rovsim.evaluation.scores import pool, rms, score, subtract
from rovsim.learning.pairs import sample_run
from rovsim.measurement.campaign import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.signals.chain import SignalSettings, clean
from rovsim.simulation.replay import replay
from rovsim.simulation.settings import ReplaySettings
from worlds import SHARED, needed


def test_the_nominal_model_explains_the_empty_practice_tank():
    campaign = load_campaign(needed(SHARED / "practice" / "null-2"))
    model, found = nominal(load_campaign_vehicle(campaign)), []
    for run in campaign.runs:
        if run.split == "test":
            motion = clean(read_run(campaign, run.id)[0], SignalSettings())
            again = replay(model, motion, SignalSettings(), ReplaySettings())
            found.append(subtract(motion, again.horizons["2"]))
    assert np.all(rms(pool(found).nu) <= [0.013] * 3 + [0.035] * 3)


@pytest.fixture
def binned():
    """The 3-DoF run of the public tank recordings: means over uneven bins."""
    needed(SHARED / "data" / "kth_tank_2025")
    from pathlib import Path

    campaign = load_campaign(Path(__file__).parents[2] / "campaigns" / "kth_tank_2025")
    motion = clean(read_run(campaign, "115750")[0], SignalSettings())
    return nominal(load_campaign_vehicle(campaign)), motion


def test_bins_are_compared_as_bins(binned):
    model, motion = binned
    found = score(motion, replay(model, motion, SignalSettings(), ReplaySettings()))
    for horizon in ("0.5", "2", "5"):
        assert found.windows[horizon].velocity_rmse["surge"] < 1.0
    again = replay(model, motion, SignalSettings(), ReplaySettings())
    predicted = again.horizons["2"]
    both = np.isfinite(predicted.nu).all(axis=1)
    assert both.mean() > 0.9
    k = np.flatnonzero(both[1:] & both[:-1] & np.isfinite(predicted.nu_dot[1:, 0])) + 1
    difference = (predicted.nu[k] - predicted.nu[k - 1]) / np.diff(motion.time)[k - 1][:, None]
    np.testing.assert_allclose(predicted.nu_dot[k], difference, atol=1e-9)


def test_binned_training_pairs_miss_what_the_score_misses(binned):
    """a_res of one bin step is the acceleration error of a window of two bins."""
    model, motion = binned
    found = sample_run(model, motion, SignalSettings(), ReplaySettings())
    assert len(found.index) > 1000
    assert np.isfinite(found.a_res).all()
    a_sim_like = motion.nu_dot[found.index] - found.a_res
    assert np.corrcoef(a_sim_like[:, 0], found.a_sim[:, 0])[0, 1] > 0.8
