"""What speaks against a campaign that was described by hand is said; nothing where all is well."""

import re
import shutil
from dataclasses import replace
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recordings import campaign_content, write_campaign, write_run
from rovsim.application.pipeline.quality import judge_recording
from rovsim.application.pipeline.recorded_run import load_campaign_vehicle, read_recording
from rovsim.apps.cli.main import main
from rovsim.core.errors import BadInput
from rovsim.core.rotations import conjugate, from_euler, to_euler
from rovsim.core.shipped import conf_names
from rovsim.core.yaml_files import read_yaml, write_yaml
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.dynamics.vehicle.implausible_numbers import doubt_units
from rovsim.evaluation.commanded_motion.clocks import tell_following
from rovsim.evaluation.commanded_motion.cross_correlation import cross_correlate
from rovsim.evaluation.commanded_motion.doubts import find_doubts
from rovsim.evaluation.commanded_motion.predicted import cause
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording.repairs import Anomalies, CommandRepairs, MotionRepairs
from rovsim.measurement.rough_motion import estimate_velocities
from rovsim.measurement.signals.outliers import KeepAll
from said import unfolded

LATER_S = 60.0  # from the begin of one run to that of the next, on one log


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A synthetic campaign as it should be."""
    out = tmp_path_factory.mktemp("tank") / "sound"
    main(["tank", "tank=tiny", "tank.duration=20", f"out={out}"])
    return out


@pytest.fixture
def campaign(sound, tmp_path):
    """A copy of it to spoil."""
    return Path(shutil.copytree(sound, tmp_path / "campaign"))


def doubts(folder: Path, place: int = 0) -> str:
    """What is said against one of its runs."""
    campaign = load_campaign(folder)
    read = read_recording(campaign, campaign.runs[place].id)
    quality = judge_recording(campaign, *read, KeepAll(kind="none"))
    assert quality.remarks[: len(quality.doubts)] == quality.doubts
    return " ".join(quality.doubts)


def described(folder: Path, change) -> str:
    """What is said after a change of the campaign's description."""
    content = read_yaml(folder / "campaign.yaml")
    change(content)
    write_yaml(folder / "campaign.yaml", content)
    return doubts(folder)


def rewritten(folder: Path, change) -> str:
    """What is said after a change of the table of commands (m, 1 + c) of the first run."""
    path = folder / load_campaign(folder).runs[0].commands
    head = path.read_text().splitlines()[0]
    table = change(np.loadtxt(path, delimiter=",", skiprows=1))
    np.savetxt(path, table, delimiter=",", header=head, comments="", fmt="%.6g")
    return doubts(folder)


def test_nothing_is_said_against_a_sound_campaign(sound):
    for place in range(len(load_campaign(sound).runs)):
        assert doubts(sound, place) == ""


def test_what_was_repaired_is_kept_until_a_run_is_judged(tmp_path):
    repairs = MotionRepairs(duplicates=np.int64(2)), CommandRepairs(clipped=1)
    anomalies = Anomalies(*repairs, 7, ((0.1, 1.0), (1.5, 1e9 / 3)), ("It’s „cut“.",))
    anomalies.write(tmp_path / "run.json")
    assert Anomalies.read(tmp_path / "run.json") == anomalies


def test_wrong_body_axes_hang_the_vehicle_upside_down(campaign):
    said = described(campaign, lambda c: c["mocap"].update(body_axes="frd"))
    assert "upside down" in said
    assert "'mocap.body_axes'" in said


def test_both_axes_wrong_leave_it_upright_and_moving_the_other_way(campaign):
    said = described(campaign, lambda c: c["mocap"].update(body_axes="frd", world_axes="ned"))
    assert "upside down" not in said
    assert "sway shows as −sway" in said


def other_signs(attitude, *signs):
    """Attitudes (n, 4) whose roll, pitch and yaw count the other way."""
    return from_euler(*(to_euler(attitude) * signs).T)


def other_order(attitude):
    """Attitudes (n, 4) whose angles are written for R = Rx(roll) Ry(pitch) Rz(yaw)."""
    return from_euler(*Rotation.from_quat(attitude, scalar_first=True).as_euler("XYZ").T)


