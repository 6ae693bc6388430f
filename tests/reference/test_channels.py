"""Any subset of channels in a csv file: what becomes of it, in any axes, and what stays unknown."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from recordings import (
    Swim,
    campaign_content,
    command_lines,
    csv_lines,
    write_campaign,
    write_lines,
    write_run,
)
from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler, matrix
from rovsim.core.run import Commands
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.quality.assessment import assess, report_quality
from rovsim.measurement.quality.usability import usable_reason
from rovsim.measurement.recording import Recording, read_run
from rovsim.measurement.recording.channels import CHANNEL_KINDS, Channel, to_ned
from rovsim.measurement.signals.chain import SignalSettings, clean
from worlds import model


def read(folder, lines, mocap=None, run=None, commands=True):
    """The recording and its anomalies of a csv with these lines, in NED and FRD."""
    content = campaign_content("csv")
    content["mocap"] |= {"world_axes": "ned", "body_axes": "frd"} | (mocap or {})
    content["runs"][0] |= run or {}
    if not commands:
        del content["commands"]
        content["runs"][0]["commands"] = "none"
    write_lines(folder / "poses.csv", lines)
    write_lines(folder / "commands.csv", command_lines())
    return read_run(load_campaign(write_campaign(folder, content)), "one")


def sparse(columns):
    """Lines of a file in which every column has its own times: name -> (times, values)."""
    times = np.unique(np.concatenate([t for t, _ in columns.values()]))
    rows = [",".join(["time_s", *columns])]
    for now in times:
        cells = [
            f"{v[np.flatnonzero(t == now)[0]]:.9g}" if now in t else "" for t, v in columns.values()
        ]
        rows.append(",".join([f"{now:.6g}", *cells]))
    return rows


SLOW, FAST = np.arange(12) / 3.0, np.arange(40) / 10.0
ANGLES = {
    "roll_rad": (FAST, 0.1 * np.sin(FAST)),
    "pitch_rad": (FAST, 0.2 * np.cos(FAST)),
    "yaw_rad": (FAST, FAST),
}


def test_depth_at_3_hz_and_attitude_at_10_hz_share_a_file(tmp_path):
    recording, anomalies = read(tmp_path, sparse({"depth_m": (SLOW, 1 + SLOW), **ANGLES}))
    assert set(recording.channels) == {"depth", "attitude"}
    depth, attitude = recording.channels["depth"], recording.channels["attitude"]
    np.testing.assert_allclose(depth.value[:, 0], 1 + SLOW, atol=1e-6)
    np.testing.assert_allclose(attitude.time, FAST)
    expected = from_euler(*(value for _, value in ANGLES.values()))
    np.testing.assert_allclose(matrix(attitude.value), matrix(expected), atol=1e-7)
    assert attitude.rate == pytest.approx(10.0)
    assert not recording.posed
    assert not recording.tracked.any()
    assert np.isnan(recording.position).all()
    assert not any(anomalies.counts.values())
    report = report_quality(recording, anomalies, SignalSettings().outliers)
    assert list(report.excitation) == ["heave", "roll", "pitch", "yaw"]
    assert report.excited == ()  # it sinks steadily


def test_what_was_not_measured_is_nan_or_absent_and_never_zero(tmp_path):
    plan = {"x_m": (FAST, FAST), "y_m": (FAST, 2 * FAST), "yaw_rad": (FAST, 0.1 * FAST)}
    recording, _ = read(tmp_path, sparse(plan))
    assert set(recording.channels) == {"position", "euler"}
    np.testing.assert_allclose(recording.channels["position"].value[:, 1], 2 * FAST)
    assert np.isnan(recording.channels["position"].value[:, 2]).all()
    assert np.isnan(recording.channels["euler"].value[:, :2]).all()


def test_position_velocity_and_rates_at_their_own_rates(tmp_path):
    gyro = np.arange(800) / 200.0
    rates = {f"{name}_rad_s": (gyro, k + gyro) for k, name in enumerate("pqr")}
    dvl = {f"{name}_m_s": (SLOW, k - SLOW) for k, name in enumerate("uvw")}
    usbl = {f"{name}_m": (SLOW[::2], k * SLOW[::2]) for k, name in enumerate("xyz")}
    recording, anomalies = read(tmp_path, sparse({**usbl, **ANGLES, **dvl, **rates}))
    measured = {kind: len(channel.time) for kind, channel in recording.channels.items()}
    assert measured == {"position": 6, "attitude": 40, "velocity": 12, "rates": 800}
    np.testing.assert_allclose(recording.channels["rates"].value[:, 2], 2 + gyro, atol=1e-6)
    assert recording.nu is None
    assert recording.rate == pytest.approx(200.0)
    report = report_quality(recording, anomalies, SignalSettings().outliers)
    assert report.channels["velocity"].measured == ("u", "v", "w")
    assert report.unusable is None
    assert set(report.excitation) == set(AXES)
    assert any("no full poses" in remark and "rates" in remark for remark in report.remarks)


def test_a_delay_that_is_not_used_is_a_doubt(tmp_path):
    dvl = {f"{name}_m_s": (SLOW, k - SLOW) for k, name in enumerate("uvw")}
    late = {"sensors": {"delay_s": {"velocity": 0.1, "euler": 0.2}}}
    both = {"euler": sparse({**ANGLES, **dvl}), "euler, velocity": csv_lines(Swim.ned())}
    for idle, lines in both.items():
        recording, anomalies = read(tmp_path / idle, lines, late)
        told = f"The delay of {idle} (mocap.sensors.delay_s) is not used"
        assert told in " ".join(assess(recording, anomalies).doubts)
    plain, anomalies = read(tmp_path / "plain", csv_lines(Swim.ned()))
    assert not any("delay" in doubt for doubt in assess(plain, anomalies).doubts)


def test_full_poses_keep_their_place_and_the_rest_goes_beside_them(tmp_path):
    lines = csv_lines(Swim.ned())
    plain, _ = read(tmp_path / "plain", lines)
    lines = [f"{line},{'depth_m' if k == 0 else ''}" for k, line in enumerate(lines)]
    lines[1:1] = [f"{t + 0.005:.4f},,,,,,,{2 + t:.3f}" for t in SLOW]
    lines[60] = f"{lines[60].split(',')[0]},,,,,,,"  # a frame without the body
    beside, anomalies = read(tmp_path / "beside", lines)
    np.testing.assert_array_equal(beside.time, plain.time)
    assert np.flatnonzero(~beside.tracked).tolist() == [47]
    np.testing.assert_array_equal(beside.position[beside.tracked], plain.position[beside.tracked])
    np.testing.assert_allclose(beside.channels["depth"].value[:, 0], 2 + SLOW, atol=1e-3)
    assert anomalies.motion.duplicates == 0
    assert plain.channels == {}


def with_velocities(lines, every=1):
    names = ",u_m_s,v_m_s,w_m_s,p_rad_s,q_rad_s,r_rad_s"
    given = [
        f"{line}{',1,2,3,4,5,6' if k % every == 0 else ',,,,,,'}"
        for k, line in enumerate(lines[1:])
    ]
    return [lines[0] + names, *given]


def test_velocities_are_means_or_instants_as_the_campaign_says(tmp_path):
    lines = with_velocities(csv_lines(Swim.ned()))
    mean, _ = read(tmp_path / "mean", lines)
    np.testing.assert_array_equal(mean.nu[0], [1, 2, 3, 4, 5, 6])
    assert mean.channels == {}
    instant, _ = read(tmp_path / "instant", lines, {"velocity": "instant"})
    assert instant.nu is None
    assert instant.tracked.all()
    np.testing.assert_array_equal(instant.channels["rates"].value[0], [4, 5, 6])


def test_velocities_that_few_poses_have_are_no_bin_means_and_that_is_said(tmp_path):
    recording, anomalies = read(tmp_path, with_velocities(csv_lines(Swim.ned()), every=10))
    assert recording.nu is None
    assert recording.tracked.all()
    assert len(recording.channels["velocity"].time) == 40
    assert any("mocap.velocity: instant" in note for note in anomalies.notes)


def test_a_column_that_is_almost_known_is_told(tmp_path):
    lines = sparse({"depth": (SLOW, SLOW), **ANGLES})
    recording, anomalies = read(tmp_path, lines)
    assert set(recording.channels) == {"attitude"}
    assert anomalies.notes == ("The column 'depth' is not read: was 'depth_m' meant?",)


def test_poses_of_zeros_are_no_measurement_unless_the_run_starts_there(tmp_path):
    x = 3.0 + FAST
    plan = {"x_m": (FAST, x), "y_m": (FAST, x), "yaw_rad": (FAST, x), "depth_m": (FAST, 0 * FAST)}
    for _, value in list(plan.values())[:3]:
        value[[0, 10, 11]] = 0.0
    recording, anomalies = read(tmp_path / "lost", sparse(plan))
    assert len(recording.channels["position"].time) == len(FAST) - 3
    assert len(recording.channels["euler"].time) == len(FAST) - 3
    assert len(recording.channels["depth"].time) == len(FAST)
    assert "3 lines with a pose of zeros" in anomalies.notes[0]
    from_first = {name: (t, v - v[1] + 0.1) for name, (t, v) in plan.items()}
    for _, value in list(from_first.values())[:3]:
        value[[0, 1]] = 0.0
        value[[10, 11]] = 1.0
    recording, anomalies = read(tmp_path / "from first", sparse(from_first))
    assert len(recording.channels["position"].time) == len(FAST)
    assert anomalies.notes == ()


turns = st.floats(-3.0, 3.0)


@given(
    st.tuples(turns, st.floats(-1.5, 1.5), turns),
    st.sampled_from(["z_up", "ned"]),
    st.sampled_from(["flu", "frd"]),
)
def test_angles_turn_into_other_axes_as_attitudes_do(angles, world, body):
    mocap = Mocap(format="csv", world_axes=world, body_axes=body)
    value = np.array([angles])
    now = np.zeros(1)
    turned = to_ned(
        {"euler": Channel(now, value), "attitude": Channel(now, from_euler(*value.T))}, mocap
    )
    np.testing.assert_allclose(
        matrix(from_euler(*turned["euler"].value.T)), matrix(turned["attitude"].value), atol=1e-9
    )


@given(st.sampled_from(["z_up", "ned"]), st.sampled_from(["flu", "frd"]))
def test_every_kind_has_axes_that_are_turned(world, body):
    mocap = Mocap(format="csv", world_axes=world, body_axes=body)
    for kind, declared in CHANNEL_KINDS.items():
        value = np.full((1, len(declared.columns)), 0.5)
        turned = to_ned({kind: Channel(np.zeros(1), value)}, mocap)[kind].value
        assert turned.shape == value.shape
        same = {"world": world == "ned", "body": body == "frd", "none": True}[declared.axes]
        if kind not in ("attitude", "euler"):
            np.testing.assert_array_equal(turned, value if same else value * [[1, -1, -1]])


def test_channels_and_sensors_survive_the_file(tmp_path):
    sensors = {"velocity_at": [0.1, 0, 0.2], "delay_s": {"velocity": 0.1}}
    lines = sparse({"depth_m": (SLOW, SLOW), **ANGLES})
    recording, _ = read(tmp_path, lines, {"sensors": sensors})
    recording.write(tmp_path / "one.npz")
    again = Recording.read(tmp_path / "one.npz")
    assert again.sensors == recording.sensors
    assert again.sensors.velocity_at == (0.1, 0.0, 0.2)
    assert again.sensors.delay_s.velocity == 0.1
    assert again.sensors.delay_s.depth == 0.0
    for kind, channel in recording.channels.items():
        np.testing.assert_array_equal(again.channels[kind].value, channel.value)
        np.testing.assert_array_equal(again.channels[kind].time, channel.time)


@pytest.mark.parametrize(
    ("sensors", "words"),
    [
        ({"dvl_at": [0, 0, 0]}, ["mocap.sensors.dvl_at", "velocity_at"]),
        ({"delay_s": {"dvl": 0.1}}, ["mocap.sensors.delay_s.dvl", "velocity"]),
        ({"imu_at": [0, 0]}, ["mocap.sensors.imu_at"]),
    ],
)
def test_a_wrong_sensor_is_refused_in_words(tmp_path, sensors, words):
    with pytest.raises(BadInput) as refusal:
        read(tmp_path, sparse(ANGLES), {"sensors": sensors})
    for word in words:
        assert word in str(refusal.value)


def test_dates_become_times_from_the_start(tmp_path):
    start = 1723306681.25
    late = {name: (t + start, value) for name, (t, value) in ANGLES.items()}
    rows = sparse(late)
    rows[1:] = [
        f"{t + start:.6f},{row.split(',', 1)[1]}" for t, row in zip(FAST, rows[1:], strict=True)
    ]
    recording, _ = read(tmp_path, rows, commands=False)
    np.testing.assert_allclose(recording.channels["attitude"].time, FAST + 0.25, atol=1e-6)
    np.testing.assert_allclose(recording.time, FAST + 0.25, atol=1e-6)


def test_what_was_not_measured_is_neither_moved_nor_scored(tmp_path):
    """Attitudes alone: they turn the vehicle, and nothing is said of where it is."""
    recording, _ = read(tmp_path, sparse(ANGLES))
    assert usable_reason(recording) is None
    motion = clean(recording, SignalSettings())
    np.testing.assert_array_equal(motion.measured.axes, [False] * 3 + [True] * 3)
    assert motion.usable.any()
    assert not motion.nu[motion.usable, :3].any()
    assert np.abs(motion.nu[motion.usable, 3:]).max() > 0.01


def test_a_run_without_commands_has_none_and_nothing_pushes(tmp_path):
    folder = write_run(tmp_path)
    content = campaign_content()
    content["runs"][0]["commands"] = "none"
    recording, anomalies = read_run(load_campaign(write_campaign(folder, content)), "one")
    assert recording.commands.value.shape == (0, 2)
    report = report_quality(recording, anomalies, SignalSettings().outliers)
    assert report.commands is None
    motion = clean(recording, SignalSettings())
    assert motion.usable.any()
    for kind, columns in (("thruster", 8), ("demand", 6), ("wrench", 6)):
        nothing = Commands(np.empty(0), np.empty((0, columns)), kind)
        thrust = model().thrust_path.over_steps(nothing, np.linspace(0.0, 1.0, 11))
        assert not thrust.force.any()
        assert not thrust.wrench.any()


def test_without_any_commands_the_section_may_be_left_out(tmp_path):
    recording, _ = read(tmp_path, csv_lines(Swim.ned()), commands=False)
    assert recording.commands.value.shape == (0, 6)
    assert recording.commands.kind == "wrench"
    content = campaign_content("csv")
    del content["commands"]
    with pytest.raises(BadInput, match=r"'commands' is missing, and run 'one' has commands"):
        load_campaign(write_campaign(tmp_path, content))


@pytest.mark.parametrize("posed", [True, False], ids=["poses", "channels"])
def test_what_lies_outside_of_the_used_spans_is_left_out_and_counted(tmp_path, posed):
    lines = csv_lines(Swim.ned()) if posed else sparse(ANGLES)
    whole, nothing = read(tmp_path / "whole", lines)
    recording, counts = read(tmp_path / "part", lines, run={"use": [[0.5, 1.5], [2.0, 2.5]]})
    assert nothing.left_out == 0
    assert counts.left_out > 0
    if posed:
        times = recording.time[recording.tracked]
        assert len(times) == whole.tracked.sum() - counts.left_out
        assert (recording.time == whole.time).all()
    else:
        times = recording.time
        assert len(times) == len(whole.time) - counts.left_out
        assert all(np.isin(c.time, times).all() for c in recording.channels.values())
    assert np.all(((times >= 0.5) & (times <= 1.5)) | ((times >= 2.0) & (times <= 2.5)))
    report = assess(recording, counts)
    assert report.not_found == 0
    assert report.gaps == ()
    assert not any("was not found" in remark for remark in report.remarks)


@pytest.mark.parametrize(
    ("use", "said"), [([[900, 950]], "holds nothing"), ([[2, 1]], "the earlier time first")]
)
def test_spans_that_hold_nothing_are_refused(tmp_path, use, said):
    with pytest.raises(BadInput, match=said):
        read(tmp_path, csv_lines(Swim.ned()), run={"use": use})


def test_several_files_of_a_run_say_what_one_says(tmp_path):
    together, _ = read(tmp_path, sparse({"depth_m": (SLOW, 1 + SLOW), **ANGLES}))
    write_lines(tmp_path / "poses.csv", sparse(ANGLES))
    write_lines(tmp_path / "depth.csv", sparse({"depth_m": (SLOW, 1 + SLOW)}))
    several = read_several(tmp_path, ["poses.csv", "depth.csv"])
    np.testing.assert_array_equal(several.time, together.time)
    assert several.rate == together.rate
    for kind, channel in together.channels.items():
        np.testing.assert_array_equal(several.channels[kind].time, channel.time)
        np.testing.assert_array_equal(several.channels[kind].value, channel.value)


def test_full_poses_in_one_file_stand_for_those_parts_in_another(tmp_path):
    write_lines(tmp_path / "poses.csv", csv_lines(Swim.ned(frames=60)))
    write_lines(tmp_path / "imu.csv", sparse(ANGLES | {"p_rad_s": (FAST, FAST)}))
    recording = read_several(tmp_path, ["imu.csv", "poses.csv"])
    assert recording.posed
    assert set(recording.channels) == {"rates"}


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ({"depth_m": (SLOW, SLOW)}, r"other.csv: 'depth' is in poses.csv and in other.csv"),
        ({"p_rad_s": (SLOW + 1e5, SLOW)}, r"other.csv: runs from 100000 to .* on one clock"),
    ],
)
def test_files_that_cannot_be_of_one_run_are_refused(tmp_path, columns, said):
    write_lines(tmp_path / "poses.csv", sparse({"depth_m": (SLOW, 1 + SLOW)}))
    write_lines(tmp_path / "other.csv", sparse(columns))
    with pytest.raises(BadInput, match=said):
        read_several(tmp_path, ["poses.csv", "other.csv"])


def read_several(folder, files) -> Recording:
    """The recording of a run without commands that lies in several files."""
    content = campaign_content("csv")
    content["mocap"] |= {"world_axes": "ned", "body_axes": "frd"}
    content["runs"][0] |= {"mocap": files, "commands": "none"}
    return read_run(load_campaign(write_campaign(folder, content)), "one")[0]
