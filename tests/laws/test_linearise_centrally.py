"""Derivatives by central differences: right to second order, wherever a range ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests import worlds

from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.residual_source import linearise, linearise_centrally

BASE = worlds.model()
SCALE = ThrusterLag.parameters[0].scale


def squared(models):
    """Errors (m, 6, 1) that are the square of a time constant, in its scale, on one run."""
    values = [next(e["time_constant"] for e in m.effects if e.id == "thruster_lag") for m in models]
    return [np.array([np.full((6, 1), (value / SCALE) ** 2) for value in values])]


@given(st.floats(0.0, 5.0))
def test_the_slope_of_a_square_is_exact_also_near_the_end_of_a_range(x):
    at = Hypothesis(BASE, (Term(ThrusterLag(time_constant=x * SCALE), ("time_constant",)),))
    one_sided, central = (f(at, squared).J[0][0, 0, 0] for f in (linearise, linearise_centrally))
    assert one_sided == pytest.approx(2.0 * x + at.steps[0])
    if x > at.steps[0]:
        assert central == pytest.approx(2.0 * x, rel=1e-5)
