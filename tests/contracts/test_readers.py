"""What every registered reader owes: the same swim, whatever the format and the axes."""

import sys

import numpy as np
import pytest

import rovsim.measurement.recording.formats as formats_package
from recordings import (
    AXES,
    FORMATS,
    TEXT,
    Swim,
    campaign_content,
    command_lines,
    write_campaign,
    write_commands,
    write_lines,
    write_poses,
    write_run,
)
from rovsim.apps.cli.main import main
from rovsim.core import pwm
from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_matrix, matrix
from rovsim.intake.survey import look
from rovsim.measurement.campaign_file import CommandLog, Mocap
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.quality.assessment import assess
from rovsim.measurement.quality.usability import usable_reason
from rovsim.measurement.recording import Recording, read_run
from rovsim.measurement.recording.readers import command_readers, mocap_readers

every_format = pytest.mark.parametrize("name", sorted(mocap_readers()))
every_log = pytest.mark.parametrize("name", sorted(command_readers()))
every_text = pytest.mark.parametrize("name", sorted(TEXT))


def test_the_formats_of_this_version_are_registered():
    assert set(command_readers()) >= {"csv", "rosbag2", "ardupilot"}
    assert set(mocap_readers()) == set(FORMATS)


def test_options_of_a_format_are_keys_of_its_section():
    for readers, section in ((mocap_readers(), Mocap), (command_readers(), CommandLog)):
        for reader in readers.values():
            assert set(reader.options) <= set(section.model_fields)


ONE_FILE = '''
"""Lines of "time x y z qw qx qy qz" below the word PLAIN, one body."""

import numpy as np

from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.readers import FileAxes, MocapReader
from rovsim.measurement.recording.signature import FileSignature, starts_with


def read(path, mocap):
    table = np.loadtxt(path, skiprows=1)
    seen = np.ones(len(table), bool)
    return Export(table[:, 0], table[:, 1:4], table[:, 4:], seen)


MOCAP_READER = MocapReader(
    "plain",
    "a plain file",
    read,
    (FileSignature(starts_with(b"PLAIN")),),
    axes=FileAxes(("ned",), ("frd",), reason="so"),
)
'''


ONE_LOG = '''
"""Lines of "time t1 t2", pulses in us, below the word PULSES."""

import numpy as np

from rovsim.measurement.recording.candidates import CommandCandidate, FoundCommands
from rovsim.measurement.recording.commands import as_commands
from rovsim.measurement.recording.readers import CommandReader
from rovsim.measurement.recording.signature import FileSignature, starts_with

NAMES = ("t1", "t2")


def find(path):
    table = np.loadtxt(path, skiprows=1)
    return FoundCommands(
        (CommandCandidate("pulses", NAMES, table[:, 0], table[:, 1:], "pwm", "said so"),)
    )


def read(path, log):
    table = np.loadtxt(path, skiprows=1)
    value = table[:, [1 + NAMES.index(name) for name in log.names]]
    return as_commands(table[:, 0], value, log, lambda line, column: f"{path}, line {line + 2}")


COMMAND_READER = CommandReader(
    "pulses", read, find, "a file of pulses", (FileSignature(starts_with(b"PULSES")),)
)
'''


@pytest.fixture
def add_format(tmp_path, monkeypatch):
    """A function that puts one more file into the folder of formats, by its name and text."""
    folder, added = tmp_path / "readers", []
    monkeypatch.setattr(formats_package, "__path__", [*formats_package.__path__, str(folder)])

    def add(name, text):
        write_lines(folder / f"{name}.py", [text])
        added.append(name)

    yield add
    for name in added:
        sys.modules.pop(f"{formats_package.__name__}.{name}", None)
        vars(formats_package).pop(name, None)


@pytest.fixture
def plain_reader(add_format):
    """A format that one more file in the folder of readers declares."""
    add_format("plain", ONE_FILE)
    return "plain"


