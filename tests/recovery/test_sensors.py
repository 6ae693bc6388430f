"""What sensors on board report becomes the motion that it was, and names what is hidden."""

import numpy as np
import pytest

from rovsim.application.configuration import compose
from rovsim.application.pipeline.measured_campaign import measure, open_campaign
from rovsim.application.pipeline.models import load_one_model
from rovsim.application.settings import select
from rovsim.core.errors import BadInput
from rovsim.core.rotations import conjugate, log, multiply
from rovsim.core.schema import checked
from rovsim.diagnosis.campaign_diagnosis import diagnose_campaign
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.channels import Channel
from rovsim.measurement.signals.chosen_channels import noise_density
from rovsim.measurement.signals.on_clock import OnClock, instants_between
from rovsim.measurement.signals.resample import Linear
from rovsim.measurement.signals.track import track_channels
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings

EXACT = {"position": {"rate": 100, "noise": 0}, "attitude": {"rate": 100, "noise": 0}}
RUN = {"id": "one", "control": "6dof", "split": "train"}


def tracked(folder, sensors, **tank):
    """Poses of one run of a tank, seen by these sensors."""
    content = {"runs": [RUN], "duration": 20.0, "sensors": sensors, **tank}
    make_campaign(checked(TankSettings, content, "tank"), folder, built_in())
    recording, _ = read_run(open_campaign(str(folder)), "one")
    return track_channels(recording, Linear())


@pytest.fixture(scope="module")
def truth(tmp_path_factory):
    return tracked(tmp_path_factory.mktemp("truth") / "raw", EXACT)


PERFECT = {
    "a Doppler log off the origin, late": {
        "velocity": {"rate": 10, "noise": 0, "at": [0.3, -0.1, 0.2], "delay": 0.1},
        "attitude": {"rate": 25, "noise": 0},
    },
    "rates, and attitudes twice a second": {
        "position": {"rate": 20, "noise": 0},
        "attitude": {"rate": 2, "noise": 0},
        "rates": {"rate": 100, "noise": 0},
    },
    "a depth off the origin": {
        "position": {"rate": 20, "noise": 1e-3},
        "attitude": {"rate": 20, "noise": 0},
        "depth": {"rate": 20, "noise": 0, "at": [0.5, 0.0, -0.1]},
    },
}


@pytest.mark.parametrize("sensors", PERFECT.values(), ids=PERFECT)
def test_perfect_sensors_tell_the_motion_wherever_they_sit(tmp_path, truth, sensors):
    found = tracked(tmp_path / "raw", sensors)
    place = np.stack([np.interp(found.time, truth.time, own) for own in truth.eta.T], axis=1)
    apart = found.eta[:, :3] - place[:, :3]
    if "position" not in sensors:  # where it started is not known
        apart -= apart[0]
    turned = log(multiply(conjugate(place[:, 3:]), found.eta[:, 3:]))
    assert np.abs(apart[found.usable]).max() < 0.006
    assert np.abs(turned[found.usable]).max() < 0.006
    assert found.measured.axes.all()


@pytest.mark.parametrize("steps", [0, 40])
def test_the_noise_of_a_channel_is_not_that_of_its_motion(steps):
    """Sticks that are stepped turn a vehicle at once; its gyro is not noisier for that."""
    rng, time = np.random.default_rng(4), 0.02 * np.arange(3000)
    value = rng.normal(0.0, 0.003, (3000, 3))
    for at in rng.integers(0, 3000, steps):
        value[at:] += rng.normal(0.0, 0.2, 3)
    assert noise_density(Channel(time, value)) * np.sqrt(50.0) == pytest.approx(0.003, rel=0.08)


def test_sums_between_readings_have_white_noise():
    random = np.random.default_rng(3)
    time = 0.1 + np.arange(4000) / 5.0
    clock = OnClock(np.arange(0.0, 800.0, 0.02), 0.5)
    total = clock.sum_up(time, random.normal(size=(4000, 1)))[:, 0]
    steps = np.diff(total[clock.nearest(instants_between(time)[1:-1])])
    assert steps.std() == pytest.approx(0.2, rel=0.06)  # 1 over 0.2 s each
    for lag in (1, 2, 3):
        assert abs(np.mean(steps[lag:] * steps[:-lag])) < 0.08 * steps.var()


