"""Search for the flight of the largest utility: one axis at a time, then all together (SciPy).

Differential evolution (Storn & Price 1997) needs no derivatives, which do not exist at walls, and
evaluates whole generations, which the engine simulates side by side. A flight beyond the limits is
worse than any flight within them, and the worse the farther beyond (Deb 2000).
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from typing import Any, Iterator, NamedTuple, Sequence, cast

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core.run import Commands
from rovsim.design.envelope import Envelope
from rovsim.design.expected_information import ExpectedInformation, expect_information
from rovsim.design.inputs import BASELINES, MAX_HZ, MIN_HZ, NUMBERS_PER_AXIS, make_inputs, ticks
from rovsim.design.pilot import ModelPilot
from rovsim.design.prior_information import PriorInformation
from rovsim.design.recording_setup import RecordingSetup
from rovsim.design.scenarios import Scenarios
from rovsim.design.settings import DesignSettings

# Where one axis at a time is tried: swings of 20 s to 2 s, soft and sharp.
FREQUENCY_GRID, SQUARE_GRID, AMPLITUDE_GRID = (0.05, 0.12, 0.25, 0.5), (0.0, 0.8), (0.3, 0.6, 1.0)
# Of the usual manoeuvres: sticks in the plane, and out of it.
IN_PLANE, OUT_OF_PLANE = (0.1, 0.15, 0.2, 0.3, 0.45, 0.7, 1.0), (0.05, 0.1, 0.2, 0.4, 0.8)
MUTATION_STD = 0.05  # of the range of each number, by which mixtures of two flights are varied
MAX_INFEASIBLE_RANK = -100.0  # the rank from which on flights leave the limits
FLIGHTS_PER_BATCH = 96  # side by side: ten minutes of each take some megabytes
VERTICAL_AXES = np.array([2, 3, 4])  # heave, roll, pitch


@dataclass(frozen=True, eq=False)
class CandidateFlight:
    """A flight that may be planned.

    Attributes:
        inputs: (n, 6) from -1 to 1, as a pilot's sticks.
        heading: at its start, rad NED.
        commands: its command log.
        excess: by how much it leaves the limits, see `Envelope.excess`.
        expected: the information expected of it; None beyond the limits.
        numbers: (1 + 5 j,) in [0, 1] that the search made it of; empty for a usual manoeuvre.
        name: of a usual manoeuvre.
        amplitude: of a usual manoeuvre, in the horizontal plane and out of it.
    """

    inputs: Array
    heading: float
    commands: Commands
    excess: float
    expected: ExpectedInformation | None
    numbers: Array = field(default_factory=lambda: np.empty(0))
    name: str = "designed"
    amplitude: tuple[float, float] | None = None

    @property
    def utility(self) -> float:
        """What the search maximises; negative beyond the limits."""
        return self.expected.utility if self.expected else -self.excess


@dataclass(frozen=True, eq=False)
class DesignProblem:
    """All that a flight is made with and judged by.

    Attributes:
        pilot: turns inputs into demands.
        envelope: the limits.
        scenarios: possible models and disturbances, that paths are predicted for.
        prior: what the train runs tell.
        setup: how the flight would be recorded.
    """

    pilot: ModelPilot
    envelope: Envelope
    scenarios: Scenarios
    prior: PriorInformation
    setup: RecordingSetup

    @property
    def axes(self) -> Array:
        """Axes (j,) that inputs move."""
        return np.flatnonzero(self.pilot.full)

    def evaluate_all(
        self, inputs: Sequence[Array], headings: Sequence[float]
    ) -> Iterator[CandidateFlight]:
        """Evaluate flights, given by their inputs (n, 6) and headings in rad.

        All are simulated side by side at once; each is then judged when the iterator reaches it.
        """
        demands = self.pilot.fly(np.array(inputs), np.array(headings))
        starts = self.pilot.starts(np.array(headings))
        flights = zip(inputs, headings, demands, starts, strict=True)
        return (self._evaluate(*flight) for flight in flights)

    def _evaluate(
        self, inputs: Array, heading: float, demand: Array, start: Array
    ) -> CandidateFlight:
        time = ticks(self.setup.seconds)
        commands = self.pilot.authority.commands(time, demand, self.setup.lines)
        drives, (likeliest, rest) = self.setup.drives(commands), self._parts
        paths = likeliest.predict(drives, start)
        excess, expected = self.envelope.excess(paths, each_alone=True), None
        if excess == 0.0:
            paths = np.concatenate([paths, rest.predict(drives, start)])
            excess = self.envelope.excess(paths)
        if excess == 0.0:
            undisturbed = paths[: len(self.prior.rivals)]
            expected = expect_information(undisturbed, commands, self.prior, self.setup)
        return CandidateFlight(inputs, heading, commands, excess, expected)

    @cached_property
    def _parts(self) -> tuple[Scenarios, Scenarios]:
        """The likeliest scenario of each rival, and all other scenarios."""
        return self.scenarios.split(len(self.prior.rivals))

    def evaluate_numbers(self, x: Sequence[Array]) -> Iterator[CandidateFlight]:
        """As `evaluate_all`, for flights given as numbers (1 + 5 j,) in [0, 1].

        The first is the heading; then come five for each axis, see `make_inputs`.
        """
        seconds = self.setup.seconds
        inputs = [make_inputs(row[1:], self.axes, seconds) for row in x]
        flights = self.evaluate_all(inputs, [self.envelope.longest + np.pi * row[0] for row in x])
        return (replace(f, numbers=row) for f, row in zip(flights, x, strict=True))


def evaluate_baselines(problem: DesignProblem, seed: int) -> dict[str, list[CandidateFlight]]:
    """Evaluate each usual manoeuvre at all amplitudes: by name, the largest utility first."""
    by_name, t = {}, ticks(problem.setup.seconds)
    levels = list(product(IN_PLANE, OUT_OF_PLANE))
    for name, baseline in BASELINES.items():
        full = baseline.move(t, problem.axes, np.random.default_rng(seed))
        scales = [np.where(np.isin(np.arange(6), VERTICAL_AXES), b, a) for a, b in levels]
        headings = [problem.envelope.longest] * len(levels)
        flights = problem.evaluate_all([full * s for s in scales], headings)
        candidates = [
            replace(flight, name=name, amplitude=level)
            for flight, level in zip(flights, levels, strict=True)
        ]
        by_name[name] = sorted(candidates, key=lambda flight: -flight.utility)
    return by_name


class Rated(NamedTuple):
    """What is kept of each flight that was tried: its numbers (k,), and a rank to be maximised."""

    numbers: Array
    rank: float


def search(problem: DesignProblem, settings: DesignSettings, seed: int) -> list[Array]:
    """Search for the flights of the largest utility.

    A flight takes megabytes, so only its numbers are returned, which it can be made of again.

    Args:
        problem: what flights are made with and judged by.
        settings: how many flights are tried in how many rounds.
        seed: of the first generation and of the search.

    Returns:
        Numbers (1 + 5 j,) in [0, 1] of all flights within the limits, the largest utility first.
    """
    archive: list[Rated] = []

    def rate(x: Array) -> Array:
        rated = []
        for batch in in_parts(np.clip(x.T, 0.0, 1.0)):
            rated += [Rated(f.numbers, _rank(f)) for f in problem.evaluate_numbers(batch)]
        archive.extend(rated)
        return np.array([-f.rank for f in rated])

    rate(_one_axis_each(problem).T)
    first = _begin_generation(archive, problem, settings.population, np.random.default_rng(seed))
    scipy.optimize.differential_evolution(
        cast(Any, rate),  # whole generations, which its types do not know
        scipy.optimize.Bounds(np.zeros(first.shape[1]), np.ones(first.shape[1])),
        init=first,
        maxiter=settings.rounds,
        tol=0.0,
        atol=0.0,
        mutation=(0.3, 0.9),
        recombination=0.6,
        polish=False,
        updating="deferred",
        vectorized=True,
        rng=np.random.default_rng(seed),
    )
    feasible = [r for r in archive if r.rank > MAX_INFEASIBLE_RANK]
    return [r.numbers for r in sorted(feasible, key=lambda r: -r.rank)]


def in_parts(x: Sequence[Array]) -> list[Sequence[Array]]:
    """Divide flights, as numbers (k,) each, into parts small enough for memory to hold."""
    return [x[first : first + FLIGHTS_PER_BATCH] for first in range(0, len(x), FLIGHTS_PER_BATCH)]


def _rank(one: CandidateFlight) -> float:
    """The rank of a flight: any flight within the limits is above all flights beyond them."""
    if one.expected:
        return float(np.log(max(one.utility, 1e-12)))
    return MAX_INFEASIBLE_RANK - min(one.excess, 1e6)


def _one_axis_each(problem: DesignProblem) -> Array:
    """Numbers (m, 1 + 5 j) of m oscillations, each of one axis alone."""
    rows = []
    for k, (f, square, a) in product(
        range(len(problem.axes)), product(FREQUENCY_GRID, SQUARE_GRID, AMPLITUDE_GRID)
    ):
        numbers = np.zeros((len(problem.axes), NUMBERS_PER_AXIS))
        numbers[:, 1] = 0.5
        numbers[k] = [a, np.log(f / MIN_HZ) / np.log(MAX_HZ / MIN_HZ), square, 0.0, 0.0]
        # sway: the vehicle is turned so that it moves along the longer side of the tank
        heading = 0.5 if problem.axes[k] == 1 else 0.0
        rows.append(np.concatenate([[heading], numbers.ravel()]))
    return np.array(rows)


def _begin_generation(
    archive: Sequence[Rated], problem: DesignProblem, population: int, random: np.random.Generator
) -> Array:
    """The first generation (population, 1 + 5 j).

    The best oscillations of each axis alone, then random combinations of two of these.
    """
    best = []
    rows = np.array([r.numbers for r in archive])
    ranks = np.array([r.rank for r in archive])
    for k in range(len(problem.axes)):
        active = np.flatnonzero(rows[:, 1 + NUMBERS_PER_AXIS * k] > 0.0)
        best += [rows[i] for i in active[np.argsort(-ranks[active])][:2]]
    generation = list(best)
    while len(generation) < population:
        pair = random.choice(len(best), 2, replace=False)
        mixed = np.maximum(best[pair[0]], 0.0).copy()
        axes, partner = problem.axes, best[pair[1]]
        for k in range(len(axes)):
            block = slice(1 + NUMBERS_PER_AXIS * k, 1 + NUMBERS_PER_AXIS * (k + 1))
            if partner[block][0] > mixed[block][0]:
                mixed[block] = partner[block]
        mixed[1:] += MUTATION_STD * random.normal(size=len(mixed) - 1) * (mixed[1:] > 0.0)
        mixed[1 + NUMBERS_PER_AXIS - 2 :: NUMBERS_PER_AXIS] = random.random(len(axes))  # phases
        generation.append(np.clip(mixed, 0.0, 1.0))
    return np.array(generation[:population])
