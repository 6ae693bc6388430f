"""ROS 2 bags: poses, channels and commands of every kind, by whose clock, and the real ones."""

import os
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from bags import (
    ODOMETRY,
    OWN,
    START,
    message,
    poses,
    without_definitions,
    write_bag,
)
from damage import read_damaged
from recordings import Swim, campaign_content, write_campaign
from rovsim.core import extras
from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler, matrix
from rovsim.measurement.campaign_file import CommandLog, Mocap
from rovsim.measurement.recording.formats.rosbag2.commands import read_commands
from rovsim.measurement.recording.formats.rosbag2.motion import read_bag

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("ROVSIM_DATA", ROOT / ".." / "shared" / "data")) / "rosbag2"
TANK, OTHER = (DATA / f"rosbag2_2025_05_{day}_0.db3" for day in ("27-12_53_06", "14-15_59_00"))
real = pytest.mark.skipif(not DATA.is_dir(), reason="no bags of the KTH tank ($ROVSIM_DATA)")
SWIM = Swim.ned(200)
BODY = "/mocap/rov"


def mocap(**keys):
    return Mocap(**{"format": "rosbag2", "world_axes": "z_up", "body_axes": "flu", **keys})


def log(**keys):
    return CommandLog(**{"format": "rosbag2", "kind": "pwm", **keys})


def series(kind, fields, count=20, step=0.1, stamped=True):
    """Messages `fields(k)` of a type, every `step` s."""
    times = START + step * np.arange(count)
    return kind, [
        (t, message(kind, t if stamped else None, **fields(k))) for k, t in enumerate(times)
    ]


@pytest.mark.parametrize("storage", ["SQLITE3", "MCAP"])
@pytest.mark.parametrize(
    "kind",
    ["geometry_msgs/msg/PoseStamped", ODOMETRY, "geometry_msgs/msg/PoseWithCovarianceStamped"],
)
def test_the_only_topic_of_poses_is_read(tmp_path, storage, kind):
    given = poses(SWIM, ODOMETRY)[1] if kind != "geometry_msgs/msg/PoseStamped" else None
    if given is None:
        topic = poses(SWIM)
    else:
        topic = kind, [(t, message(kind, t, pose__pose=m.pose.pose)) for t, m in given]
    bag = write_bag(tmp_path / "bag", {BODY: topic}, storage)
    for path in (bag, next(bag.glob("bag.*"))):
        export = read_bag(path, mocap())
        np.testing.assert_allclose(export.time - START, SWIM.time, atol=1e-6)
        np.testing.assert_allclose(export.position, SWIM.position)
        np.testing.assert_allclose(matrix(export.attitude), SWIM.rotation, atol=1e-9)
        assert export.tracked.all()
        assert export.notes == ()


@pytest.mark.parametrize("storage", ["SQLITE3", "MCAP"])
@pytest.mark.parametrize("compression", ["MESSAGE", "FILE", "STORAGE"])
def test_compressed_bags_are_read(tmp_path, storage, compression):
    if (storage, compression) == ("SQLITE3", "STORAGE"):
        pytest.skip("sqlite3 has no compression of its own")
    bag = write_bag(tmp_path / "bag", {BODY: poses(SWIM)}, storage, compression)
    np.testing.assert_allclose(read_bag(bag, mocap()).position, SWIM.position)


def test_a_transform_is_a_pose_and_a_quaternion_of_zeros_is_none(tmp_path):
    kind = "geometry_msgs/msg/TransformStamped"

    def fields(k):
        return {"transform__translation__x": float(k), "transform__rotation__w": float(k != 3)}

    export = read_bag(write_bag(tmp_path / "bag", {BODY: series(kind, fields)}), mocap())
    np.testing.assert_array_equal(export.position[:, 0], np.arange(20))
    assert np.flatnonzero(~export.tracked).tolist() == [3]


