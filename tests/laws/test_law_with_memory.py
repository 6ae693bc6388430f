"""Laws with a memory: their files move the vehicle as they do, and they can do without a part."""

import numpy as np
import pytest

from rovsim.diagnosis.equations.form import get_law
from rovsim.diagnosis.equations.with_memory import FORMS, Wake
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import at_rest, model, motion, sticks, write_and_read


def fly(*effects):
    """States (n, 13) of a vehicle with these effects under the same sticks."""
    run = motion(sticks(7, 30), seconds=4.0)
    whole = [(0, len(run.time) - 1, at_rest())]
    return simulate(model(*effects), run, whole, ReplaySettings(step=0.01))[0]


@pytest.mark.parametrize("kind", FORMS, ids=lambda kind: kind.__name__)
def test_the_file_of_a_law_with_a_memory_moves_the_vehicle_as_the_law_does(kind, tmp_path):
    form, law = kind.begin(("sway", "yaw"))[-1]
    cls, written = write_and_read(form, law, tmp_path)
    bare, known, own, idle = fly(), fly(law.effect), fly(written), fly(cls())
    np.testing.assert_allclose(own, known, atol=1e-12)
    np.testing.assert_array_equal(idle, bare)  # without values it does nothing
    assert np.abs(own - bare).max() > 1e-3


def test_a_wake_can_do_without_each_axis():
    form, law = Wake.begin(("surge", "sway"))[0]
    simpler = form.simplify(Hypothesis(model(), (law,)))
    assert [fewer.names for fewer, _ in simpler] == [("sway",), ("surge",)]
    for fewer, h in simpler:
        (axis,), left = fewer.names, get_law(h)
        assert left.free == (axis, "time_constant")
        assert set(left.effect.given()) == {axis, "time_constant"}
        assert fewer.simplify(h) == []
