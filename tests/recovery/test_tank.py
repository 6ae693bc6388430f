"""The tank hides a truth in raw exports; reading and replaying them must give it back."""

from pathlib import Path

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.core.rotations import log, multiply
from rovsim.core.schema import checked
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.current import CurrentDrift
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle, vehicle_file
from rovsim.evaluation.error_metrics import rms, subtract
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.quality.assessment import report_quality
from rovsim.measurement.recording import read_run
from rovsim.measurement.signals.chain import SignalSettings, clean
from rovsim.simulation.replay import replay
from rovsim.simulation.settings import SimulationSettings
from rovsim.simulation.synthetic_tank.campaign import make_campaign, true_model
from rovsim.simulation.synthetic_tank.description import TRUTH_FILE, describe_campaign
from rovsim.simulation.synthetic_tank.settings import Camera, Log, TankRun, TankSettings, Turbulence

RUN = TankRun(id="6dof-1", control="6dof", split="test")
LAG = EffectEntry(effect="thruster_lag", parameters={"time_constant": 0.2})
DRAG = EffectEntry(effect="quadratic_damping", parameters={"sway": 90.0})
TETHER = EffectEntry(
    effect="tether_tension",
    parameters={
        "stiffness": 3.0,
        "slack_length": 0.5,
        "anchor_x": 5,
        "anchor_y": 2.5,
        "anchor_z": 3,
    },
)
# What a perfect model scores here (test below); independent exports of this kind gave 0.009, 0.028.
FLOOR = np.array([0.013] * 3 + [0.035] * 3)


def recorded(tmp_path, **settings):
    """Settings, campaign and cleaned motion of one 30 s run."""
    chosen = TankSettings(**{"runs": (RUN,), "duration": 30.0, **settings})
    make_campaign(chosen, tmp_path / "raw", built_in())
    campaign = load_campaign(tmp_path / "raw")
    recording, anomalies = read_run(campaign, RUN.id)
    return chosen, recording, anomalies, clean(recording, SignalSettings())


def window_error(model, motion):
    found = replay(model, motion, SimulationSettings())
    return rms(subtract(motion, found.horizons["2"]).nu)


@pytest.mark.parametrize("seed", [11, 12])
def test_the_nominal_model_explains_an_empty_tank(tmp_path, seed):
    chosen, _, _, motion = recorded(tmp_path, seed=seed)
    assert np.all(window_error(true_model(chosen, built_in()), motion) < FLOOR)


def test_frames_and_commands_that_share_few_instants_change_no_physics(tmp_path):
    """120 frames and 50 commands a second ask for other steps than 1 ms."""
    _, _, _, motion = recorded(tmp_path, seed=11, camera=Camera(rate=120.0))
    assert (window_error(nominal(load_vehicle(default_vehicle())), motion) < FLOOR).all()


def entry(effect, **parameters):
    return EffectEntry(effect=effect, parameters=parameters)


NEW = [
    entry("coupled_damping", yaw_from_sway=8.0, pitch_from_surge_quadratic=15.0),
    entry("added_mass_coupling", surge_pitch=1.0, sway_yaw=1.0),
    entry("tether_drag", coefficient=30.0),
    entry("wall_proximity", gain=4.0, length_scale=2.0),
    entry("surface_proximity", gain=3.0, length_scale=2.0),
    entry("marker_offset", x=0.2, y=-0.1, z=0.15),
    entry("marker_misalignment", roll=0.1, pitch=-0.1, yaw=0.3),
    entry("world_tilt", roll=0.15, pitch=-0.15),
    entry("fluid_memory", coefficient=25.0, time_constant=0.7),
    entry("clock_drift", rate=0.006),
    entry("clock_drift", rate=-0.006),
    entry("input_delay", delay=-0.15),
    entry("pose_filter", cutoff=2.0),
]


@pytest.mark.parametrize(
    "hidden",
    [(LAG,), (DRAG,), (TETHER,), (LAG, DRAG), *((one,) for one in NEW)],
    ids=lambda hidden: "+".join(one.effect for one in hidden),
)
def test_a_hidden_effect_is_seen_and_the_true_model_explains_it(tmp_path, hidden):
    """Two integrators, one at 1 ms with streamed thrusters: they must agree."""
    chosen, _, _, motion = recorded(tmp_path, seed=5, effects=hidden)
    truth = true_model(chosen, built_in())
    with_it, without = window_error(truth, motion), window_error(nominal(truth.vehicle), motion)
    assert np.all(with_it < FLOOR)
    assert np.max(without / FLOOR) > 1.5


