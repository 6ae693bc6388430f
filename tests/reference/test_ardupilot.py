"""ArduPilot logs: what is read of each kind, by whose clock, and what is never made up."""

import numpy as np
import pytest
from pymavlink.DFReader import DFReader_binary
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from damage import read_damaged
from logs import RECEIVED, Dataflash, Telemetry, angles, dataflash, telemetry
from recordings import Swim, campaign_content, write_campaign
from rovsim.core import extras
from rovsim.core.errors import BadInput
from rovsim.core.rotations import matrix
from rovsim.measurement.campaign_file import CommandLog, Mocap
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.formats.ardupilot.commands import read_commands
from rovsim.measurement.recording.formats.ardupilot.dataflash import read_dataflash
from rovsim.measurement.recording.formats.ardupilot.motion import read_log

MOCAP = Mocap(format="ardupilot", world_axes="ned", body_axes="frd")
SWIM = Swim.ned(60)


def log(**keys):
    return CommandLog(**{"format": "ardupilot", "kind": "pwm", **keys})


def test_a_telemetry_log_gives_every_channel_on_one_clock(tmp_path):
    export = read_log(telemetry(SWIM).write(tmp_path / "a.tlog"), MOCAP)
    channels = export.channels
    assert set(channels) == {"attitude", "rates", "specific_force", "depth", "position", "voltage"}
    np.testing.assert_allclose(matrix(channels["attitude"].value), SWIM.rotation, atol=1e-6)
    np.testing.assert_allclose(channels["rates"].value[0], [0.1, 0.2, 0.3])
    np.testing.assert_allclose(channels["specific_force"].value[0], [0, 0, -9.80665])
    np.testing.assert_allclose(channels["depth"].value, 2.5)
    np.testing.assert_allclose(channels["voltage"].value, 16.2)
    np.testing.assert_allclose(channels["position"].value[:, :2], SWIM.position[:, :2], atol=1e-6)
    assert np.isnan(channels["position"].value[:, 2]).all()  # made of the depth
    for channel in channels.values():  # some carry the vehicle's time, others that of reception
        np.testing.assert_allclose(channel.time - RECEIVED - 0.05, SWIM.time, atol=2e-3)
    assert "MANUAL" in export.notes[-1]


def test_a_dataflash_log_gives_the_first_sensor_of_a_kind(tmp_path):
    made = dataflash(SWIM)
    made.declare("IMU", "QBffffff", ["TimeUS", "I", "GyrX", "GyrY", "GyrZ", "AccX", "AccY", "AccZ"])
    made.declare("CTUN", "Qf", ["TimeUS", "BAlt"])
    made.declare("BAT", "QBf", ["TimeUS", "Inst", "Volt"])
    made.declare("MODE", "QMB", ["TimeUS", "Mode", "ModeNum"])
    made.add("MODE", 0, 2, 2)
    for k in range(50):
        for unit in (0, 1):
            made.add("IMU", 2500 * k, unit, 0.1 + unit, 0.2, 0.3, 0.0, 0.0, -9.8)
        made.add("CTUN", 100000 * k, -1.25)
        made.add("BAT", 100000 * k, 0, 15.9)
    export = read_log(made.write(tmp_path / "a.bin"), MOCAP)
    channels = export.channels
    assert set(channels) == {"attitude", "rates", "specific_force", "depth", "position", "voltage"}
    assert channels["rates"].rate == pytest.approx(400.0)
    np.testing.assert_allclose(channels["rates"].value, [[0.1, 0.2, 0.3]] * 50, rtol=1e-6)
    np.testing.assert_allclose(channels["depth"].value, 1.25)
    np.testing.assert_allclose(channels["voltage"].value, 15.9, rtol=1e-6)
    np.testing.assert_allclose(channels["position"].value[:, 1], SWIM.position[:, 1], atol=1e-6)
    assert "ALT_HOLD" in export.notes[-1]