def test_the_campaign_chooses_among_topics(tmp_path):
    other = Swim(SWIM.time, SWIM.position + 1.0, SWIM.rotation)
    bag = write_bag(tmp_path / "bag", {BODY: poses(SWIM), "/mocap/boat": poses(other)})
    with pytest.raises(BadInput, match=r"2 topics of poses: /mocap/rov, /mocap/boat"):
        read_bag(bag, mocap())
    for keys in ({"body": "/mocap/boat"}, {"topics": {"pose": "/mocap/boat"}}):
        np.testing.assert_allclose(read_bag(bag, mocap(**keys)).position, other.position)
    with pytest.raises(BadInput, match=r"no messages of the topic '/mocap/bot'.*'/mocap/boat'"):
        read_bag(bag, mocap(body="/mocap/bot"))


def test_stamps_of_another_clock_are_shifted_and_that_is_said(tmp_path):
    same = read_bag(write_bag(tmp_path / "a", {BODY: poses(SWIM, late=0.02)}), mocap())
    np.testing.assert_allclose(same.time - START, SWIM.time, atol=1e-6)  # transport is no clock
    other = read_bag(write_bag(tmp_path / "b", {BODY: poses(SWIM, late=6741.0)}), mocap())
    np.testing.assert_allclose(other.time - START - 6741.0, SWIM.time, atol=1e-6)
    assert "−6741.000 s from the bag's clock" in other.notes[0]


def test_stamps_that_stand_or_jump_are_not_believed(tmp_path):
    kind, messages = poses(SWIM)
    for _, content in messages[100:]:
        content.header.stamp.sec -= 5
    export = read_bag(write_bag(tmp_path / "a", {BODY: (kind, messages)}), mocap())
    np.testing.assert_allclose(export.time - START, SWIM.time, atol=1e-6)
    assert "the bag's times hold" in export.notes[0]
    export = read_bag(write_bag(tmp_path / "b", {BODY: poses(SWIM, stamped=False)}), mocap())
    np.testing.assert_allclose(export.time - START, SWIM.time, atol=1e-6)


def sensors():
    """Topics of an inertial unit, a pressure, a Doppler log and a battery."""
    imu = "sensor_msgs/msg/Imu"
    unknown = np.array([-1.0] + [0.0] * 8)
    level = {"linear_acceleration__z": 9.8, "orientation__w": 1.0}
    return {
        "/imu": series(imu, lambda k: {"angular_velocity__z": 0.1 * k, **level}, step=0.01),
        "/raw": series(imu, lambda k: {"orientation_covariance": unknown}),
        "/pressure": series(
            "sensor_msgs/msg/FluidPressure", lambda k: {"fluid_pressure": 101325.0 + 9806.65 * k}
        ),
        "/depth": series("std_msgs/msg/Float64", lambda k: {"data": 2.0 + k}, stamped=False),
        "/dvl": series(
            "geometry_msgs/msg/TwistStamped", lambda k: {"twist__linear__y": 0.5}, step=0.2
        ),
        "/battery": series("sensor_msgs/msg/BatteryState", lambda k: {"voltage": 16.5}),
    }


def test_topics_become_channels_without_any_pose(tmp_path):
    bag = write_bag(tmp_path / "bag", sensors())
    topics = {"imu": "/imu", "depth": "/pressure", "velocity": "/dvl", "battery": "/battery"}
    export = read_bag(bag, mocap(topics=topics))
    assert not len(export.time)
    assert set(export.channels) == {
        "attitude",
        "rates",
        "specific_force",
        "depth",
        "velocity",
        "voltage",
    }
    np.testing.assert_allclose(export.channels["depth"].value[:, 0], np.arange(20))
    np.testing.assert_allclose(export.channels["rates"].value[:, 2], 0.1 * np.arange(20))
    np.testing.assert_array_equal(export.channels["specific_force"].value[0], [0, 0, 9.8])
    assert export.channels["rates"].rate == pytest.approx(100.0, rel=1e-4)
    np.testing.assert_array_equal(export.channels["velocity"].value[0], [0, 0.5, 0])
    export = read_bag(bag, mocap(topics={"imu": "/raw", "depth": "/depth"}))
    assert not len(export.channels["attitude"].time)
    np.testing.assert_allclose(export.channels["depth"].value[:, 0], 2 + np.arange(20))


