"""How flights are searched: in parts that fit into memory, within what may be asked."""

from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.core.schema import checked
from rovsim.design.search import AT_ONCE, search
from rovsim.design.settings import LONGEST, SHORTEST, DesignSettings, Question


class Flights:
    """Flights that tell the more the more they surge; beyond 0.8 they leave the limits."""

    axes = np.array([0, 1, 2, 5])

    def __init__(self) -> None:
        self.counts = []

    def try_numbers(self, x):
        """All of them."""
        self.counts.append(len(x))
        return [
            SimpleNamespace(numbers=own, worth=own[1] <= 0.8, told=own[1], excess=own[1])
            for own in x
        ]


def test_a_search_flies_in_parts_and_keeps_numbers_alone():
    flights = Flights()
    found = search(flights, DesignSettings(population=3 * AT_ONCE, rounds=2), seed=0)
    assert max(flights.counts) == AT_ONCE
    surge = np.array([numbers[1] for numbers in found])
    assert 0.7 < surge[0] <= 0.8
    assert (np.diff(surge) <= 0.0).all()
    assert all(isinstance(numbers, np.ndarray) for numbers in found)


@pytest.mark.parametrize(
    "asked",
    [
        {"seconds": LONGEST + 1}, {"seconds": SHORTEST - 1}, {"seconds": float("inf")},
        {"design": {"population": 10**9}}, {"design": {"rounds": 10**9}},
    ],
)  # fmt: skip
def test_what_no_machine_can_plan_is_refused(asked):
    with pytest.raises(BadInput, match=r"Expected .* (equal to|finite)"):
        checked(Question, asked, "command line")
