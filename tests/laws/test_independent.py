"""Two simulators that share no physics tell the same motion: each is a check of the other."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rovsim.application.configuration import compose
from rovsim.application.settings import select
from rovsim.apps.cli.commands.blind import Settings
from rovsim.benchmarks.blind.flight import SIMULATORS, fly
from rovsim.benchmarks.blind.independent.campaign import SIMULATED_EFFECTS, record_campaign
from rovsim.benchmarks.blind.independent.exports import write_poses
from rovsim.benchmarks.blind.independent.motion import Mover, Vehicle
from rovsim.benchmarks.blind.independent.thrusters import Thrusters
from rovsim.benchmarks.blind.independent.vehicle import read_constants
from rovsim.benchmarks.blind.suites import hiding, suite
from rovsim.core.rotations import conjugate, from_euler, log, multiply
from rovsim.core.run import Site
from rovsim.core.shipped import conf_file
from rovsim.core.yaml_files import read_yaml
from rovsim.dynamics.catalogue import built_in
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import beside_others, model, motion, sticks

FILE = read_yaml(conf_file("vehicle/bluerov2_heavy.yaml"))
TANK = np.array([[0.0, 10.0], [-5.0, 0.0], [-3.0, 0.0]])  # NED
SITE = Site(TANK, np.array([1.0, -1.0, -1.0]))
SECONDS, TICK = 3.0, 0.1
START = np.concatenate(
    [[5.0, -2.5, -1.5], from_euler(0.2, -0.1, 0.7), [0.2, 0.1, -0.1, 0.1, 0.2, -0.2]]
)
# A strong case of each: what the tank and the catalogue say of it is not looked up.
HIDDEN = {
    "net_buoyancy": {"force": 4.0},
    "buoyancy_center": {"x": 0.01, "y": -0.005, "z": -0.01},
    "payload": {"mass": 1.2, "x": 0.1, "y": -0.05, "z": 0.1},
    "constant_wrench": {"surge": 2.0, "yaw": 0.2},
    "linear_damping": {"surge": 10.0, "yaw": 0.2},
    "quadratic_damping": {"sway": 50.0, "roll": 0.3},
    "cubic_damping": {"surge": 100.0},
    "dry_friction": {"surge": 3.0, "yaw": 0.3},
    "coupled_damping": {"yaw_from_sway": 1.0, "sway_from_yaw_quadratic": 2.0},
    "added_mass": {"surge": 4.0, "yaw": 0.1},
    "added_mass_coupling": {"surge_pitch": 0.3, "sway_yaw": 0.2},
    "lift": {"coefficient": 30.0},
    "current": {"north": 0.1, "east": -0.07, "down": 0.02},
    "tether_tension": {"stiffness": 6.0, "slack_length": 0.5, "anchor_x": 3.0, "anchor_y": 1.0,
                       "anchor_z": 3.0},
    "tether_drag": {"coefficient": 8.0},
    "wall_proximity": {"gain": 3.0},
    "surface_proximity": {"gain": 3.0},
    "thruster_lag": {"time_constant": 0.2},
    "input_delay": {"delay": 0.13},
    "thruster_deadband": {"width": 0.1},
    "force_curve": {"exponent": 1.2},
    "thruster_gain": {"all": 0.8, "t3": 0.5},
    "thrust_asymmetry": {"ratio": 0.8},
    "voltage_sag": {"fraction": 0.2, "rate": 0.01},
    "advance_loss": {"coefficient": 0.5},
    "propeller_torque": {"ratio": 0.02},
    "fluid_memory": {"coefficient": 20.0, "time_constant": 0.8},
    "clock_drift": {"rate": -0.02},
}  # fmt: skip
SENSED = {
    "marker_offset": {"x": 0.1, "z": -0.05},
    "marker_misalignment": {"roll": 0.05, "yaw": -0.1},
    "world_tilt": {"roll": 0.03, "pitch": -0.02},
    "pose_filter": {"cutoff": 4.0},
}
CALM = {
    "rate": 100.0, "position_noise": 0.0, "attitude_noise": 0.0, "colour_noise": 0.0,
    "colour_attitude": 0.0, "colour_time": 0.5, "bursts_per_minute": 0.0, "longest_burst": 1,
    "outliers_per_minute": 0.0, "outlier_size": (0.1, 0.2),
}  # fmt: skip


def flown_independently(hidden):
    """States at every hundredth of a second under the sticks, by the second simulator."""
    thrusters = Thrusters(FILE, hidden, SECONDS)
    mover = Mover(read_constants(FILE, hidden), thrusters, hidden, TANK, tolerance=1e-9)
    commands = sticks(3, round(SECONDS / TICK))
    acts = np.array([thrusters.log(TICK * k)[1] for k in range(len(commands))])
    R = Rotation.from_quat(START[3:7], scalar_first=True).as_matrix()
    spun_up = thrusters.force(commands[0])
    now, states = Vehicle(START[:3], R, START[7:], spun_up, np.zeros(6)), []
    frames = np.linspace(0.0, SECONDS, round(100 * SECONDS) + 1)
    inside = acts[(acts > 1e-9) & (acts < SECONDS - 1e-9)]
    edges = np.unique(np.round(np.concatenate([[0.0, SECONDS], inside, frames[::5]]), 12))
    for a, b in pairwise(edges):
        k = max(int(np.searchsorted(acts, 0.5 * (a + b), side="right")) - 1, 0)
        wanted = np.minimum(frames[(frames > a + 1e-9) & (frames <= b + 1e-9)], b)
        now, seen = mover.carry(now, thrusters.force(commands[k]), np.zeros(6), (a, b), wanted)
        states += seen
    return states


def flown_by_the_engine(hidden):
    run = motion(sticks(3, round(SECONDS / TICK)), seconds=SECONDS, start=START, site=SITE)
    ((name, values),) = hidden.items() or [("net_buoyancy", {})]
    world = beside_others(built_in()[name](**values))
    settings = ReplaySettings(step=0.001)
    return simulate(world, run, [(0, len(run.time) - 1, START)], settings)[0][1:]


@pytest.mark.parametrize("name", ["nothing", *HIDDEN])
def test_both_simulators_move_alike(name):
    hidden = {name: HIDDEN[name]} if name in HIDDEN else {}
    ours, theirs = flown_independently(hidden), flown_by_the_engine(hidden)
    places = np.array([one.place for one in ours])
    turns = Rotation.from_matrix([one.R for one in ours])
    apart = turns.inv() * Rotation.from_quat(theirs[:, 3:7], scalar_first=True)
    speeds = np.array([one.velocity for one in ours])
    # the engine's commands act at its own steps of 1 ms, a drifting clock's between them; it
    # averages the force of a lag over each
    slack = {"clock_drift": 20.0, "thruster_lag": 3.0}.get(name, 1.0)
    np.testing.assert_allclose(places, theirs[:, :3], atol=1e-6 * slack)
    np.testing.assert_allclose(apart.as_rotvec(), 0.0, atol=1e-6 * slack)
    np.testing.assert_allclose(speeds, theirs[:, 7:], atol=5e-6 * slack)


def test_every_effect_that_is_stated_is_held_against_the_other():
    assert set(HIDDEN) | set(SENSED) == SIMULATED_EFFECTS
    assert set(built_in()) >= SIMULATED_EFFECTS


@pytest.mark.parametrize("name", SENSED)
def test_both_see_alike(name, tmp_path):
    """The second simulator's export, read, is what the model's motion capture reports."""
    world, states = model(built_in()[name](**SENSED[name])), flown_independently({})
    attitudes = Rotation.from_matrix([one.R for one in states])
    places = np.array([one.place for one in states])
    record_campaign(small(), tmp_path)
    hidden, random = {name: SENSED[name]}, np.random.default_rng(0)
    write_poses(tmp_path / "a_6D.tsv", places, attitudes, CALM, hidden, random)
    read = read_run(load_campaign(tmp_path), "a")[0]
    true = np.hstack([places, attitudes.as_quat(scalar_first=True), np.zeros((len(places), 6))])
    view = world.mocap_view
    shown = view.smooth(view.poses(true[:, :7]), 0.01)
    np.testing.assert_allclose(read.position, shown[:, :3], atol=2e-6)
    turn = log(multiply(conjugate(read.attitude), shown[:, 3:]))
    # one smooths along the geodesic, the other the components of the quaternion
    np.testing.assert_allclose(turn, 0.0, atol=1e-4 if name == "pose_filter" else 3e-6)


def small(**tank):
    runs = [{"id": "a", "control": "6dof", "split": "train"}]
    case = hiding("single", ("thruster_lag",), 0, "development")
    tank = {"duration": 2.0, "runs": runs, **tank}
    return case.model_copy(update={"tank": tank}).settings().model_dump()


def test_the_same_settings_give_the_same_bytes(tmp_path):
    for folder in ("one", "two"):
        record_campaign(small(), tmp_path / folder)
    names = sorted(p.name for p in (tmp_path / "one").iterdir())
    assert names == ["a_6D.tsv", "a_commands.csv", "campaign.yaml"]
    for name in names:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_cases_fly_in_either_and_leave_no_truth_behind(tmp_path):
    case = hiding("single", ("net_buoyancy",), 0, "development")
    case = case.model_copy(update={"tank": {"duration": 2.0, "runs": small()["runs"]}})
    assert fly(case, tmp_path / "a", "independent").hidden == case.hidden
    assert sorted(p.suffix for p in (tmp_path / "a").iterdir()) == [".csv", ".tsv", ".yaml"]


def test_most_cases_can_be_flown_by_the_second_simulator():
    cases = suite("standard", "development")
    stated = [case for case in cases if SIMULATORS["independent"].states(case)]
    assert len(stated) > 0.85 * len(cases)
    assert not any(case.outside for case in stated)
    assert all(SIMULATORS["tank"].states(case) for case in cases)


def test_the_command_chooses_who_flies():
    chosen = compose(["command=blind", "blind.simulator=independent"])
    assert select(chosen, Settings).blind.simulator in SIMULATORS
    assert select(compose(["command=blind"]), Settings).blind.simulator == "tank"