def test_dataflash_is_read_as_pymavlink_reads_it(tmp_path):
    made = dataflash(SWIM)
    made.declare("BARO", "QBcf", ["TimeUS", "I", "Alt", "Press"])
    for k in range(5):
        made.add("BARO", 1000 * k, 0, -125 - k, 1.5)
    path = made.write(tmp_path / "a.BIN")
    read = read_dataflash(path).series
    with DFReader_binary(str(path), zero_time_base=True) as reader:
        for name in ("XKF1", "RCOU", "BARO"):
            reader.rewind()
            rows = []
            while (message := reader.recv_match(type={name}, strict=True)) is not None:
                if getattr(message, "C", 0) == 0:
                    rows.append([getattr(message, field) for field in read[name].fields])
            np.testing.assert_allclose(read[name].of(list(read[name].fields)), rows, rtol=1e-7)


def test_centidegrees_and_milliseconds_of_older_logs(tmp_path):
    made = Dataflash()
    made.declare("ATT", "Iccc", ["TimeMS", "Roll", "Pitch", "Yaw"])
    for k in range(20):
        made.add("ATT", 100 * k, 100 * k, -50, 9000)
    attitude = read_log(made.write(tmp_path / "a.BIN"), MOCAP).channels["attitude"]
    np.testing.assert_allclose(attitude.time, 0.1 * np.arange(20))
    assert np.degrees(2 * np.arcsin(attitude.value[0, 3])) == pytest.approx(90.0, abs=0.1)


@pytest.mark.parametrize("status", [0b00000111, 0b10011111, None])
def test_a_position_that_the_filter_does_not_know_is_not_measured(tmp_path, status):
    made = dataflash(SWIM, status=status or 0)
    if status is None:
        made.raw = made.raw.replace(b"XKF4", b"XKFX")
    export = read_log(made.write(tmp_path / "a.BIN"), MOCAP)
    assert set(export.channels) == {"attitude"}
    assert any("never knew where" in note for note in export.notes)
    flags = mavlink.EKF_CONST_POS_MODE + mavlink.EKF_POS_VERT_ABS
    export = read_log(telemetry(SWIM, flags=flags).write(tmp_path / "a.tlog"), MOCAP)
    assert "position" not in export.channels


def test_the_height_of_a_boat_is_no_depth(tmp_path):
    boat = telemetry(SWIM, vehicle=mavlink.MAV_TYPE_SURFACE_BOAT)
    export = read_log(boat.write(tmp_path / "a.tlog"), MOCAP)
    assert "depth" not in export.channels
    np.testing.assert_allclose(export.channels["position"].value, SWIM.position, atol=1e-6)
    assert any("no submarine" in note for note in export.notes)


def test_after_a_reboot_the_times_of_reception_hold(tmp_path):
    made = telemetry(SWIM)
    for k in range(40):
        message = mavlink.MAVLink_attitude_message(10 * k, 0, 0, 0, 0, 0, 0)
        made.add(100.0 + 0.01 * k, message)
    export = read_log(made.write(tmp_path / "a.tlog"), MOCAP)
    assert any("reboot" in note for note in export.notes)
    last = export.channels["attitude"].time[-1] - RECEIVED
    assert last == pytest.approx(100.39 + 0.05, abs=1e-3)


@pytest.mark.parametrize("name", ["a.BIN", "a.tlog"])
def test_outputs_are_commands(tmp_path, name):
    made = dataflash(SWIM) if name == "a.BIN" else telemetry(SWIM)
    path = made.write(tmp_path / name)
    export = read_commands(path, log(columns=["SERVO2", "SERVO3", "SERVO4", "-SERVO3"]))
    np.testing.assert_allclose(export.value, [[1, -1, 0, 1]] * 60)
    assert "60 outputs without a pulse" in export.notes[0]
    with pytest.raises(BadInput, match=r"no output or channel SERVO17"):
        read_commands(path, log(columns=["SERVO17"]))
    for columns, kind in ((["t1"], "pwm"), (["SERVO1", "RC1"], "pwm"), (["RC1"], "wrench")):
        with pytest.raises(BadInput, match=r"SERVO1, SERVO2, … or RC1"):
            read_commands(path, log(columns=columns, kind=kind, axes=["yaw"]))