def test_a_sum_is_held_by_what_is_read_beside_it():
    """Between the two ways of being wrong, and better than either; also at the ends."""
    random = np.random.default_rng(0)
    time = np.arange(3000) / 10.0
    clock = OnClock(time, 0.5)
    rate, direct = 0.05 * random.normal(size=(3000, 1)), 0.5 * random.normal(size=(3000, 1))
    total = clock.sum_up(time, rate)
    drift = clock.drift(direct - total, Channel(time, rate), Channel(time, direct))
    held, ends = total + drift, np.r_[:100, -100:0]
    assert held.std() < 0.5 * min(total.std(), direct.std())
    assert np.abs(held[ends]).max() < direct.std()


def test_two_readings_beside_a_sum_hold_it():
    time = np.arange(200) / 10.0
    clock, two = OnClock(time, 0.5), np.array([5.0, 15.0])
    rate, direct = Channel(time, np.zeros((200, 1))), Channel(two, np.array([[1.0], [2.0]]))
    found = clock.drift(direct.value, rate, direct)[:, 0]
    np.testing.assert_allclose(np.interp(two, time, found), [1.0, 2.0], atol=0.1)


def test_what_is_let_go_is_not_commanded_and_comes_to_rest(tmp_path):
    release = {"pose": [0, 0, 0, 0.3, 0, 0], "velocity": [0.2, 0, 0, 0, 0, 0]}
    still = {"force": 0.0, "moment": 0.0}
    content = {"runs": [RUN | {"release": release}], "duration": 8.0, "turbulence": still}
    make_campaign(checked(TankSettings, content, "tank"), tmp_path / "raw", built_in())
    campaign = open_campaign(str(tmp_path / "raw"))
    motion = measure(campaign, compose([]).signals).motions["one"]
    assert not len(motion.commands.time)
    roll = 2.0 * motion.eta[motion.usable, 4]
    assert abs(roll[0]) > 0.2
    assert np.abs(roll[-100:]).max() < 0.25 * abs(roll[0])
    assert motion.nu[motion.usable][0, 0] > 0.1


def test_a_place_is_refused_where_it_means_nothing(tmp_path):
    with pytest.raises(BadInput, match="rates has no place"):
        tracked(tmp_path / "raw", {"rates": {"rate": 50, "noise": 0, "at": [1, 0, 0]}})


@pytest.mark.thorough
def test_a_weight_is_named_by_depth_and_attitude_alone(tmp_path):
    """Sensors of a vehicle without a motion capture; nothing is said of surge and sway."""
    runs = [
        {**RUN, "id": k, "split": s} for k, s in (("a", "train"), ("b", "train"), ("c", "test"))
    ]
    effect = {"effect": "net_buoyancy", "parameters": {"force": {"value": 3.0}}}
    sensors = {"depth": {"rate": 3, "noise": 0.01}, "attitude": {"rate": 10, "noise": 0.003}}
    content = {"runs": runs, "duration": 45.0, "seed": 11, "effects": [effect], "sensors": sensors}
    make_campaign(checked(TankSettings, content, "tank"), tmp_path / "raw", built_in())
    settings = compose([f"campaign={tmp_path / 'raw'}"])
    data = measure(open_campaign(settings.campaign), settings.signals)
    base = load_one_model("nominal", data.vehicle, built_in())
    asked = select(settings, DiagnosisSettings)
    answer = diagnose_campaign(data.runs, {}, base, asked, built_in())
    found, where = answer.diagnosis, answer.where.models["nominal"]
    assert [one.effect for one in found.selected] == ["net_buoyancy"]
    value = found.selected[0].parameters["force"]
    assert abs(value.value - 3.0) < 4.0 * value.std
    assert found.not_measured == ("surge", "sway")
    assert found.ladder.steps[0].acceleration_rmse.surge is None
    assert where.error["surge"].rms is None
    assert not where.axes["surge"]
    searched = set(where.axes["heave"])
    assert {"heave speed", "pitch angle"} <= searched
    assert not searched & {"surge speed", "absolute sway speed", "MoCap x", "MoCap y"}
