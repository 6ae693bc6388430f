"""Independent exports and real recordings, where they are present, and the tank in their form."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from recordings import write_campaign, write_lines
from rovsim.application.pipeline.recorded_run import load_campaign_vehicle
from rovsim.core.axes import AXES
from rovsim.core.rotations import to_euler
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.evaluation.error_metrics import ErrorSums, subtract
from rovsim.evaluation.score_collector import score_replay
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.signals.chain import SignalSettings, clean
from rovsim.simulation.replay import replay
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import SimulationSettings
from rovsim.simulation.synthetic_tank.settings import Log, TankSettings
from rovsim.simulation.synthetic_tank.true_run import Flight, fly_run
from worlds import SHARED, needed

ROOT = Path(__file__).parents[2]


def test_the_nominal_model_explains_the_empty_practice_tank():
    campaign = load_campaign(needed(SHARED / "practice" / "null-2"))
    model, found = nominal(load_campaign_vehicle(campaign)), ErrorSums.nothing()
    for run in campaign.runs:
        if run.split == "test":
            motion = clean(read_run(campaign, run.id)[0], SignalSettings())
            again = replay(model, motion, SimulationSettings())
            found += ErrorSums.of(subtract(motion, again.horizons["2"]))
    assert np.all(found.velocity_rmse <= [0.013] * 3 + [0.035] * 3)


NAMES = ("x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad", "u_m_s", "v_m_s", "w_m_s")
RATES = ("p_rad_s", "q_rad_s", "r_rad_s")


def tank_in_bins(folder):
    """A run of the tank as that laboratory published its own: means over uneven bins, demands."""
    settings = TankSettings(duration=30.0, log=Log(kind="demand"))
    world = nominal(load_vehicle("bluerov2_heavy"))
    truth = fly_run(world, settings, Flight("3dof"), np.random.default_rng(0))
    begin = np.cumsum(np.tile([0.15, 0.16, 0.14, 0.18], 45))
    found = np.hstack([truth.state[:, :3], to_euler(truth.state[:, 3:7]), truth.state[:, 7:]])
    held = np.searchsorted(truth.commands.time, truth.time, side="right") - 1
    found = np.hstack([found, truth.commands.value[np.maximum(held, 0)]])
    inside = [(truth.time >= a) & (truth.time < b) for a, b in pairwise(begin)]
    rows = [[a, *found[rows].mean(axis=0)] for a, rows in zip(begin, inside, strict=False)]
    head = ",".join(("time_s", *NAMES, *RATES, *AXES))
    write_lines(folder / "a.csv", [head, *(",".join(f"{x:.9g}" for x in row) for row in rows)])
    return write_campaign(
        folder,
        {
            "name": "bins",
            "vehicle": "bluerov2_heavy",
            "mocap": {"format": "csv", "world_axes": "ned", "body_axes": "frd"},
            "commands": {"format": "csv", "kind": "demand", "columns": list(AXES)},
            "runs": [
                {
                    "id": "a",
                    "control": "3dof",
                    "split": "test",
                    "mocap": "a.csv",
                    "commands": "a.csv",
                }
            ],
        },
    )


@pytest.fixture(params=["recorded", "tank"])
def binned(request, tmp_path):
    """Means over uneven bins: the 3-DoF run of the public recordings, and one of the tank."""
    if request.param == "tank":
        campaign, run = load_campaign(tank_in_bins(tmp_path / "bins")), "a"
    else:
        needed(SHARED / "data" / "kth_tank_2025")
        campaign, run = load_campaign(ROOT / "campaigns" / "kth_tank_2025"), "115750"
    motion = clean(read_run(campaign, run)[0], SignalSettings())
    return nominal(load_campaign_vehicle(campaign)), motion


def test_bins_are_compared_as_bins(binned):
    model, motion = binned
    found = score_replay(motion, replay(model, motion, SimulationSettings()))
    for horizon in ("0.5", "2", "5"):
        assert found.windows[horizon].velocity_rmse["surge"] < 1.0
    again = replay(model, motion, SimulationSettings())
    predicted = again.horizons["2"]
    both = np.isfinite(predicted.nu).all(axis=1)
    assert both.mean() > 0.9
    k = np.flatnonzero(both[1:] & both[:-1] & np.isfinite(predicted.nu_dot[1:, 0])) + 1
    difference = (predicted.nu[k] - predicted.nu[k - 1]) / np.diff(motion.time)[k - 1][:, None]
    np.testing.assert_allclose(predicted.nu_dot[k], difference, atol=1e-9)


def test_binned_training_pairs_miss_what_the_score_misses(binned):
    """a_res of one bin step is the acceleration error of a window of two bins."""
    model, motion = binned
    found = sample_run(model, motion, SimulationSettings())
    assert len(found.index) > 0.7 * len(motion.time)
    assert np.isfinite(found.a_res).all()
    a_sim_like = motion.nu_dot[found.index] - found.a_res
    assert np.corrcoef(a_sim_like[:, 0], found.a_sim[:, 0])[0, 1] > 0.8
