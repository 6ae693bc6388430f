"""Where the vehicle file is off and a law is unknown, intervals hold what the vehicle is."""

import numpy as np
import pytest

from rovsim.benchmarks.blind.asking import diagnosis
from rovsim.benchmarks.blind.flight import fly
from rovsim.benchmarks.blind.suites import outside_wrong_file

MAX_MISS_STDS = 4.0  # beside a law its values were 20 to 60 standard deviations off


@pytest.mark.thorough
def test_values_beside_a_law_are_no_surer_than_the_rest_of_the_file(tmp_path):
    flown = fly(outside_wrong_file("coupled_cubic", "development"), tmp_path / "raw")
    truth = {one.effect: one.parameters for one in flown.hidden}
    found = diagnosis(tmp_path / "raw", tmp_path / "out")
    assert found.verdict == "unexplained"
    assert found.unexplained.proposal is not None
    assert {one.effect for one in found.selected} <= set(truth)
    misses = [
        (value.value - truth[one.effect][name].value) / value.std
        for one in found.selected
        for name, value in one.parameters.items()
        if name in truth[one.effect]
    ]
    assert len(misses) > 10
    assert np.max(np.abs(misses)) < MAX_MISS_STDS