KEPT = np.eye(3)
CONVENTIONS = {
    "the inverse of the attitudes": (conjugate, KEPT),
    "the sign of yaw turned": (lambda q: other_signs(q, 1, 1, -1), KEPT),
    "the sign of pitch turned": (lambda q: other_signs(q, 1, -1, 1), KEPT),
    "R = Rx(roll) Ry(pitch) Rz(yaw)": (other_order, KEPT),
    "y, x, −z in place of x, y, z": (
        np.array,
        np.array([[0, -1, 0], [-1, 0, 0], [0, 0, -1]]),
    ),
}


def spoiled(recording, change, turn=KEPT):
    """A recording with attitudes and positions of another convention."""
    attitude = recording.attitude.copy()
    attitude[recording.tracked] = change(attitude[recording.tracked])
    return replace(recording, attitude=attitude, position=recording.position @ turn)


@pytest.mark.parametrize("told", CONVENTIONS)
def test_attitudes_by_another_convention_are_told(sound, told):
    campaign = load_campaign(sound)
    recording, _ = read_recording(campaign, "6dof-2")
    doubt, *_ = find_doubts(spoiled(recording, *CONVENTIONS[told]), load_campaign_vehicle(campaign))
    assert doubt.startswith("Positions and attitudes do not go together")
    assert told in doubt


def test_init_tells_of_inverse_quaternions(sound, tmp_path, capsys):
    campaign = load_campaign(sound)
    for run in campaign.runs:
        recording = spoiled(read_recording(campaign, run.id)[0], conjugate)
        table = np.column_stack([recording.time, recording.position, recording.attitude])
        head = "time_s,x_m,y_m,z_m,qw,qx,qy,qz"
        path = tmp_path / f"{run.id}_poses.csv"
        np.savetxt(path, table[recording.tracked], delimiter=",", header=head, comments="")
        shutil.copy(sound / run.commands, tmp_path / f"{run.id}_commands.csv")
    main(["init", str(tmp_path)])
    said = unfolded(capsys.readouterr().out)
    assert "6dof-1: positions and attitudes do not go together" in said
    assert "with the inverse of the attitudes" in said
    assert "turn the signs of qx, qy and qz" in said


