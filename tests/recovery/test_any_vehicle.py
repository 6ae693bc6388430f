"""The synthetic tank flies any vehicle, and its raw exports bring angles back as they were."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from rovsim.application.configuration import compose
from rovsim.application.pipeline.measured_campaign import measure, open_campaign
from rovsim.application.pipeline.recorded_run import load_campaign_vehicle
from rovsim.application.settings import select
from rovsim.core.errors import BadInput
from rovsim.diagnosis.campaign_diagnosis import diagnose_campaign
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model import nominal
from rovsim.evaluation.score_collector import score_replay
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.simulation.command_columns import mark_angles
from rovsim.simulation.replay import replay
from rovsim.simulation.settings import SimulationSettings
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import SUITABLE_TANKS, TankRun, TankSettings

RUN = (TankRun(id="one", control="6dof", split="train"),)
PODS = {
    "name": "pods",
    "fluid": {"density": 1000.0, "gravity": 9.81},
    "degrees_of_freedom": ["surge", "sway", "yaw"],
    "rigid_body": {"mass": 24.0, "inertia": {"Izz": 1.7}, "center_of_gravity": [0.05, 0, 0]},
    "hydrodynamics": {
        "added_mass": [2.0, 10.0, 0, 0, 0, 1.0],
        "linear_damping": [2.0, 7.0, 0, 0, 0, 2.0],
        "quadratic_damping": [1.3, 36.0, 0, 0, 0, 0.75],
    },
    "thrusters": {
        "force_curve": {"quadratic": {"forward": 9.0, "reverse": 7.0}},
        "units": [
            {"name": n, "position": [-0.5, y, 0], "direction": [1, 0, 0], "azimuth": True}
            for n, y in (("port", -0.1), ("starboard", 0.1))
        ],
    },
}


def flown(tmp_path, **settings):
    tank = TankSettings.model_validate({"runs": RUN, "duration": 20.0} | settings)
    make_campaign(tank, tmp_path / "raw", built_in())
    campaign = open_campaign(str(tmp_path / "raw"))
    data = measure(campaign, SignalSettings())
    return campaign, data, data.motions["one"]


def check_replay(data, run):
    """A perfect model follows its own tank within the noise of cameras and water."""
    found = replay(nominal(data.vehicle), run, SimulationSettings())
    error = score_replay(run, found).windows["2"].velocity_rmse
    assert max(error.surge, error.yaw) < 0.05


def test_a_torpedo_flies_by_its_fins(tmp_path):
    campaign, data, run = flown(tmp_path, **SUITABLE_TANKS["surfaces"])
    assert campaign.commands.columns == ["propeller", "rudder", "stern"]
    angles = run.commands.value[:, 1:]
    assert 0.02 < np.abs(angles).max() <= 0.25
    assert run.nu[run.usable, 0].mean() > 0.3
    check_replay(data, run)


def test_what_floats_stays_at_the_surface(tmp_path):
    without_waves = {k: SUITABLE_TANKS["waterplane"][k] for k in ("vehicle", "tank")}
    _, data, run = flown(tmp_path, **without_waves)
    assert run.site.level == pytest.approx(run.site.tank[2, 0], abs=0.01)
    check_replay(data, run)


@pytest.mark.thorough
def test_a_wrong_depth_at_rest_is_no_sure_force(tmp_path):
    """A pilot who pushed a floating vehicle down was a wrench of -45 N at a probability of one."""
    _, data, run = flown(tmp_path, duration=40.0, **SUITABLE_TANKS["waterplane"])
    lower = replace(run, site=replace(run.site, level=run.site.level + 0.02))
    runs = Runs({"one": lower}, data.runs.stages, data.runs.splits)
    settings = select(compose(["command=diagnose"]), DiagnosisSettings)
    found = diagnose_campaign(runs, {}, nominal(data.vehicle), settings, built_in()).diagnosis
    (force,) = found.selected
    assert force.parameters.keys() == {"heave"}
    assert (force.probability, force.doubt) == (None, "depth_at_rest")
    assert "float without commands" in found.next_experiment


def test_pods_turn_as_the_log_says(tmp_path):
    path = tmp_path / "pods.yaml"
    path.write_text(yaml.safe_dump(PODS))
    box = {"x": (0.0, 20.0), "y": (0.0, 20.0), "z": (0.0, 3.0)}
    _, data, run = flown(tmp_path, vehicle=str(path), tank=box)
    assert np.abs(run.commands.value[:, [1, 3]]).max() > 1.0  # rad: not taken for a command
    assert np.ptp(run.eta[run.usable, 2]) < 0.01
    check_replay(data, run)


def test_columns_in_another_order_are_refused(tmp_path):
    campaign, _, _ = flown(tmp_path, **SUITABLE_TANKS["surfaces"])
    columns = ["rudder", "propeller", "stern"]
    log = campaign.commands.model_copy(update={"columns": columns})
    object.__setattr__(campaign, "commands", log)
    with pytest.raises(BadInput, match="propeller, rudder, stern"):
        mark_angles(campaign, load_campaign_vehicle(campaign))
