"""Where a change of the model shows on the user's data."""

import numpy as np
import pytest

from rovsim.core.axes import AXES
from rovsim.dynamics.catalogue import built_in
from rovsim.evaluation.error_conditions.conditions import Blocks, Condition
from rovsim.evaluation.error_conditions.lowered import find_most_lowered

TIME = 0.5 * np.arange(240)
VALUES = {
    Condition("throughout", "", "throughout"): 0.0 * TIME,
    Condition("surge speed", "m/s", "speed", "surge"): np.sin(TIME),
    Condition("sway speed", "m/s", "speed", "sway"): np.sin(1.3 * TIME),
    Condition("yaw rate", "rad/s", "speed", "yaw"): np.sin(0.7 * TIME),
    Condition("surge thrust", "N", "thrust", "surge"): np.sin(TIME) + 0.2 * np.cos(2.1 * TIME),
    Condition("sway thrust", "N", "thrust", "sway"): np.cos(1.7 * TIME),
    Condition("heave thrust", "N", "thrust", "heave"): np.cos(0.9 * TIME),
    Condition("heading", "rad", "attitude", "yaw"): np.sin(0.3 * TIME),
    Condition("time in the run", "s", "time"): TIME,
}
BY_NAME = {condition.name: values for condition, values in VALUES.items()}


def blocks(accelerations=1.0, **errors):
    """Blocks of one run; errors by axis."""
    error = np.zeros((len(TIME), 6))
    for axis, values in errors.items():
        error[:, AXES.index(axis)] = values
    measured = np.full_like(error, accelerations)
    run = np.zeros(len(TIME), int)
    return Blocks(error, measured, VALUES, TIME, run, np.ones(6, bool))


NONE = blocks()


def declared(effect):
    return built_in()[effect].signature


def test_without_a_declaration_the_axis_and_condition_at_which_most_is_gone():
    before = blocks(surge=0.3 * BY_NAME["surge speed"], sway=0.2 * BY_NAME["sway speed"])
    found = find_most_lowered(before, NONE, None)
    assert (found.axis, found.condition.name) == ("surge", "surge speed")
    assert found.removed == pytest.approx(0.045, rel=0.1)


@pytest.mark.parametrize(
    ("effect", "before", "shown"),
    [
        ("thrust_asymmetry", {"surge": BY_NAME["surge speed"]}, ("surge", "surge thrust")),
        ("thrust_asymmetry", {"sway": np.abs(BY_NAME["sway thrust"])}, ("sway", "sway thrust")),
        ("quadratic_damping", {"surge": BY_NAME["surge thrust"]}, ("surge", "surge speed")),
        (
            "coupled_damping",
            {"yaw": BY_NAME["yaw rate"] + BY_NAME["sway speed"]},
            ("yaw", "sway speed"),
        ),
        ("current", {"surge": BY_NAME["surge speed"]}, ("surge", "heading")),
        ("voltage_sag", {"sway": TIME * BY_NAME["sway thrust"]}, ("sway", "time in the run")),
    ],
)
def test_an_effect_is_shown_over_its_own_condition(effect, before, shown):
    """Though more is gone from the bins of another one."""
    found = find_most_lowered(blocks(**before), NONE, declared(effect))
    assert (found.axis, found.condition.name) == shown
    assert found.size == declared(effect).size


def test_added_mass_is_shown_over_the_acceleration():
    measured = np.outer(np.cos(TIME), np.ones(6))
    found = find_most_lowered(
        blocks(measured, surge=0.4 * np.cos(TIME)), blocks(measured), declared("added_mass")
    )
    assert (found.axis, found.condition.name) == ("surge", "surge acceleration")


def test_an_effect_is_shown_on_an_axis_on_which_it_acts():
    before = blocks(surge=0.1 * BY_NAME["surge speed"], sway=BY_NAME["sway speed"])
    found = find_most_lowered(before, NONE, declared("quadratic_damping"), ["surge"])
    assert (found.axis, found.condition.name) == ("surge", "surge speed")


def test_where_its_condition_was_not_measured_any_other_shows_it():
    found = find_most_lowered(
        blocks(surge=0.3 * BY_NAME["surge speed"]), NONE, declared("wall_proximity")
    )
    assert found.condition.name == "surge speed"


def test_a_steady_force_is_shown_over_the_motion_of_its_own_axis():
    found = find_most_lowered(blocks(sway=0.1), NONE, None)
    assert found.condition.name in ("sway speed", "sway thrust")


def test_what_did_not_fall_or_is_of_other_blocks_shows_nothing():
    before = blocks(surge=BY_NAME["surge speed"])
    assert find_most_lowered(before, before, None) is None
    other = Blocks(**{**vars(NONE), "time": TIME + 0.1})
    assert find_most_lowered(before, other, None) is None
