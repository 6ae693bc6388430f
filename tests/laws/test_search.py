"""How flights are searched: in parts that fit into memory, within what may be asked."""

from types import SimpleNamespace

import numpy as np
import pytest
from threadpoolctl import threadpool_info

from rovsim.core.errors import BadInput
from rovsim.core.schema import checked
from rovsim.design.plan import plan
from rovsim.design.search import FLIGHTS_PER_BATCH, CandidateFlight, DesignProblem, search
from rovsim.design.settings import MAX_FLIGHT_SECONDS, MIN_FLIGHT_SECONDS, DesignSettings, Question


class Flights:
    """Flights that tell the more the more they surge; beyond 0.8 they leave the limits."""

    axes = np.array([0, 1, 2, 5])

    def __init__(self) -> None:
        self.counts = []

    def evaluate_numbers(self, x):
        """All of them."""
        self.counts.append(len(x))
        return [
            SimpleNamespace(numbers=own, expected=own[1] <= 0.8, utility=own[1], excess=own[1])
            for own in x
        ]


def test_a_search_flies_in_parts_and_keeps_numbers_alone():
    flights = Flights()
    found = search(flights, DesignSettings(population=3 * FLIGHTS_PER_BATCH, rounds=2), seed=0)
    assert max(flights.counts) == FLIGHTS_PER_BATCH
    surge = np.array([numbers[1] for numbers in found])
    assert 0.7 < surge[0] <= 0.8
    assert (np.diff(surge) <= 0.0).all()
    assert all(isinstance(numbers, np.ndarray) for numbers in found)


class Pilot:
    """Flies anything, to no effect, and counts how often it took off."""

    full, flown = np.ones(6), 0

    def fly(self, inputs, headings):
        """As many demands."""
        self.flown += 1
        return np.zeros((len(inputs), 1, 6))

    def starts(self, headings):
        """At rest."""
        return np.zeros((len(headings), 13))


def test_flights_fly_side_by_side_and_are_judged_when_asked_for(monkeypatch):
    judged = []

    def judge(self, inputs, *rest):
        judged.append(inputs)
        return CandidateFlight(inputs, 0.0, None, 0.0, None)

    monkeypatch.setattr(DesignProblem, "_evaluate", judge)
    envelope, setup = SimpleNamespace(longest=0.0), SimpleNamespace(seconds=1.0)
    problem = DesignProblem(Pilot(), envelope, None, None, setup)
    tried = problem.evaluate_numbers(list(np.random.default_rng(0).random((5, 31))))
    next(tried)
    assert (problem.pilot.flown, len(judged)) == (1, 1)
    assert len(list(tried)) == 4
    assert problem.pilot.flown == 1


def test_a_plan_has_no_threads_for_small_matrices(monkeypatch):
    """On a busy machine they wait for one another: half of the time was theirs."""

    class Seen(Exception):
        pass

    def look(stage):
        raise Seen([one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"])

    monkeypatch.setattr("rovsim.design.plan.begin_stage", look)
    with pytest.raises(Seen) as found:
        plan(None, None, None, None, None)
    assert set(found.value.args[0]) == {1}


@pytest.mark.parametrize(
    "asked",
    [
        {"seconds": MAX_FLIGHT_SECONDS + 1},
        {"seconds": MIN_FLIGHT_SECONDS - 1},
        {"seconds": float("inf")},
        {"design": {"population": 10**9}},
        {"design": {"rounds": 10**9}},
    ],
)
def test_what_no_machine_can_plan_is_refused(asked):
    with pytest.raises(BadInput, match=r"Expected .* (equal to|finite)"):
        checked(Question, asked, "command line")
