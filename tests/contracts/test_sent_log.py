"""Logs of commands that are sent as they are: of one plan, and of some seconds."""

import errno
import hashlib
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest

from rovsim.application.pipeline import design
from rovsim.application.pipeline.design import Designed, write_flight
from rovsim.apps.cli.main import main
from rovsim.core.errors import BadInput
from rovsim.core.schema import checked
from rovsim.measurement.campaign_file import CommandLog
from rovsim.results.experiment import Expected, Experiment, Keeps, Start
from rovsim.simulation.synthetic_tank.sent_log import read_sent_log
from rovsim.simulation.synthetic_tank.settings import TankSettings

LOG = CommandLog(format="csv", kind="pwm", columns=("t1", "t2"))
NAMES = {"experiment.csv", "experiment.json", "experiment.pdf", "experiment.png"}


def lines(time, first=1500) -> str:
    """A log with a line at each time."""
    return "time_s,t1,t2\n" + "".join(f"{t:.4f},{first + k % 7},1500\n" for k, t in enumerate(time))


def planned(x: float, log: str) -> Designed:
    """What a design would write."""
    found = Experiment(
        seconds=10.0,
        model="nominal",
        commands_sha256=hashlib.sha256(log.encode()).hexdigest(),
        manoeuvre="designed",
        expects=Expected(),
        baselines={},
        start=Start(x_m=x, y_m=0.0, z_m=1.0, yaw_rad=0.5),
        instructions=(f"begin at {x}",),
        keeps=Keeps(nearest_wall_m=None, speed_m_s=1.0, turn_rate_rad_s=1.0, tilt_rad=0.1),
    )
    return Designed(found, log, None)


@pytest.fixture(autouse=True)
def quickly(monkeypatch):
    """A picture of nothing."""
    monkeypatch.setattr(design, "draw_flight", lambda picture: plt.figure(figsize=(1, 1)))


def test_a_plan_is_flown_from_its_own_start(tmp_path):
    write_flight(tmp_path, planned(2.0, lines(np.arange(500) / 50)))
    assert {path.name for path in tmp_path.iterdir()} == NAMES | {"instructions.txt"}
    sent = read_sent_log(tmp_path / "experiment.csv", LOG, up=True)
    assert sent.place == pytest.approx([2.0, 0.0, -1.0])
    assert sent.seconds == pytest.approx(10.0)


def test_a_disk_that_is_full_leaves_the_old_plan(tmp_path, monkeypatch):
    write_flight(tmp_path, planned(2.0, lines(np.arange(500) / 50)))
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def full(path: Path, text: str) -> None:
        if path.name == "instructions.txt":
            raise BadInput("full", where=path, expected="room", remedy=f"not {errno.ENOSPC}")
        path.write_text(text)

    monkeypatch.setattr(design, "write_text", full)
    with pytest.raises(BadInput, match="full") as refusal:
        write_flight(tmp_path, planned(5.0, lines(np.arange(500) / 50, 1600)))
    assert refusal.value.where == str(tmp_path / "instructions.txt")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_commands_of_another_plan_are_refused(tmp_path):
    write_flight(tmp_path, planned(2.0, lines(np.arange(500) / 50)))
    (tmp_path / "experiment.csv").write_text(lines(np.arange(500) / 50, 1600))
    with pytest.raises(BadInput, match=r"not those that experiment\.json describes"):
        read_sent_log(tmp_path / "experiment.csv", LOG, up=True)


def test_lines_are_sorted_by_time(tmp_path):
    path, time = tmp_path / "log.csv", np.arange(200) / 50
    path.write_text(lines(time[::-1]))
    sent = read_sent_log(path, LOG, up=True)
    assert sent.commands.time == pytest.approx(time)
    assert sent.seconds == pytest.approx(4.0)


@pytest.mark.parametrize("time", [[0.0], [0.0, 0.02], [0.0, 0.02, 1e9], [0.0, 0.02, 5000.0]])
def test_a_log_lasts_for_some_seconds(tmp_path, time):
    (tmp_path / "log.csv").write_text(lines(time))
    with pytest.raises(BadInput, match=r"lines of commands, which last .* 2 to 1800 s"):
        read_sent_log(tmp_path / "log.csv", LOG, up=True)


def test_a_run_of_the_tank_fits_into_memory():
    with pytest.raises(BadInput, match=r"'duration' is .* less than or equal to 7200"):
        checked(TankSettings, {"duration": 1e9}, "command line")


def test_a_log_without_a_plan_says_from_where_it_is_flown(tmp_path, capsys):
    path = tmp_path / "log.csv"
    names = ",".join(f"t{k}" for k in range(1, 9))
    path.write_text(
        f"time_s,{names}\n" + "".join(f"{k / 50},{'1500,' * 7}1500\n" for k in range(150))
    )
    runs = "tank.runs=[{id: a, control: 6dof, split: train}]"
    main(["tank", "tank=tiny", "tank.duration=3", runs, f"fly={path}", f"out={tmp_path / 'c'}"])
    said = capsys.readouterr().out
    assert f"No log.json lies beside {path}: it is flown from the middle of the tank (x " in said