LOOPS = {"gain_yaw": 1.5, "bandwidth_yaw": 2.0}
for axis in ("roll", "pitch"):
    LOOPS |= {f"gain_{axis}": 0.6, f"bandwidth_{axis}": 3.0}


@pytest.mark.parametrize("attitude", [0.0, 1.0])
def test_a_loop_on_board_is_seen_in_logged_demands(tmp_path, attitude):
    loops = EffectEntry(effect="onboard_control", parameters=LOOPS | {"attitude": attitude})
    logged = Log(kind="demand")
    with pytest.raises(BadInput, match="this log holds none"):
        recorded(tmp_path, seed=5, effects=(loops,))
    chosen, _, _, motion = recorded(tmp_path, seed=5, effects=(loops,), log=logged)
    truth = true_model(chosen, built_in())
    assert motion.commands.kind == "demand"
    assert np.all(window_error(truth, motion) < FLOOR)
    assert np.max(window_error(nominal(truth.vehicle), motion) / FLOOR) > 1.5


def test_logged_demands_drive_an_empty_tank_too(tmp_path):
    chosen, _, _, motion = recorded(tmp_path, seed=6, log=Log(kind="demand"))
    assert np.all(window_error(true_model(chosen, built_in()), motion) < FLOOR)


def test_the_exports_hold_the_stated_noise_and_faults(tmp_path):
    camera = Camera(bursts_per_minute=10, outliers_per_minute=10)
    _, recording, anomalies, _ = recorded(tmp_path, seed=3, camera=camera)
    report = report_quality(recording, anomalies, SignalSettings().outliers)
    assert report.frames == 3000
    assert 1 <= report.outliers <= 15
    assert report.not_found > 0
    noise = report.noise
    assert noise.position_m == pytest.approx(camera.position_noise, rel=0.1)
    assert noise.attitude_rad == pytest.approx(camera.attitude_noise, rel=0.1)
    assert all(axis.excited for axis in report.excitation.values())


def test_a_drifting_current_is_a_random_walk_of_the_water_alone(tmp_path):
    walks = [
        CurrentDrift(rate=0.02).draw(500, 0.04, np.random.default_rng(k))[-1] for k in range(200)
    ]
    expected = [0.02 * np.sqrt(20.0)] * 2 + [0.0]
    assert np.std(walks, axis=0) == pytest.approx(expected, rel=0.15)
    hidden = (entry("current_drift", rate=0.02),)
    still, drifting = (
        recorded(tmp_path / str(len(effects)), seed=3, effects=effects)[1]
        for effects in ((), hidden)
    )
    assert np.array_equal(still.tracked, drifting.tracked)  # what else is drawn stays the same
    apart = np.linalg.norm(drifting.position - still.position, axis=1)[still.tracked]
    assert apart[:50].max() < 0.01
    assert apart.max() > 0.05


def test_coloured_errors_last_and_leave_the_white_ones_alone(tmp_path):
    colour = Camera(colour_noise=0.02, colour_attitude=0.05, colour_time=0.5)
    plain, coloured = (
        recorded(tmp_path / name, seed=3, camera=camera)[1]
        for name, camera in (("plain", Camera()), ("coloured", colour))
    )
    seen = plain.tracked & coloured.tracked
    assert np.array_equal(plain.tracked, coloured.tracked)  # the same frames are lost
    shift = (coloured.position - plain.position)[seen]
    turn = log(multiply(plain.attitude * [1, -1, -1, -1], coloured.attitude))[seen]
    for error, size in ((shift, colour.colour_noise), (turn, colour.colour_attitude)):
        assert error.std() == pytest.approx(size, rel=0.3)  # 60 time constants of three axes
        lasts = np.mean(error[25:] * error[:-25]) / np.mean(error**2)
        assert lasts == pytest.approx(np.exp(-0.5), abs=0.2)


def test_without_noise_the_measured_velocity_is_the_true_one(tmp_path):
    still = Camera(position_noise=0, attitude_noise=0, bursts_per_minute=0, outliers_per_minute=0)
    calm = Turbulence(force=0, moment=0)
    chosen, _, _, motion = recorded(tmp_path, seed=4, camera=still, turbulence=calm)
    # what is left: rounding of the export (1 um, 1e-6) and the filter's bias on fast motion
    assert np.all(window_error(true_model(chosen, built_in()), motion) < [0.004] * 3 + [0.02] * 3)


