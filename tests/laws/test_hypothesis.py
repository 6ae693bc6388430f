"""What is fitted once is looked up by its hypothesis: others must not pass for the same."""

from dataclasses import replace

import pytest

from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.damping import LinearDamping, QuadraticDamping
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.vehicle import default_vehicle
from rovsim.estimation.observer.hypothesis import Bounds, Hypothesis, Term
from worlds import model

DRAG = Term(QuadraticDamping(surge=3.0), ("surge",))
BASE = model()


def test_a_hypothesis_made_anew_is_the_same():
    again = Hypothesis(BASE.called("another"), (replace(DRAG),))
    assert {again.key: 1}[Hypothesis(BASE, (DRAG,)).key] == 1
    assert (BASE + PoseFilter(cutoff=6.0)).vehicle is BASE.vehicle


@pytest.mark.parametrize(
    ("base", "term"),
    [
        (BASE + LinearDamping(surge=5.0), DRAG),
        (BASE + PoseFilter(cutoff=6.0), DRAG),
        (replace(BASE, vehicle=default_vehicle()), DRAG),
        (BASE, replace(DRAG, bounds={"surge": Bounds(0.0, 4.0)})),
        (BASE, replace(DRAG, free=("surge", "sway"))),
        (BASE, replace(DRAG, effect=QuadraticDamping(surge=4.0))),
        (BASE, Term(AddedMass(surge=3.0), ("surge",))),
    ],
    ids=["effects", "camera", "vehicle", "bounds", "free", "values", "effect"],
)
def test_another_base_or_term_is_another_hypothesis(base, term):
    assert Hypothesis(base, (term,)).key != Hypothesis(BASE, (DRAG,)).key