def test_an_attitude_by_itself_is_a_quaternion_or_three_angles(tmp_path):
    angles = [0.1, -0.2, 0.3]
    vector = dict(zip("xyz", angles, strict=True))
    w, x, y, z = from_euler(*np.array(angles))
    quaternion = {f"quaternion__{n}": float(v) for n, v in zip("wxyz", (w, x, y, z), strict=True)}
    bag = write_bag(
        tmp_path / "bag",
        {
            "/euler": series("geometry_msgs/msg/Vector3", lambda k: vector, stamped=False),
            "/turn": series("geometry_msgs/msg/QuaternionStamped", lambda k: quaternion),
            **sensors(),
        },
    )
    for topic in ("/euler", "/turn"):
        export = read_bag(bag, mocap(topics={"attitude": topic, "imu": "/imu"}))
        np.testing.assert_allclose(export.channels["attitude"].value, [[w, x, y, z]] * 20)
    with pytest.raises(BadInput, match=r"/depth.*Float64.*an attitude"):
        read_bag(bag, mocap(topics={"attitude": "/depth"}))


def test_pressures_take_the_density_of_the_water(tmp_path):
    bag = write_bag(tmp_path / "bag", sensors())
    keys = {"water_density": 1025.0, "surface_pressure": 101325.0 - 9806.65}
    export = read_bag(bag, mocap(topics={"depth": "/pressure"}, sensors=keys))
    np.testing.assert_allclose(export.channels["depth"].value[:2, 0], [1 / 1.025, 2 / 1.025])


def test_channels_stand_beside_poses(tmp_path):
    bag = write_bag(tmp_path / "bag", {BODY: poses(SWIM), **sensors()})
    export = read_bag(bag, mocap(body=BODY, topics={"imu": "/imu"}))
    assert export.tracked.all()
    assert set(export.channels) == {"rates", "specific_force"}
    with pytest.raises(BadInput, match=r"/pressure.*FluidPressure.*a velocity"):
        read_bag(bag, mocap(topics={"velocity": "/pressure"}))


def array(kind, rows):
    data = [np.array(row, dtype=np.float64) for row in rows]
    return series(kind, lambda k: {"data": data[k]}, count=len(data), stamped=False)


def test_commands_in_arrays_by_number_place_and_order(tmp_path):
    rows = [[0.1, 0.2, -0.3], [0.4, 0.5, 0.6]]
    bag = write_bag(tmp_path / "bag", {"/thrust": array("std_msgs/msg/Float64MultiArray", rows)})
    for columns in (["t1", "t2", "t3"], ["data[0]", "data[1]", "data[2]"], ["port", "star", "up"]):
        export = read_commands(bag, log(kind="normalized", columns=columns))
        np.testing.assert_allclose(export.value, rows)
        np.testing.assert_allclose(export.time - START, [0.0, 0.1], atol=1e-6)
    export = read_commands(bag, log(kind="normalized", columns=["t3", "-t1"]))
    np.testing.assert_allclose(export.value, [[-0.3, -0.1], [0.6, -0.4]])
    export = read_commands(
        bag, log(kind="demand", columns=["data[1]", "-data[0]"], axes=["yaw", "heave"])
    )
    np.testing.assert_allclose(export.value[0], [0, 0, -0.1, 0, 0, 0.2])


def channels(kind, rows):
    return series(
        kind,
        lambda k: {"channels": np.array(rows[k], np.uint16)},
        count=len(rows),
        stamped=kind.endswith(("Out", "RCIn")) and "Override" not in kind,
    )


