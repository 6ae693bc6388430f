"""What hardly moves a vehicle within 2 s is named where it leaves something to be seen."""

import pytest

from rovsim.benchmarks.blind.asking import diagnosis
from rovsim.benchmarks.blind.flight import fly
from rovsim.benchmarks.blind.suites import suite

CASE = "weak 0.25/fin_effectiveness/1"  # of the seeds for development


@pytest.mark.thorough
def test_fins_that_grip_a_little_less_are_named_and_nothing_in_their_place(tmp_path):
    (case,) = (one for one in suite("full", "development") if one.id == CASE)
    flown = fly(case, tmp_path / "raw")
    found = diagnosis(tmp_path / "raw", tmp_path / "out")
    assert found.verdict == "missing_effects"
    (fins,) = found.selected
    assert fins.effect == "fin_effectiveness"
    ((name, truth),) = flown.hidden[0].parameters.items()
    value = fins.parameters[name]
    assert abs(value.value - truth.value) < 4.0 * value.std
