"""The flight of the largest utility: first one axis at a time, then all together (SciPy).

Differential evolution (Storn & Price 1997) asks for no derivatives, which walls would spoil, and
works on whole generations, which the engine flies side by side. A flight beyond the limits is worse
than any within them, and the worse the farther beyond (Deb 2000).
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
    """A flight: `inputs` (n, 6) from a heading in rad, its log, and what is expected of it.

    Of one beyond the limits, which it leaves by `excess`, nothing is. `numbers` are what it was
    made of, `name` and `amplitude` those of a usual manoeuvre.
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
        """To be as large as possible; negative beyond the limits."""
        return self.expected.utility if self.expected else -self.excess


@dataclass(frozen=True, eq=False)
class DesignProblem:
    """Which flights there are, and what judges them: limits, what could happen, what is known."""

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
        """Each of the flights: flown side by side, judged one after the other when asked for."""
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
        """The likeliest of each rival, and all others."""
        return self.scenarios.split(len(self.prior.rivals))

    def evaluate_numbers(self, x: Sequence[Array]) -> Iterator[CandidateFlight]:
        """As `evaluate_all`, of numbers (1 + 5 j,) in [0, 1]: a heading, then five an axis."""
        seconds = self.setup.seconds
        inputs = [make_inputs(own[1:], self.axes, seconds) for own in x]
        tried = self.evaluate_all(inputs, [self.envelope.longest + np.pi * own[0] for own in x])
        return (replace(one, numbers=own) for one, own in zip(tried, x, strict=True))


def evaluate_baselines(problem: DesignProblem, seed: int) -> dict[str, list[CandidateFlight]]:
    """The usual manoeuvres, each at all amplitudes, the largest utility first."""
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
    """What stays in memory of each flight that was tried: its numbers (k,) and its rank."""

    numbers: Array
    rank: float


def search(problem: DesignProblem, settings: DesignSettings, seed: int) -> list[Array]:
    """Numbers (1 + 5 j,) of the flights within the limits, by falling utility.

    A flight is made again of its numbers when it is needed: each takes megabytes.
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
    """Flights, as numbers (k,) each, in parts of which memory holds the logs."""
    return [x[first : first + AT_ONCE] for first in range(0, len(x), AT_ONCE)]


def _ranked(one: CandidateFlight) -> float:
    """To be as large as possible; any flight within the limits above all beyond them."""
    if one.expected:
        return float(np.log(max(one.utility, 1e-12)))
    return BEYOND - min(one.excess, 1e6)


def _one_axis_each(problem: DesignProblem) -> Array:
    """Numbers (m, 1 + 5 j) of swings of one axis alone."""
    rows = []
    for k, (f, square, a) in product(
        range(len(problem.axes)), product(FREQUENCIES, SQUARES, AMPLITUDES)
    ):
        own = np.zeros((len(problem.axes), NUMBERS))
        own[:, 1] = 0.5
        own[k] = [a, np.log(f / SLOWEST) / np.log(FASTEST / SLOWEST), square, 0.0, 0.0]
        # what goes aside does so along the longer side
        heading = 0.5 if problem.axes[k] == 1 else 0.0
        rows.append(np.concatenate([[heading], own.ravel()]))
    return np.array(rows)


def _begin(
    archive: Sequence[Rated], problem: DesignProblem, population: int, random: np.random.Generator
) -> Array:
    """The first generation: the best of each axis, alone and in pairs, and what chance adds."""
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