def test_pulses_of_mavros(tmp_path):
    bag = write_bag(
        tmp_path / "bag",
        {
            "/mavros/rc/out": channels(
                "mavros_msgs/msg/RCOut", [[1500, 1900, 0], [1100, 1700, 1500]]
            ),
            "/mavros/rc/override": channels(
                "mavros_msgs/msg/OverrideRCIn",
                [[1500, 65535, *[0] * 16], [1600, 1500, *[0] * 16], [1700, 1700, *[0] * 16]],
            ),
        },
    )
    with pytest.raises(BadInput, match=r"2 topics that look like commands"):
        read_commands(bag, log(columns=["t1"]))
    out = read_commands(bag, log(columns=["t1", "t2", "t3"], topic="/mavros/rc/out"))
    np.testing.assert_allclose(out.value, [[0, 1, 0], [-1, 0.5, 0]])
    assert "1 outputs without a pulse" in out.notes[0]
    demand = log(
        kind="demand", columns=["RC1", "RC2"], axes=["surge", "yaw"], topic="/mavros/rc/override"
    )
    given = read_commands(bag, demand)
    np.testing.assert_allclose(given.value[:, [0, 5]], [[0.25, 0.0], [0.5, 0.5]])
    assert given.repairs.dropped == 1  # its second channel was not overridden
    silent = read_commands(bag, log(columns=["RC9"], topic="/mavros/rc/override"))
    assert silent.repairs.dropped == 3


def test_joysticks_and_wrenches(tmp_path):
    manual = "mavros_msgs/msg/ManualControl"
    wrench = "geometry_msgs/msg/WrenchStamped"
    bag = write_bag(
        tmp_path / "bag",
        {
            "/stick": series(manual, lambda k: {"x": 500.0, "y": -100.0, "z": 250.0, "r": 1000.0}),
            "/force": series(
                wrench, lambda k: {"wrench__force__x": 12.0, "wrench__torque__z": -3.0}
            ),
        },
    )
    axes = ["surge", "sway", "heave", "yaw"]
    stick = read_commands(bag, log(kind="demand", columns=axes, topic="/stick"))
    np.testing.assert_allclose(stick.value[0], [0.5, -0.1, 0.5, 0, 0, 1.0])
    force = read_commands(bag, log(kind="wrench", columns=["surge", "yaw"], topic="/force"))
    np.testing.assert_allclose(force.value[0], [12, 0, 0, 0, 0, -3])


@pytest.mark.parametrize("storage", ["SQLITE3", "MCAP"])
def test_a_type_that_the_bag_defines_is_read_by_its_fields(tmp_path, storage):
    own = series(OWN, lambda k: {"port": 0.5, "pods": np.array([0.1, -0.2])})
    bag = write_bag(tmp_path / "bag", {"/pods": own}, storage)
    columns = ["port", "pods[1]"]
    export = read_commands(bag, log(kind="normalized", columns=columns, topic="/pods"))
    np.testing.assert_allclose(export.value[0], [0.5, -0.2])
    text = series("std_msgs/msg/String", lambda k: {"data": "x"}, stamped=False)
    with pytest.raises(BadInput, match=r"no value for the column '7' in std_msgs"):
        read_commands(write_bag(tmp_path / "b", {"/say": text}), log(columns=["7"], topic="/say"))


def test_bags_of_humble_hold_no_definitions(tmp_path):
    pulses = channels("mavros_msgs/msg/RCOut", [[1500], [1900]])
    own = series(OWN, lambda k: {"port": 0.5})
    topics = {BODY: poses(SWIM), "/out": pulses, "/own": own}
    file = without_definitions(write_bag(tmp_path / "bag", topics))
    for path in (file, file.parent):
        np.testing.assert_allclose(read_bag(path, mocap()).position, SWIM.position)
        np.testing.assert_allclose(read_commands(path, log(columns=["t1"])).value, [[0], [1]])
    with pytest.raises(BadInput, match=r"tank_msgs/msg/Thrust, which the bag does not define"):
        read_commands(file, log(columns=["t1"], topic="/own"))


BAD = {
    "an empty file": ("bag.db3", b"", ["bag.db3", "whole ROS 2 bag"]),
    "another file": ("bag.db3", b"PK\x03\x04" * 500, ["not a database", "ros2 bag info"]),
    "an empty mcap": ("bag.mcap", b"", ["bag.mcap", "mcap recover"]),
    "a ROS 1 bag": ("bag.bag", b"#ROSBAG V2.0\n", ["ends in '.bag'", "rosbags-convert"]),
    "a folder": ("notes.txt", b"", ["without metadata.yaml and with 0", "ros2 bag reindex"]),
}


