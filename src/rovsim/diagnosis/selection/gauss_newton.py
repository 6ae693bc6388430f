"""Gauss-Newton on the innovations: the most likely parameters of a hypothesis, and their spread."""

from dataclasses import dataclass
from typing import Callable, Iterator, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.evidence import Evidence, Linearised
from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.least_squares import as_rows, inner_products, solve
from rovsim.diagnosis.observer.noise import Noise
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.selection.prior import Prior

MOST_ITERATIONS = 12
CONVERGED = 0.02  # standard deviations: a smaller step changes nothing anyone could see
ROUGH = 1e-2  # of what the model does not explain: a wrong model need not be fitted finely
# Scales: where much is free at once, what acts only together (drag and a loop, drag and thrust)
# stays near where it began.
REACH = 10.0
# Of the decrease that the derivatives promised: so close to it they need not be found anew.
FORESEEN = 0.1
# Damping of the steps (Levenberg-Marquardt).
FIRST_TRUST, LEAST_TRUST, LARGEST_TRUST = 1e-4, 1e-8, 1e4
LIGHT = 0.1  # damping: a step under more is short for that reason, and says nothing of the rest
POLISHED = 2  # times: the noise of the first is already the right one
# Times the decrease that its derivatives promise: so much more a fit may yet reach. Of 234 that
# were given up and went on all the same one gained more (5, of 1), and none what it had to reach.
YET = 4.0

Watch = Callable[[Linearised, float], None]