def test_a_reader_is_one_file(tmp_path, plain_reader):
    swim = Swim.ned(frames=1200)
    poses = np.column_stack([swim.time, swim.position, from_matrix(swim.rotation)])
    raw = tmp_path / "raw"
    lines = ["PLAIN", *(" ".join(f"{v:.9f}" for v in row) for row in poses)]
    write_lines(raw / "dive.txt", lines)
    write_lines(raw / "dive_commands.csv", command_lines(12.0))
    held = look(raw / "dive.txt", tmp_path)
    assert (held.format, [track.body for track in held.tracks]) == ("plain", [""])
    main(["init", str(raw), "-q"])
    file = raw / "campaign.yaml"
    text = file.read_text()
    assert "world_axes: ned" in text
    assert "body_axes: frd" in text
    file.write_text(text.replace("vehicle: ANSWER", "vehicle: bluerov2"))
    campaign = load_campaign(raw)
    recording, _ = read_run(campaign, campaign.runs[0].id)
    assert campaign.mocap.format == plain_reader
    np.testing.assert_allclose(recording.position, swim.position, atol=1e-6)
    file.write_text(file.read_text().replace("world_axes: ned", "world_axes: y_up"))
    with pytest.raises(BadInput, match=r"'y_up' with 'mocap.format: plain'"):
        load_campaign(raw)


def test_a_reader_of_commands_is_one_file(tmp_path, add_format):
    add_format("pulses", ONE_LOG)
    raw, swim = tmp_path / "raw", Swim.ned(frames=1200)
    write_poses(raw, "qtm_tsv", swim)
    lines = [line.replace(",", " ") for line in command_lines(12.0)[1:]]
    write_lines(raw / "poses.log", ["PULSES", *lines])
    main(["init", str(raw), "-q"])
    file = raw / "campaign.yaml"
    text = file.read_text()
    for line in ("format: pulses", "kind: pwm", "commands: poses.log"):
        assert line in text
    for key, answer in (("vehicle", "bluerov2"), ("world_axes", "z_up"), ("body_axes", "flu")):
        text = text.replace(f"{key}: ANSWER", f"{key}: {answer}")
    file.write_text(text)
    campaign = load_campaign(raw)
    commands = read_run(campaign, campaign.runs[0].id)[0].commands
    np.testing.assert_allclose(commands.value[:, 0], 0.5 * np.sin(3 * commands.time), atol=2e-3)
    with pytest.raises(BadInput, match="or a file of pulses"):
        look(write_lines(tmp_path / "note.txt", ["hello"]), tmp_path)


@every_log
def test_what_init_finds_of_commands_is_read_so(tmp_path, name):
    path = write_commands(tmp_path, name)
    held = look(path, tmp_path)
    candidate = held.drives[0]
    export = command_readers()[name].read(path, candidate.log())
    assert (held.format, candidate.format, candidate.kind) == (name, name, "pwm")
    np.testing.assert_array_equal(export.time, candidate.time)
    np.testing.assert_allclose(export.value, pwm.to_commands(candidate.value))


def swum(recording):
    """Positions and attitudes that were measured, as poses or each by itself."""
    if recording.posed:
        return recording.position, recording.attitude
    return recording.channels["position"].value, recording.channels["attitude"].value


@every_format
@pytest.mark.parametrize("world", ["z_up", "ned"])
@pytest.mark.parametrize("body", ["flu", "frd"])
def test_every_format_gives_the_swim_in_ned_and_frd(tmp_path, name, world, body):
    content = campaign_content(name)
    content["mocap"] |= {"world_axes": world, "body_axes": body}
    swim = Swim.ned()
    write_poses(tmp_path, name, swim.along(world, body))
    write_lines(tmp_path / "commands.csv", command_lines(name=name))
    campaign = load_campaign(write_campaign(tmp_path, content))
    if AXES.get(name, (world, body)) != (world, body):
        with pytest.raises(BadInput, match=f"the axes {world} and {body}"):
            read_run(campaign, "one")
        return
    recording, anomalies = read_run(campaign, "one")
    position, attitude = swum(recording)
    np.testing.assert_allclose(recording.time, swim.time, atol=1e-6)
    np.testing.assert_allclose(position, swim.position, atol=1e-6)
    np.testing.assert_allclose(matrix(attitude), swim.rotation, atol=3e-6)
    assert recording.tracked.all() == recording.posed
    assert recording.rate == pytest.approx(100.0)
    assert not any(anomalies.counts.values())
    assert usable_reason(recording) is None


@every_text
def test_windows_line_ends_and_a_byte_order_mark_change_nothing(tmp_path, name):
    plain, _ = read_run(load_campaign(write_run(tmp_path / "a", name)), "one")
    folder = write_run(tmp_path / "b", name)
    for file in (FORMATS[name], "commands.csv"):
        raw = (folder / file).read_bytes().replace(b"\n", b"\r\n")
        (folder / file).write_bytes(b"\xef\xbb\xbf" + raw)
    other, _ = read_run(load_campaign(folder), "one")
    np.testing.assert_array_equal(other.position, plain.position)
    np.testing.assert_array_equal(other.commands.value, plain.commands.value)