def test_the_pilot_s_radio_is_a_demand_on_named_axes(tmp_path):
    path = telemetry(SWIM).write(tmp_path / "a.tlog")
    given = log(kind="demand", columns=["-RC2", "RC1"], axes=["heave", "yaw"])
    export = read_commands(path, given)
    np.testing.assert_allclose(export.value, [[0, 0, -0.25, 0, 0, 0]] * 60)
    silent = read_commands(path, log(kind="demand", columns=["RC8"], axes=["yaw"]))
    assert silent.repairs.dropped == 60
    with pytest.raises(BadInput, match=r"no messages RCIN"):
        read_commands(dataflash(SWIM).write(tmp_path / "a.BIN"), log(columns=["RC1"]))


def test_a_run_of_one_log_is_on_one_clock(tmp_path):
    telemetry(Swim.ned(400)).write(tmp_path / "dive 1.tlog")
    content = campaign_content("ardupilot")
    content["commands"] = {"format": "ardupilot", "kind": "pwm", "columns": ["SERVO1", "SERVO2"]}
    content["runs"][0] |= {"mocap": "dive 1.tlog", "commands": "dive 1.tlog"}
    recording, anomalies = read_run(load_campaign(write_campaign(tmp_path, content)), "one")
    np.testing.assert_allclose(
        recording.commands.time, recording.channels["attitude"].time, atol=2e-3
    )
    assert recording.time[0] < 1.0
    assert len(anomalies.notes) == len(set(anomalies.notes))
    yaw = angles(Swim.ned(400))[:, 2]
    assert np.ptp(yaw) > 1.0  # it did turn


BAD = {
    "an empty .BIN": ("a.BIN", b"", ["the file is empty", "Download"]),
    "an empty .tlog": ("a.tlog", b"", ["the file is empty", "Download"]),
    "another .BIN": ("a.BIN", b"PK\x03\x04" * 99, ["does not start as a .BIN does"]),
    "another .tlog": ("a.tlog", b"PK\x03\x04" * 99, ["no message of a known type"]),
    "only formats": ("a.BIN", Dataflash().raw, ["no message of a known type"]),
    "a text log": ("a.log", b"FMT, 128\n", ["ends in '.log'", ".BIN"]),
}


@pytest.mark.parametrize("what", BAD)
def test_what_is_no_log_is_refused_in_words(tmp_path, what):
    name, raw, words = BAD[what]
    (tmp_path / name).write_bytes(raw)
    with pytest.raises(BadInput) as refusal:
        read_log(tmp_path / name, MOCAP)
    for word in [str(tmp_path / name), *words]:
        assert word in str(refusal.value)


def test_a_log_without_motion_says_what_it_holds(tmp_path):
    made = Dataflash()
    made.declare("RCOU", "QHHHH", ["TimeUS", "C1", "C2", "C3", "C4"])
    made.add("RCOU", 0, 1500, 1500, 1500, 1500)
    with pytest.raises(BadInput, match=r"no messages ATT or IMU.*the log holds RCOU.*LOG_BITMASK"):
        read_log(made.write(tmp_path / "a.BIN"), MOCAP)


@pytest.mark.parametrize("length", [0, 1, 3, 250])
def test_a_format_that_contradicts_itself_is_passed_over(tmp_path, length):
    made = dataflash(SWIM)
    at = made.raw.index(b"XKF1") - 1
    made.raw = made.raw[:at] + bytes([length]) + made.raw[at + 1 :]
    export = read_log(made.write(tmp_path / "a.BIN"), MOCAP)
    assert set(export.channels) == {"attitude"}
    assert any("damaged" in note for note in export.notes)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # numbers near the largest overflow
def test_a_damaged_telemetry_log_is_read_or_refused(tmp_path):
    path = telemetry(SWIM).write(tmp_path / "a.tlog")
    content = campaign_content("ardupilot")
    content["commands"] = {"format": "ardupilot", "kind": "pwm", "columns": ["SERVO1", "SERVO2"]}
    content["runs"][0] |= {"mocap": "a.tlog", "commands": "a.tlog"}
    read_damaged(write_campaign(tmp_path, content), [path], seed="tlog")


def test_without_pymavlink_a_tlog_says_what_to_install(tmp_path, monkeypatch):
    path = telemetry(SWIM).write(tmp_path / "a.tlog")
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    with pytest.raises(BadInput, match=r"pip install 'rovsim\[recordings\]'"):
        read_log(path, MOCAP)
    assert Telemetry().raw == b""
