"""A planned flight as it is told: its picture and its instructions."""

import numpy as np

from rovsim.application.pipeline.design import format_instructions
from rovsim.core.run import Commands
from rovsim.design.instructions import instruct
from rovsim.design.search import CandidateFlight
from rovsim.design.settings import FlightLimits
from rovsim.reporting.figures.planned_flight import PlannedFlight, draw_flight
from rovsim.reporting.words.experiment import list_steps, tell_experiment
from rovsim.results.experiment import Expected, Experiment, Keeps, Start, Surer

TOLD = (
    "Put it there.",
    "Send it.",
    "By hand, instead of step 2:",
    "Surge: swing it.",
    "Leave sway.",
)


def a_flight(names):
    path = np.random.default_rng(0).uniform(0.0, 3.0, (2, 50, 3))
    time = np.linspace(0.0, 5.0, 50)
    values = np.outer(np.sin(time), np.arange(1.0, len(names) + 1.0))
    return PlannedFlight(path, np.full((3, 2), np.nan), time, values, tuple(names), "µs")


def test_its_picture_says_what_the_paths_are_and_tells_commands_apart():
    names = [f"t{k}" for k in range(1, 13)]
    figure = draw_flight(a_flight(names))
    (legend,) = figure.legends
    told = [text.get_text() for text in legend.get_texts()]
    assert told == ["likeliest path", "where else it may lead", "start"]
    lines = figure.axes[-1].lines
    assert [line.get_label() for line in lines] == names
    assert len({(line.get_color(), line.get_linestyle()) for line in lines}) == len(names)


def test_what_is_done_by_hand_stands_under_the_step_that_it_replaces():
    assert list_steps(TOLD) == [(TOLD[0], []), (TOLD[1], []), (TOLD[2], [*TOLD[3:]])]
    assert list_steps(TOLD[:2]) == [(TOLD[0], []), (TOLD[1], [])]
    assert list_steps(()) == []
    lines = format_instructions(TOLD).split("\n\n")
    assert lines[1:4] == ["2. Send it.", "3. By hand, instead of step 2:", "   * Surge: swing it."]


def test_places_and_angles_below_zero_have_a_minus_sign():
    flight = CandidateFlight(
        np.zeros((1, 6)),
        0.0,
        Commands(np.zeros(1), np.zeros((1, 2)), "demand"),
        0.0,
        None,
        numbers=np.zeros(11),
    )
    start = Start(x_m=-1.25, y_m=0.5, z_m=-0.001, yaw_rad=np.radians(-112.0))
    where = instruct(flight, np.array([0, 5]), start, FlightLimits())[0]
    assert where.startswith("Put the vehicle to x −1.25 m, y 0.50 m, z 0.00 m in the ")
    assert "yaw −112 degrees: level" in where


def test_units_of_what_it_tells_are_written_as_everywhere():
    std = {
        "linear_damping.yaw": Surer(now=0.5, then=0.1, unit="N m s2/rad2"),
        "lift.factor": Surer(now=0.5, then=None, unit="1"),
    }
    found = Experiment(
        seconds=60.0,
        model="nominal",
        manoeuvre="designed",
        expects=Expected(std=std),
        baselines={},
        start=Start(x_m=0.0, y_m=0.0, z_m=1.0, yaw_rad=0.0),
        instructions=(),
        keeps=Keeps(nearest_wall_m=None, speed_m_s=1.0, turn_rate_rad_s=1.0, tilt_rad=0.1),
    )
    said = tell_experiment(found)
    assert "linear_damping.yaw: ± 0.20 N m s²/rad² (now ± 0.98 N m s²/rad²)" in said
    assert "lift.factor: ± – (now ± 0.98)" in said
    assert "± is the 95 % interval." in said
