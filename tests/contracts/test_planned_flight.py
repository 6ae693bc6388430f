"""A planned flight as it is told: its picture and its instructions."""

import numpy as np

from rovsim.application.pipeline.design import format_instructions
from rovsim.core.run import Commands
from rovsim.design.instructions import instruct
from rovsim.design.search import Tried
from rovsim.design.settings import FlightLimits
from rovsim.reporting.figures.planned_flight import PlannedFlight, draw_flight
from rovsim.reporting.words.experiment import list_steps
from rovsim.results.experiment import Start

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
    flight = Tried(
        np.zeros((1, 6)), 0.0, Commands(np.zeros(1), np.zeros((1, 2)), "demand"), 0.0, None,
        numbers=np.zeros(11),
    )  # fmt: skip
    start = Start(x_m=-1.25, y_m=0.5, z_m=-0.001, yaw_rad=np.radians(-112.0))
    where = instruct(flight, np.array([0, 5]), start, FlightLimits())[0]
    assert where.startswith("Put the vehicle to x −1.25 m, y 0.50 m, z 0.00 m in the ")
    assert "yaw −112 degrees: level" in where