class GivenUp(Exception):
    """A fit that would not end where it was wanted."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted hypothesis.

    `seen` with its errors and how they change; `noise` fitted to it; `likelihood` twice the log
    likelihood under that noise; `covariance` (k, k) of the scaled parameters.
    """

    seen: Linearised
    noise: Noise
    likelihood: float
    covariance: Array

    @property
    def held(self) -> bool:
        """Whether the filters could hold the model; if not, nothing is known of it."""
        return bool(np.isfinite(self.likelihood))

    @property
    def hypothesis(self) -> Hypothesis:
        """The hypothesis at its most likely values."""
        return self.seen.at

    @property
    def std(self) -> Array:
        """Standard deviations (k,) of the scaled parameters."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    def distance(self, own: Sequence[int] | Array) -> float:
        """Of some parameters from their absence, squared, in standard deviations (Wald 1943)."""
        off, V = (self.hypothesis.x - self.hypothesis.absence)[own], self.covariance[own][:, own]
        return float(off @ solve(V, off))


def fit(start: Hypothesis, bank: FilterBank, noise: Noise, reach: float = np.inf) -> Fit:
    """Fit the free parameters under a given noise, then the noise to what is left.

    `reach`, in scales: a prior's standard deviation about the start, which keeps parameters that
    only act together from running away together.

    A model that diverges in spite of the observer's corrections is infinitely unlikely.
    """
    return judge(descend(start, bank, noise, Prior.around(start.x, reach)), bank, noise)


def fit_or_give_up(
    first: Linearised, bank: FilterBank, noise: Noise, least: float, reach: float = np.inf
) -> Fit | None:
    """The same, but None as soon as nothing says that twice the log likelihood reaches `least`.

    `first`: a start, and derivatives that are roughly right there.
    """

    def watch(seen: Linearised, promised: float) -> None:
        if bank.fit_noise(seen.e, noise).likelihood + YET * promised < least:
            raise GivenUp

    prior = Prior.around(first.at.x, reach)
    try:
        return judge(descend(first.at, bank, noise, prior, first, watch), bank, noise)
    except GivenUp:
        return None


def polish(
    found: Fit, runs: Sequence[ObservedRun], reach: float = np.inf
) -> tuple[Fit, FilterBank]:
    """Fitted once more to these runs under its own noise, with filters that suit it.

    As far as filters under that noise hold the model.
    """

    def again(found: Fit) -> tuple[Fit, FilterBank]:
        bank = FilterBank.design(runs, found.hypothesis.model, found.noise)
        return fit(found.hypothesis, bank, found.noise, reach), bank

    polished = again(found)
    for _ in range(1, POLISHED):
        finer = again(polished[0])
        if not finer[0].held:
            break
        polished = finer
    return polished


def judge(seen: Linearised, bank: FilterBank, noise: Noise, prior: Prior | None = None) -> Fit:
    """A hypothesis as it stands, the noise fitted to what it leaves, beside what was known."""
    if not seen.finite:
        unsure = np.full((len(seen.at.x), len(seen.at.x)), np.inf)
        return Fit(seen, noise, -np.inf, unsure)
    own, likelihood = bank.fit_noise(seen.e, noise)
    told = inner_products(as_rows(bank.whiten(seen.J, own)))
    if prior is not None:
        told = told + np.diag(prior.weights(seen.at.x))
    return Fit(seen, own, likelihood, solve(told, np.eye(len(told))))


def descend(
    start: Hypothesis, evidence: Evidence, noise: Noise, prior: Prior | None = None,
    first: Linearised | None = None, watch: Watch = lambda seen, promised: None,
) -> Linearised:  # fmt: skip
    """Least squares from a hypothesis, beside what is known before: where it leads.

    Args:
        start: where it begins.
        evidence: what it is fitted to.
        noise: of that.
        prior: what is known before.
        first: the start, and derivatives that are roughly right there; it does not end with these.
        watch: told, each time derivatives were found anew, where the fit is and by how much they
            promise to lower the sum of squares yet.
    """
    problem = _Problem(evidence, noise, prior or Prior.around(start.x, np.inf))
    seen, trust, rough = first or evidence.linearise(start), FIRST_TRUST, first is not None
    if not len(start.x) or not seen.finite:
        return seen
    bowl = problem.expand(seen)
    for _ in range(MOST_ITERATIONS):
        step, ended = _find_step(problem, bowl, trust), False
        if step is None and seen.at is bowl.at and not rough:
            return seen
        if step is not None:
            trust = max(step.damping / 10.0, LEAST_TRUST)
            ended = _is_small(step, bowl)
            bowl = problem.shift(bowl, step)
            if step.as_foreseen and not ended:
                continue
        seen, ended, rough = evidence.linearise(bowl.at), ended and not rough, False
        if ended or not seen.finite:
            return seen
        bowl = problem.expand(seen)
        watch(seen, bowl.promised)
    return evidence.linearise(bowl.at)


def _is_small(step: "_Step", bowl: "_Bowl") -> bool:
    """Whether a step need not be followed by another."""
    excess = max(0.0, step.cost - bowl.size)
    return step.damping <= LIGHT and step.length < max(CONVERGED**2 * len(bowl.g), ROUGH * excess)


class _Bowl(NamedTuple):
    """Sum of squares of `size` errors about a hypothesis: curvature (k, k), slope (k,), value.

    `rows` (k, size) are the derivatives of the errors.
    """

    at: Hypothesis
    H: Array
    g: Array
    cost: float
    size: int
    rows: Array

    @property
    def promised(self) -> float:
        """The decrease of the sum of squares from here to where the slope vanishes."""
        return float(self.g @ solve(self.H, self.g))


class _Step(NamedTuple):
    """Where a step leads, what it costs there, and how damped it was.

    `length`, squared, in standard deviations; `target` (size,) the errors there; `as_foreseen`:
    the derivatives from where it began still hold.
    """

    to: Hypothesis
    cost: float
    damping: float
    length: float
    target: Array
    as_foreseen: bool


@dataclass(frozen=True, eq=False)
class _Problem:
    """Whitened errors, and a prior."""

    evidence: Evidence
    noise: Noise
    prior: Prior

    def errors(self, wanted: Hypothesis) -> Array:
        """Whitened errors (size,); infinite where the model diverges."""
        e = [one[0] for one in self.evidence.evaluate([wanted.model])]
        if not all(np.isfinite(one).all() for one in e):
            return np.array([np.inf])
        return self.evidence.whiten(e, self.noise).ravel()

    def cost(self, wanted: Hypothesis, target: Array) -> float:
        """Sum of squares of errors, and what the prior says of the hypothesis."""
        return float(target @ target) + self.prior.cost(wanted.x)

    def expand(self, seen: Linearised) -> _Bowl:
        """The sum of squares to second order about a hypothesis."""
        rows = as_rows(self.evidence.whiten(seen.J, self.noise))
        target = self.evidence.whiten(seen.e, self.noise).ravel()
        H = inner_products(rows) + np.diag(self.prior.weights(seen.at.x))
        g = rows @ target + self._pull(seen.at.x)
        return _Bowl(seen.at, H, g, self.cost(seen.at, target), len(target), rows)

    def shift(self, bowl: _Bowl, step: _Step) -> _Bowl:
        """The same about where a step leads, with the derivatives from where it began."""
        g = bowl.rows @ step.target + self._pull(step.to.x)
        return bowl._replace(at=step.to, g=g, cost=step.cost)

    def _pull(self, x: Array) -> Array:
        return self.prior.weights(x) * (x - self.prior.about)


def _find_step(problem: _Problem, bowl: _Bowl, trust: float) -> _Step | None:
    """A step that lowers the cost; None when none does, or only one too small to see.

    Coarse parameters, on which errors depend in jumps, have derivatives that promise what is not
    there farther off: where a step of all fails, these move by a grain at most, or not at all.
    """
    while trust < LARGEST_TRUST:
        goal = bowl.at.x - solve(bowl.H + trust * np.diag(np.diag(bowl.H)), bowl.g)
        if not np.isfinite(goal).all():
            break
        step = _try_step(problem, bowl, trust, goal)
        if step.cost >= bowl.cost:
            careful = [_try_step(problem, bowl, trust, x) for x in _hold(bowl, goal, trust)]
            step = min([step, *careful], key=lambda one: one.cost)
        if step.cost < bowl.cost:
            return step
        if step.length < CONVERGED**2:
            break
        trust *= 10.0
    return None


def _hold(bowl: _Bowl, goal: Array, trust: float) -> Iterator[Array]:
    """Goals (k,) like this one, in which coarse parameters move less, and the others as is best."""
    x, parameters = bowl.at.x, [p for term in bowl.at.terms for p in term.parameters]
    grains = np.array([p.resolution / p.scale for p in parameters])
    coarse = grains > 0.0
    if not coarse.any() or coarse.all():
        return
    H = bowl.H[np.ix_(~coarse, ~coarse)]
    damped = H + trust * np.diag(np.diag(H))
    for reach in (1.0, 0.0):
        moved = x.copy()
        moved[coarse] += np.clip((goal - x)[coarse], *(reach * grains[coarse] * [[-1.0], [1.0]]))
        drawn = bowl.H[np.ix_(~coarse, coarse)] @ (moved - x)[coarse]
        moved[~coarse] -= solve(damped, bowl.g[~coarse] + drawn)
        if np.isfinite(moved).all():
            yield moved


def _try_step(problem: _Problem, bowl: _Bowl, trust: float, goal: Array) -> _Step:
    """Where a step to a goal (k,) leads."""
    wanted = bowl.at.at(goal)
    step = wanted.x - bowl.at.x
    target = problem.errors(wanted)
    cost, length = problem.cost(wanted, target), float(step @ bowl.H @ step)
    foreseen = -float(2.0 * bowl.g @ step + length)
    true = abs(bowl.cost - cost - foreseen) < FORESEEN * foreseen
    return _Step(wanted, cost, trust, length, target, true)
