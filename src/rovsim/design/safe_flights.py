"""Flights that stay within the limits in more scenarios than the search had, and what they tell."""

from dataclasses import dataclass
from typing import Iterable, Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import Commands
from rovsim.design.expected_information import ExpectedInformation, expect_information
from rovsim.design.scenarios import Scenarios
from rovsim.design.search import CandidateFlight, DesignProblem
from rovsim.dynamics.model import Model


@dataclass(frozen=True, eq=False)
class SafeFlight:
    """A flight that stays within the limits in all scenarios of the final check.

    Attributes:
        flight: how it is flown.
        paths: its states (s, k+1, 13) in s scenarios, the likeliest of each rival first.
        expected: the information expected of it, averaged over possible models.
    """

    flight: CandidateFlight
    paths: Array
    expected: ExpectedInformation


@dataclass(frozen=True, eq=False)
class FinalCheck:
    """What the best flights of a search are judged by in the end.

    Attributes:
        problem: with the limits, and what the train runs tell.
        scenarios: in which a flight has to stay within the limits.
        some: possible models of each rival, as many of each, that information is averaged over.
    """

    problem: DesignProblem
    scenarios: Scenarios
    some: Sequence[Sequence[Model]]

    def find_safe(self, flights: Iterable[CandidateFlight]) -> Iterator[SafeFlight]:
        """Find those flights that stay within the limits, in their order, one when asked for."""
        for flight in flights:
            if flight.expected is None:
                continue
            start = self.problem.pilot.starts(np.array([flight.heading]))[0]
            paths = self.scenarios.predict(self.problem.setup.drives(flight.commands), start)
            if self.problem.envelope.holds(paths):
                yield SafeFlight(flight, paths, self._average(flight.commands, start))

    def _average(self, commands: Commands, start: Array) -> ExpectedInformation:
        """The information expected of a flight from a state (13,): medians over `some` models."""
        prior, setup, information = self.problem.prior, self.problem.setup, []
        drives = setup.drives(commands)
        for models in zip(*self.some, strict=True):
            undisturbed = Scenarios(
                models,
                np.zeros((len(models), len(setup.edges) - 1, 6)),
                np.zeros((len(models), 3)),
                np.zeros(len(models)),
                setup,
            )
            paths = undisturbed.predict(drives, start)
            information.append(expect_information(paths, commands, prior, setup, exact=True))
        rivals = range(len(self.some))
        return ExpectedInformation(
            tuple(np.median([info.std_ratio[k] for info in information], axis=0) for k in rivals),
            tuple(np.median([info.std[k] for info in information], axis=0) for k in rivals),
            np.median([info.log_odds_gain for info in information], axis=0),
            prior.likely,
        )
