"""What a search leaves out again, and what it cannot judge."""

import numpy as np
import pytest

from rovsim.diagnosis.selection.pruning import prune
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.residual_source import Linearised

PENALTY = 11.5  # of about 300 columns


class Wald:
    """A workspace where a lost parameter costs the square of its standard deviations from zero."""

    penalty = PENALTY

    def __init__(self, z: dict[str, float], two_log_likelihood: float) -> None:
        self.z, self.two_log_likelihood = z, two_log_likelihood

    def fit(self, h: Hypothesis) -> Fit:
        left = [name for term in h.terms for name in term.free]
        gone = sum(self.z[name] ** 2 for name in self.z if name not in left)
        std = np.array([abs(x) / self.z[name] for x, name in zip(h.x, left, strict=True)])
        seen = Linearised(h, [], [])
        return Fit(seen, FIRST_NOISE, self.two_log_likelihood - gone, np.diag(std**2))

    def score(self, found: Fit) -> float:
        return found.two_log_likelihood - PENALTY * len(found.hypothesis.x)


@pytest.mark.parametrize(
    ("z", "two_log_likelihood", "left"),
    [
        ({"surge": 2.3}, 100.0, []),
        ({"surge": 5.0}, 100.0, ["surge"]),
        ({"surge": 5.0, "sway": 2.3}, 100.0, ["surge"]),
        ({"surge": 2.3}, -np.inf, ["surge"]),  # it could not be fitted: nothing is known of it
    ],
)
def test_a_parameter_stays_that_is_worth_its_price(z, two_log_likelihood, left):
    term = Term(ConstantWrench(**dict.fromkeys(z, 1.0)), tuple(z))
    workspace = Wald(z, two_log_likelihood)
    start = workspace.fit(Hypothesis(nominal(load_vehicle(default_vehicle())), (term,)))
    kept = prune(workspace, start).hypothesis
    assert [name for one in kept.terms for name in one.free] == left
