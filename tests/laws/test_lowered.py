"""Where a change of the model shows on the user's data."""

import numpy as np
import pytest

from rovsim import AXES
from rovsim.evaluation.error_conditions.lowered import find_most_lowered
from rovsim.results.error_conditions import ConditionTable, ErrorSize, ModelConditions


def table(*mean, edges=(0.0, 1.0, 2.0, 3.0), judged=(True, True, True)):
    """Means of three bins of ten blocks each."""
    n = len(mean)
    return ConditionTable(
        unit="m/s", share_of_error=0.5, edges=edges[: n + 1], center=tuple(np.arange(n) + 0.5),
        blocks=(10,) * n, effective=(10.0,) * n, judged=judged[:n], mean=mean,
        std_error=(0.01,) * n, rms=mean,
    )  # fmt: skip


def conditions(**axes):
    """Tables of some axes; each axis was measured to accelerate by 1."""
    return ModelConditions(
        split="train", runs=("a",), enough=True, sentences=(), findings=(),
        error={axis: ErrorSize(rms=0.1, measured_rms=1.0) for axis in AXES}, axes=axes,
    )  # fmt: skip


def test_the_axis_and_condition_at_which_most_is_gone():
    before = conditions(
        surge={"surge speed": table(0.1, 0.2, 0.3), "depth": table(0.2, 0.2, 0.2)},
        sway={"sway speed": table(0.4, 0.0, 0.4)},
    )
    after = conditions(
        surge={"surge speed": table(0.0, 0.0, 0.0), "depth": table(0.2, 0.2, 0.1)},
        sway={"sway speed": table(0.4, 0.0, 0.4)},
    )
    found = find_most_lowered(before, after)
    assert (found.axis, found.condition) == ("surge", "surge speed")
    assert found.removed == pytest.approx(np.mean([0.01, 0.04, 0.09]))


def test_a_steady_force_is_shown_over_the_motion_of_its_own_axis():
    gone, there = table(0.0, 0.0, 0.0), table(0.1, 0.1, 0.1)
    names = ("roll thrust", "heave speed", "depth")
    before, after = (conditions(heave=dict.fromkeys(names, t)) for t in (there, gone))
    assert find_most_lowered(before, after).condition == "heave speed"


def test_what_was_seldom_met_or_is_binned_otherwise_shows_nothing():
    rare = {"judged": (True, False, True)}
    before = conditions(
        heave={"depth": table(0.0, 0.5, 0.0, **rare), "speed": table(0.1, 0.1, 0.1)}
    )
    other = table(0.0, 0.0, 0.0, edges=(0.0, 1.5, 2.0, 3.0))
    after = conditions(heave={"depth": table(0.0, 0.0, 0.0, **rare), "speed": other})
    assert find_most_lowered(before, after) is None
    assert find_most_lowered(before, before) is None
