"""What the motion capture does to its poses is told by their noise, whatever else is wrong."""

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.settings import DiagnosisSettings, SearchSettings
from rovsim.diagnosis.train_diagnosis import diagnose_train_runs
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.estimation.observer.camera import Smoothing, find_smoothing
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.simulation.synthetic_tank.settings import Camera

LAG = EffectEntry(effect="thruster_lag", parameters={"time_constant": 0.3})


@pytest.mark.parametrize("cutoff", [3.0, 6.0, 12.0])
def test_a_filter_in_the_software_is_found_by_the_noise(tmp_path, cutoff):
    hidden = (LAG, EffectEntry(effect="pose_filter", parameters={"cutoff": cutoff}))
    base, runs = observed(tmp_path, duration=30.0, effects=hidden)
    found = find_smoothing(base, runs)
    assert found is not None
    assert abs(found.cutoff - cutoff) < max(4.0 * found.std, 0.05 * cutoff)
    assert find_smoothing(base + PoseFilter(cutoff=cutoff), runs) is None  # nothing is left to find


def test_a_vehicle_that_tumbles_is_not_smoothed(tmp_path):
    """Two thrusters swapped: its motion, not its software, falls off steeply above some Hz."""
    swapped = EffectEntry(effect="thruster_order", parameters={"first": 5.0, "second": 8.0})
    base, runs = observed(tmp_path, duration=60.0, effects=(swapped,))
    assert find_smoothing(base, runs) is None


@pytest.mark.parametrize(
    ("colour", "lasts"), [(0.0, 0.5), (0.3e-3, 0.5), (2.0e-3, 0.5), (2.0e-3, 0.1), (2.0e-3, 0.03)]
)
def test_cameras_that_do_not_smooth_are_not_said_to(tmp_path, colour, lasts):
    camera = Camera(colour_noise=colour, colour_attitude=3.0 * colour, colour_time=lasts)
    base, runs = observed(tmp_path, duration=30.0, effects=(LAG,), camera=camera)
    assert find_smoothing(base, runs) is None


def test_a_slow_error_of_the_cameras_is_told_from_noise_and_from_turbulence(tmp_path):
    levels = []
    for colour in (0.0, 1.0e-3):
        camera = Camera(colour_noise=colour, colour_attitude=0.0)
        base, runs = observed(tmp_path / str(colour), duration=60.0, camera=camera)
        bank = FilterBank.design(runs, base, FIRST_NOISE)
        e = [one[0] for one in bank.evaluate([base])]
        noise, _ = bank.fit_noise(e, FIRST_NOISE, thorough=True)
        levels.append(noise.bias_std)
    assert np.all(levels[0][3:] == 0.0)
    assert np.count_nonzero(levels[0]) <= 1
    assert np.median(levels[1][:3]) == pytest.approx(1.0e-3, rel=0.4)


@pytest.mark.thorough
def test_a_filter_that_replays_worse_than_nothing_is_refused(tmp_path, monkeypatch):
    base, runs = observed(tmp_path, duration=60.0)
    wrong = Smoothing(
        cutoff=1.5,
        std=0.01,
        lr_statistic=100.0,
        noise_cutoff=1.5,
        lowest=1.49,
        highest=1.51,
        frame=0.01,
    )
    monkeypatch.setattr(
        "rovsim.diagnosis.validated_search.find_smoothing", lambda base, runs: wrong
    )
    one_at_most = DiagnosisSettings(search=SearchSettings(most_effects=1))
    found = diagnose_train_runs(base, runs, one_at_most, built_in())
    assert found.verdict == "adequate"