@pytest.mark.parametrize("what", BAD)
def test_what_is_no_bag_is_refused_in_words(tmp_path, what):
    name, raw, words = BAD[what]
    (tmp_path / name).write_bytes(raw)
    with pytest.raises(BadInput) as refusal:
        read_bag(tmp_path if what == "a folder" else tmp_path / name, mocap())
    for word in words:
        assert word in str(refusal.value)


def test_a_bag_of_a_later_version_is_refused_in_words(tmp_path):
    bag = write_bag(tmp_path / "bag", {BODY: poses(SWIM)})
    metadata = (bag / "metadata.yaml").read_text()
    (bag / "metadata.yaml").write_text(metadata.replace("version: 9", "version: 99"))
    with pytest.raises(BadInput, match=r"version 99 not supported"):
        read_bag(bag, mocap())


def test_definitions_never_become_code(tmp_path):
    bag = write_bag(tmp_path / "bag", {"/pods": series(OWN, lambda k: {})})
    file = next(bag.glob("*.db3"))
    wrong = "tank_msgs/msg/Thrust': 1, 'x"
    with sqlite3.connect(file) as database:
        database.execute("UPDATE topics SET type = ?", (wrong,))
        database.execute("UPDATE message_definitions SET topic_type = ?", (wrong,))
    database.close()
    with pytest.raises(BadInput):
        read_commands(file, log(columns=["t1"], topic="/pods"))


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # numbers near the largest overflow
def test_a_damaged_mcap_of_many_topics_is_read_or_refused(tmp_path):
    pulses = channels("mavros_msgs/msg/RCOut", [[1500, 1600]] * 20)
    bag = write_bag(tmp_path / "bag", {BODY: poses(SWIM), "/out": pulses, **sensors()}, "MCAP")
    content = campaign_content("rosbag2")
    topics = {"pose": BODY, "imu": "/imu", "depth": "/pressure", "velocity": "/dvl"}
    content["mocap"]["topics"] = topics
    content["commands"] = {
        "format": "rosbag2",
        "kind": "pwm",
        "columns": ["t1", "t2"],
        "topic": "/out",
    }
    content["runs"][0] |= {"mocap": "bag/bag.mcap", "commands": "bag/bag.mcap"}
    read_damaged(write_campaign(tmp_path, content), [bag / "bag.mcap"], seed="mcap")


@real
def test_the_bag_of_the_tank():
    export = read_bag(TANK, mocap(body="/mocap/bluerov_saab/odom"))
    assert len(export.time) == 113
    assert export.tracked.all()
    assert 1.0 / np.median(np.diff(export.time)) == pytest.approx(125.0, rel=0.05)
    commands = read_commands(TANK, log(columns=[f"RC{k + 1}" for k in range(6)]))
    assert commands.value.shape == (19, 6)
    assert abs(commands.time[0] - export.time[0]) < 1.5
    with pytest.raises(BadInput, match=r"brov_msgs/msg/StampedRcOverride, which the bag does not"):
        read_commands(TANK, log(columns=["t1"], topic="/brov/rc/stamped_override"))


@real
def test_the_bag_of_another_vehicle():
    topics = {"imu": "/mavros/imu/data", "depth": "/mavros/imu/static_pressure"}
    topics["battery"] = "/mavros/battery"
    export = read_bag(OTHER, mocap(body="/mocap/sam_mocap/odom", topics=topics))
    assert len(export.time) == 1775
    assert {kind: len(channel.time) for kind, channel in export.channels.items()} == {
        "rates": 259,
        "specific_force": 259,
        "depth": 53,
        "voltage": 78,
    }
    assert export.channels["specific_force"].value[:, 2].mean() == pytest.approx(9.81, abs=0.05)
    assert any("sam_mocap" in note and "bag's times hold" in note for note in export.notes)
    assert len(read_commands(OTHER, log(columns=["t1"], topic="/mavros/rc/out")).time) == 52


def test_without_its_packages_the_reader_says_what_to_install(tmp_path, monkeypatch):
    bag = write_bag(tmp_path / "bag", {BODY: poses(SWIM)})
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    with pytest.raises(
        BadInput, match=r"mocap.format: rosbag2.*pip install 'rovsim\[recordings\]'"
    ):
        read_bag(bag, mocap())
