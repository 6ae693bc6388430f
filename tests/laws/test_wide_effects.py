"""An effect of many parameters gives way to several narrower ones that are likelier together."""

from types import SimpleNamespace

import pytest

from rovsim.diagnosis.selection.proposals import Proposal
from rovsim.diagnosis.selection.wide_effects import spread_wide
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.buoyancy import BuoyancyCenter
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from worlds import model

WIDE = Term(AddedMass(surge=1.0), ("surge", "sway", "heave", "roll"))
FEW = Term(AddedMass(surge=1.0), ("surge", "sway"))
NARROW = Term(BuoyancyCenter(z=0.01), ("z",))
MORE = Term(BuoyancyCenter(x=0.01, z=0.01), ("x", "z"))  # what a search that goes on ends with


class Searched:
    """A workspace in which a fit is its hypothesis, and a score depends on its terms alone."""

    penalty = 10.0

    def __init__(self, first: Term, explains: float, together: float) -> None:
        rest = SimpleNamespace(
            ss_increase=200.0,
            hypothesis=Hypothesis(model()),
            others=[Proposal(first, 500.0), Proposal(NARROW, explains - self.penalty)],
        )
        self.first_order = SimpleNamespace(
            remove_each=lambda fit: [rest for _ in fit.hypothesis.terms]
        )
        self.scores = {first: 100.0, NARROW: 50.0, MORE: together}

    def fit(self, h):
        """The hypothesis."""
        return SimpleNamespace(hypothesis=h)

    def score(self, fit):
        """By what it consists of."""
        return self.scores[fit.hypothesis.terms[0]]


@pytest.mark.parametrize(
    ("first", "explains", "together", "ends_with"),
    [
        (WIDE, 120.0, 105.0, MORE),
        (WIDE, 120.0, 100.5, WIDE),  # not likelier enough
        (WIDE, 90.0, 105.0, WIDE),  # too little is explained by the narrow one
        (FEW, 120.0, 105.0, FEW),  # swaps do that
    ],
)
def test_several_narrow_effects_take_the_place_of_a_wide_one(first, explains, together, ends_with):
    workspace = Searched(first, explains, together)

    def search_on(workspace, fit):
        assert fit.hypothesis.terms == (NARROW,)
        return workspace, workspace.fit(Hypothesis(model(), (MORE,)))

    start = workspace.fit(Hypothesis(model(), (first,)))
    found = spread_wide(workspace, start, search_on, min_gain=1.0)
    assert found.hypothesis.terms == (ends_with,)