@every_text
def test_disorder_is_sorted_and_duplicates_dropped_and_counted(tmp_path, name):
    folder = write_run(tmp_path, name)
    lines = (folder / FORMATS[name]).read_text().splitlines()
    lines[-5], lines[-9] = lines[-9], lines[-5]
    lines.insert(len(lines) - 20, lines[-20])
    write_lines(folder / FORMATS[name], lines)
    recording, anomalies = read_run(load_campaign(folder), "one")
    np.testing.assert_allclose(recording.time, Swim.ned().time, atol=1e-9)
    np.testing.assert_allclose(recording.position, Swim.ned().position, atol=1e-6)
    assert (anomalies.motion.duplicates, anomalies.motion.unsorted) == (1, 2)


@every_text
def test_a_cut_last_line_is_counted_not_fatal(tmp_path, name):
    folder = write_run(tmp_path, name)
    text = (folder / FORMATS[name]).read_text()
    (folder / FORMATS[name]).write_text(text[:-25])
    recording, anomalies = read_run(load_campaign(folder), "one")
    assert len(recording.time) == len(Swim.ned().time) - 1
    assert anomalies.motion.cut_lines == 1
    assert any("cut short" in r for r in assess(recording, anomalies).remarks)


@every_format
def test_a_recording_survives_its_file(tmp_path, name):
    recording, _ = read_run(load_campaign(write_run(tmp_path, name)), "one")
    recording.write(tmp_path / "one.npz")
    again = Recording.read(tmp_path / "one.npz")
    np.testing.assert_array_equal(again.attitude, recording.attitude)
    signs = recording.site.axes[:, None]
    np.testing.assert_array_equal(again.site.tank, np.sort(signs * [[0, 10], [0, 5], [0, 3]]))
    assert again.run == recording.run


def test_a_short_run_and_a_still_one_are_flagged_not_fatal(tmp_path):
    short, anomalies = read_run(
        load_campaign(write_run(tmp_path / "short", swim=Swim.ned(frames=150))), "one"
    )
    report = assess(short, anomalies)
    assert usable_reason(short) == report.unusable
    assert "too short" in report.unusable
    assert "Record it again" in report.remarks[0]
    tiny, anomalies = read_run(
        load_campaign(write_run(tmp_path / "tiny", swim=Swim.ned(frames=3))), "one"
    )
    assert assess(tiny, anomalies).noise.position_m is None
    swim = Swim.ned()
    still = Swim(swim.time, np.ones_like(swim.position), np.tile(np.eye(3), (400, 1, 1)))
    recording, _ = read_run(load_campaign(write_run(tmp_path / "still", swim=still)), "one")
    assert "motionless" in usable_reason(recording)


def test_the_quality_report_knows_gaps_noise_and_quiet_axes(tmp_path):
    rng = np.random.default_rng(1)
    t = np.arange(6000) / 100.0
    position = np.stack([1 + np.sin(t), np.full_like(t, 2.0), np.full_like(t, 1.0)], axis=1)
    noisy = position + 1e-3 * rng.standard_normal(position.shape)
    swim = Swim(t, noisy, np.tile(np.eye(3), (6000, 1, 1)))
    folder = write_run(tmp_path, swim=swim)
    lines = (folder / FORMATS["qtm_tsv"]).read_text().splitlines()
    first = len(lines) - 6000
    write_lines(folder / FORMATS["qtm_tsv"], lines[: first + 1000] + lines[first + 1030 :])
    report = assess(*read_run(load_campaign(folder), "one"), outliers=7)
    assert [gap.start_s for gap in report.gaps] == pytest.approx([9.99])
    assert report.longest_gap_s == pytest.approx(0.31)
    assert report.noise.position_m == pytest.approx(1e-3, rel=0.05)
    assert report.noise.attitude_rad == pytest.approx(0.0, abs=1e-5)
    surge = report.excitation["surge"]
    assert surge.std == pytest.approx(np.sqrt(0.5), rel=0.03)
    assert [axis for axis, e in report.excitation.items() if e.excited] == ["surge"]
    assert report.outliers == 7
    assert any("sway, heave, roll" in remark for remark in report.remarks)