def test_the_log_of_another_run_is_not_followed(campaign):
    rng = np.random.default_rng(1)

    def shuffle(table):
        blocks = np.array_split(table[:, 1:], len(table) // 5)
        order = rng.permutation(len(blocks))
        return np.column_stack([table[:, 0], np.vstack([blocks[k] for k in order])])

    assert re.search("hardly follows its commands|along other axes", rewritten(campaign, shuffle))


@pytest.mark.parametrize(("own", "other"), [*permutations(range(3), 2)])
def test_a_run_that_names_the_log_of_another_is_told_so(campaign, own, other):
    content = read_yaml(campaign / "campaign.yaml")
    content["runs"][own]["commands"] = content["runs"][other]["commands"]
    write_yaml(campaign / "campaign.yaml", content)
    said = doubts(campaign, own)
    named = content["runs"][other]["id"]
    assert said.startswith(f"Run {named} names the same log of commands, and this motion is unlike")
    assert "body_axes" not in said
    assert doubts(campaign, other) == ""


def on_one_log(campaign) -> None:
    """Put the first two runs of a campaign on one log, and its clock."""
    content = read_yaml(campaign / "campaign.yaml")
    first, second, *_ = content["runs"]
    logs = [(campaign / run["commands"]).read_text().splitlines() for run in (first, second)]
    later = [line.split(",", 1) for line in logs[1][1:]]
    lines = logs[0] + [f"{float(time) + LATER_S:.4f},{rest}" for time, rest in later]
    (campaign / "day.csv").write_text("\n".join(lines) + "\n")
    first["commands"] = second["commands"] = "day.csv"
    second["commands_shift_s"] = -LATER_S
    write_yaml(campaign / "campaign.yaml", content)


def test_nothing_is_said_of_runs_that_are_parts_of_one_log(campaign):
    on_one_log(campaign)
    assert doubts(campaign, 0) == doubts(campaign, 1) == ""


def test_wrong_axes_are_told_of_parts_of_one_log_too(campaign):
    on_one_log(campaign)
    said = described(campaign, lambda c: c["mocap"].update(body_axes="frd", world_axes="ned"))
    assert "sway shows as −sway" in said


@pytest.mark.parametrize("late", [3.0, -2.0])
def test_a_clock_that_differs_is_put_right_by_what_is_said(campaign, late):
    def shift(table):
        return np.column_stack([table[:, 0] - late, table[:, 1:]])

    said = rewritten(campaign, shift)
    found = re.search(r"add ([-+]\d+\.\d) s to the times of the commands", said)
    assert float(found.group(1)) == pytest.approx(late, abs=0.25)
    assert "let `input_delay` find it" not in said


def test_a_time_zone_is_told_without_a_remainder_of_nothing(campaign):
    vehicle = load_campaign_vehicle(load_campaign(campaign))
    recording, _ = read_recording(load_campaign(campaign), "6dof-1")
    caused = cause(vehicle, recording.commands, 0.0, 120.0)
    lag = cross_correlate(estimate_velocities(recording), *caused).best(np.eye(3))[1]
    for rest, told in (
        (0.0, "Add +7200 s to the times of the commands (`comm"),
        (5.0, "the +5.0 s"),
    ):
        late = 7200.0 + rest - lag
        found = cross_correlate(estimate_velocities(recording), caused[0] - late, caused[1], late)
        assert told in tell_following(found, np.eye(3))


@pytest.mark.parametrize("by", [40.0, 1.7e9])
def test_commands_of_another_clock_are_shifted_by_what_the_run_says(tmp_path, by):
    folder = write_run(tmp_path)
    expected, _ = read_recording(load_campaign(folder), "one")
    head, *rows = (folder / "commands.csv").read_text().splitlines()
    times, rest = zip(*(row.split(",", 1) for row in rows), strict=True)
    later = [f"{float(t) + by:.4f},{others}" for t, others in zip(times, rest, strict=True)]
    (folder / "commands.csv").write_text("\n".join([head, *later]))
    with pytest.raises(BadInput, match="commands_shift_s"):
        read_recording(load_campaign(folder), "one")
    content = campaign_content()
    content["runs"][0]["commands_shift_s"] = -by
    shifted, _ = read_recording(load_campaign(write_campaign(folder, content)), "one")
    np.testing.assert_allclose(shifted.commands.time, expected.commands.time, atol=1e-6)
    np.testing.assert_array_equal(shifted.commands.value, expected.commands.value)


def test_times_of_commands_in_ms_are_refused(campaign):
    with pytest.raises(BadInput, match="ms, us or ns"):
        rewritten(campaign, lambda table: table * np.array([1e3, *[1.0] * (table.shape[1] - 1)]))


def test_a_log_that_ends_while_pushing_is_told(campaign):
    assert "ends" in rewritten(campaign, lambda table: table[: len(table) // 2])


def test_a_log_that_begins_while_pushing_is_told(campaign):
    assert "begins" in rewritten(campaign, lambda table: table[len(table) // 2 :])


def test_holes_of_a_log_are_told(campaign):
    assert "holes: 1, of up to" in rewritten(
        campaign, lambda table: np.delete(table, slice(len(table) // 3, len(table) // 2), axis=0)
    )


def test_metres_in_place_of_millimetres_are_told(campaign):
    poses = campaign / load_campaign(campaign).runs[0].mocap
    lines = poses.read_text().splitlines()
    first = next(k for k, line in enumerate(lines) if line.startswith("Frame\t")) + 1
    rows = [line.split("\t") for line in lines[first:]]
    metres = [[*row[:2], *(f"{1e-3 * float(x):.6f}" for x in row[2:5]), *row[5:]] for row in rows]
    poses.write_text("\n".join([*lines[:first], *("\t".join(row) for row in metres)]))
    assert "a thousand times too small" in doubts(campaign)


def test_a_tank_that_is_too_small_is_told(campaign):
    said = described(campaign, lambda c: c.update(tank={"z": [4.0, 5.0]}))
    assert "outside of the tank: z from" in said
    said = described(campaign, lambda c: c.update(tank={"z": [-5.0, -4.0]}))
    assert "'tank' says −5 to −4" in said


def test_a_test_run_that_was_trained_on_is_told_at_the_end_of_compare(
    campaign, few_figures, tmp_path, capsys
):
    content = read_yaml(campaign / "campaign.yaml")
    train = next(run for run in content["runs"] if run["split"] == "train")
    shutil.copy(campaign / train["mocap"], campaign / "again.tsv")
    content["runs"] = [train, {**train, "id": "again", "split": "test", "mocap": "again.tsv"}]
    write_yaml(campaign / "campaign.yaml", content)
    main(["compare", f"campaign={campaign}", f"out={tmp_path / 'out'}"])
    said = unfolded(capsys.readouterr().out)
    assert "check the recordings first" in said
    assert f"again: This test run holds the recording of train run {train['id']}" in said


def test_millimetres_in_a_column_of_metres_are_refused(tmp_path):
    from rovsim.measurement.recording.csv_checks import check_plausible

    time = np.arange(0.0, 20.0, 0.05)
    swim = {name: 0.5 * np.sin(0.5 * time + k) for k, name in enumerate(("x_m", "y_m", "z_m"))}
    check_plausible(tmp_path, time, swim)
    with pytest.raises(BadInput, match="mm or cm"):
        check_plausible(tmp_path, time, {name: 1e3 * x for name, x in swim.items()})


LAKE = "tank.tank={x: [0, 200], y: [0, 200], z: [0, 30]}"


@pytest.mark.parametrize("vehicle", ["remus100", "cybership2", "otter"])
def test_nothing_is_said_of_vehicles_that_cannot_push_sideways(tmp_path, vehicle):
    out = tmp_path / vehicle
    main(["tank", "tank=tiny", f"tank.vehicle={vehicle}", LAKE, "tank.duration=40", f"out={out}"])
    assert not any(doubts(out, k) for k in range(len(load_campaign(out).runs)))
    if vehicle == "otter":
        recording, _ = read_recording(load_campaign(out), load_campaign(out).runs[0].id)
        turned = np.diag([-1.0, -1.0, 1.0])
        backwards = replace(recording, position=recording.position @ turned)
        assert find_doubts(backwards, load_campaign_vehicle(load_campaign(out)))


def parted(recording):
    """The same recording, all but its first quarter 150 s later, with its commands; and when."""
    begin = float(np.quantile(recording.time, 0.25))

    def moved(time):
        return np.where(time > begin, time + 150.0, time)

    commands = replace(recording.commands, time=moved(recording.commands.time))
    return replace(recording, time=moved(recording.time), commands=commands), begin


def test_nothing_is_said_of_a_span_that_begins_late_in_a_long_file(sound):
    campaign = load_campaign(sound)
    recording, begin = parted(read_recording(campaign, campaign.runs[0].id)[0])
    used = replace(recording, tracked=recording.tracked & (recording.time > begin))
    assert find_doubts(used, load_campaign_vehicle(campaign)) == ()


def test_nothing_is_said_of_motion_with_a_pause_longer_than_what_is_looked_at(sound):
    campaign = load_campaign(sound)
    recording, _ = parted(read_recording(campaign, campaign.runs[0].id)[0])
    assert find_doubts(recording, load_campaign_vehicle(campaign)) == ()


def in_other_units(vehicle, place, value):
    """A vehicle file's content with another value at a dotted place."""
    content = load_vehicle(vehicle).model_dump(mode="json", by_alias=True, exclude_unset=True)
    *above, key = place.split(".")
    section = content
    for part in above:
        section = section[int(part) if part.isdigit() else part]
    section[key] = value
    return content


@pytest.mark.parametrize(
    ("place", "value", "told"),
    [
        ("fluid.density", 1.0, "fluid.density: 1 is that of no water. In kg/m3?"),
        ("fluid.gravity", 981.0, "fluid.gravity: 981"),
        ("rigid_body.mass", 13500.0, "a mass of 13500 kg, and its displaced_volume holds 13.4 kg"),
        ("rigid_body.displaced_volume", 13.4, "holds 13400 kg of water. In kg, and in m3?"),
        ("rigid_body.inertia.Ixx", 2600.0, "rigid_body.inertia.Ixx: 2600 with a mass of 13.5"),
        ("rigid_body.center_of_buoyancy", [0.0, 0.0, -10.0], "center_of_buoyancy: 0, 0, -10"),
        ("thrusters.units.1.position", [156.4, -110.4, 85.0], "thruster t2, position: 156.4"),
    ],
)
def test_a_vehicle_file_in_other_units_is_told(campaign, place, value, told):
    write_yaml(campaign / "mine.yaml", in_other_units("bluerov2_heavy", place, value))
    assert told in described(campaign, lambda content: content.update(vehicle="mine.yaml"))


@pytest.mark.parametrize("vehicle", conf_names("vehicle"))
def test_nothing_is_said_of_the_units_of_vehicles_that_come_with_it(vehicle):
    assert doubt_units(load_vehicle(vehicle)) == ()
