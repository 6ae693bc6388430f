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
from rovsim.design.inputs import BASELINES, FASTEST, NUMBERS, SLOWEST, make_inputs, ticks
from rovsim.design.pilot import ModelPilot
from rovsim.design.prior_information import PriorInformation
from rovsim.design.recording_setup import RecordingSetup
from rovsim.design.scenarios import Scenarios
from rovsim.design.settings import DesignSettings

# Where one axis at a time is tried: swings of 20 s to 2 s, soft and sharp.
FREQUENCIES, SQUARES, AMPLITUDES = (0.05, 0.12, 0.25, 0.5), (0.0, 0.8), (0.3, 0.6, 1.0)
# Of the usual manoeuvres: sticks in the plane, and out of it.
IN_PLANE, OUT_OF_PLANE = (0.1, 0.15, 0.2, 0.3, 0.45, 0.7, 1.0), (0.05, 0.1, 0.2, 0.4, 0.8)
MUTATION = 0.05  # of the range of each number, by which mixtures of two flights are varied
BEYOND = -100.0  # the rank from which on flights leave the limits
AT_ONCE = 96  # flights side by side: ten minutes of each take some megabytes
VERTICAL = np.array([2, 3, 4])  # heave, roll, pitch


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
        each = zip(inputs, headings, demands, starts, strict=True)
        return (self._evaluate(*one) for one in each)

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
            each = paths[: len(self.prior.rivals)]
            expected = expect_information(each, commands, self.prior, self.setup)
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
        inputs = [make_inputs(own[1:], self.axes, seconds) for own in x]
        tried = self.evaluate_all(inputs, [self.envelope.longest + np.pi * own[0] for own in x])
        return (replace(one, numbers=own) for one, own in zip(tried, x, strict=True))


def evaluate_baselines(problem: DesignProblem, seed: int) -> dict[str, list[CandidateFlight]]:
    """Evaluate each usual manoeuvre at all amplitudes: by name, the largest utility first."""
    found, t = {}, ticks(problem.setup.seconds)
    levels = list(product(IN_PLANE, OUT_OF_PLANE))
    for name, baseline in BASELINES.items():
        full = baseline.move(t, problem.axes, np.random.default_rng(seed))
        scales = [np.where(np.isin(np.arange(6), VERTICAL), b, a) for a, b in levels]
        headings = [problem.envelope.longest] * len(levels)
        tried = problem.evaluate_all([full * s for s in scales], headings)
        named = [
            replace(one, name=name, amplitude=level)
            for one, level in zip(tried, levels, strict=True)
        ]
        found[name] = sorted(named, key=lambda one: -one.utility)
    return found


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
        found = []
        for some in in_parts(np.clip(x.T, 0.0, 1.0)):
            found += [Rated(one.numbers, _ranked(one)) for one in problem.evaluate_numbers(some)]
        archive.extend(found)
        return np.array([-one.rank for one in found])

    rate(_one_axis_each(problem).T)
    first = _begin(archive, problem, settings.population, np.random.default_rng(seed))
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
    able = [one for one in archive if one.rank > BEYOND]
    return [one.numbers for one in sorted(able, key=lambda one: -one.rank)]


def in_parts(x: Sequence[Array]) -> list[Sequence[Array]]:
    """Divide flights, as numbers (k,) each, into parts small enough for memory to hold."""
    return [x[first : first + AT_ONCE] for first in range(0, len(x), AT_ONCE)]


def _ranked(one: CandidateFlight) -> float:
    """The rank of a flight: any flight within the limits is above all flights beyond them."""
    if one.expected:
        return float(np.log(max(one.utility, 1e-12)))
    return BEYOND - min(one.excess, 1e6)


def _one_axis_each(problem: DesignProblem) -> Array:
    """Numbers (m, 1 + 5 j) of m oscillations, each of one axis alone."""
    rows = []
    for k, (f, square, a) in product(
        range(len(problem.axes)), product(FREQUENCIES, SQUARES, AMPLITUDES)
    ):
        own = np.zeros((len(problem.axes), NUMBERS))
        own[:, 1] = 0.5
        own[k] = [a, np.log(f / SLOWEST) / np.log(FASTEST / SLOWEST), square, 0.0, 0.0]
        # sway: the vehicle is turned so that it moves along the longer side of the tank
        heading = 0.5 if problem.axes[k] == 1 else 0.0
        rows.append(np.concatenate([[heading], own.ravel()]))
    return np.array(rows)


def _begin(
    archive: Sequence[Rated], problem: DesignProblem, population: int, random: np.random.Generator
) -> Array:
    """The first generation (population, 1 + 5 j).

    The best oscillations of each axis alone, then random combinations of two of these.
    """
    best = []
    rows = np.array([one.numbers for one in archive])
    ranks = np.array([one.rank for one in archive])
    for k in range(len(problem.axes)):
        own = np.flatnonzero(rows[:, 1 + NUMBERS * k] > 0.0)
        best += [rows[i] for i in own[np.argsort(-ranks[own])][:2]]
    found = list(best)
    while len(found) < population:
        pair = random.choice(len(best), 2, replace=False)
        mixed = np.maximum(best[pair[0]], 0.0).copy()
        axes, other = problem.axes, best[pair[1]]
        for k in range(len(axes)):
            block = slice(1 + NUMBERS * k, 1 + NUMBERS * (k + 1))
            if other[block][0] > mixed[block][0]:
                mixed[block] = other[block]
        mixed[1:] += MUTATION * random.normal(size=len(mixed) - 1) * (mixed[1:] > 0.0)
        mixed[1 + NUMBERS - 2 :: NUMBERS] = random.random(len(axes))  # phases
        found.append(np.clip(mixed, 0.0, 1.0))
    return np.array(found[:population])