def test_same_seed_same_bytes_and_runs_do_not_depend_on_each_other(tmp_path):
    two = (RUN, TankRun(id="3dof-1", control="3dof", split="train"))
    for name, runs in (("a", two), ("b", two)):
        make_campaign(TankSettings(runs=runs, duration=4.0, seed=9), tmp_path / name, built_in())
    for file in sorted(path.name for path in (tmp_path / "a").iterdir()):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()
    names = {run.mocap for run in describe_campaign(TankSettings(runs=two)).runs}
    assert names <= {path.name for path in (tmp_path / "a").iterdir()}


def test_a_vehicle_of_the_users_goes_along(tmp_path, monkeypatch):
    own = vehicle_file(default_vehicle()).read_text().replace("mass: 13.5", "mass: 14.5")
    (tmp_path / "mine.yaml").write_text(own)
    monkeypatch.chdir(tmp_path)
    flown = TankSettings(vehicle="mine.yaml", runs=(RUN,), duration=2.0)
    make_campaign(flown, tmp_path / "deep" / "raw", built_in())
    campaign = load_campaign(tmp_path / "deep" / "raw")
    flown_with = load_vehicle(campaign.vehicle, named_in=campaign.file)
    assert nominal(flown_with).body.M_RB[0, 0] == 14.5


def test_the_vehicle_stays_inside(tmp_path):
    for seed in range(4):
        recorded(tmp_path, seed=seed, duration=20.0)  # refuses when it does not


def test_nothing_of_the_users_is_overwritten(tmp_path):
    (tmp_path / "raw").mkdir()
    (tmp_path / "raw" / "thesis.tex").write_text("years of work")
    with pytest.raises(BadInput, match="no tank wrote"):
        make_campaign(TankSettings(duration=2.0), tmp_path / "raw", built_in())
    assert (tmp_path / "raw" / "thesis.tex").exists()


def test_a_tank_made_again_replaces_its_recordings_and_nothing_else(tmp_path, monkeypatch):
    old = RUN.model_copy(update={"id": "old"})
    make_campaign(TankSettings(runs=(old,), duration=2.0), tmp_path / "raw", built_in())
    (tmp_path / "raw" / "notes.md").write_text("years of work")
    monkeypatch.chdir(tmp_path / "raw")
    make_campaign(TankSettings(runs=(RUN,), duration=2.0), Path("."), built_in())
    names = {"6dof-1_6D.tsv", "6dof-1_commands.csv", "campaign.yaml", "notes.md", TRUTH_FILE}
    assert {path.name for path in (tmp_path / "raw").iterdir()} == names
    assert list(tmp_path.iterdir()) == [tmp_path / "raw"]
    assert load_campaign(tmp_path / "raw").runs[0].id == "6dof-1"


@pytest.mark.parametrize(("rate", "log", "step"), [(120.0, 50.0, 0.001), (100.0, 50.0, 0.02)])
def test_frames_and_commands_come_at_their_rates(tmp_path, rate, log, step):
    camera, still = Camera(rate=rate, bursts_per_minute=0.0), Log(rate=log, missing=0.0)
    _, recording, *_ = recorded(tmp_path, camera=camera, log=still, step=step, duration=3.0)
    assert np.diff(recording.time) == pytest.approx(1.0 / rate, abs=2e-5)
    assert np.diff(recording.commands.time) == pytest.approx(1.0 / log, abs=2e-4)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"camera": {"rate": 29.97}}, "small common multiple"),
        ({"runs": [RUN.model_dump(), RUN.model_dump()]}, "different id"),
        ({"runs": [RUN.model_dump() | {"id": "../x"}]}, "file name"),
    ],
)
def test_what_no_campaign_can_hold_is_refused_before_a_flight(tmp_path, change, said, monkeypatch):
    monkeypatch.setattr("rovsim.simulation.synthetic_tank.campaign.fly_run", None)
    with pytest.raises(BadInput, match=said):
        make_campaign(checked(TankSettings, change, "tank"), tmp_path / "raw", built_in())
    assert list(tmp_path.iterdir()) == []


def test_a_vehicle_that_is_swept_away_is_an_error_and_leaves_nothing(tmp_path):
    strong = EffectEntry(effect="net_buoyancy", parameters={"force": 200.0})
    with pytest.raises(BadInput, match="left the tank"):
        make_campaign(TankSettings(effects=(strong,)), tmp_path / "raw", built_in())
    assert list(tmp_path.iterdir()) == []


def test_the_truth_is_sealed(tmp_path):
    """Reading a campaign works without the truth file, so it cannot depend on it."""
    make_campaign(
        TankSettings(runs=(RUN,), duration=4.0, effects=(LAG,)), tmp_path / "raw", built_in()
    )
    (tmp_path / "raw" / TRUTH_FILE).unlink()
    read_run(load_campaign(tmp_path / "raw"), RUN.id)
