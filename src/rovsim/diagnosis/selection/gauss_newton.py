"""Gauss-Newton on the innovations: the most likely parameters of a hypothesis, and their spread."""

from dataclasses import dataclass
from typing import Callable, Iterator, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.least_squares import as_rows, inner_products, solve
from rovsim.diagnosis.observer.noise import Noise
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.observer.residual_source import Linearised, ResidualSource
from rovsim.diagnosis.selection.prior import Prior

MOST_ITERATIONS = 12
STEP_TOLERANCE = 0.02  # standard deviations: a smaller step changes nothing anyone could see
# Of what the model does not explain: a wrong model need not be fitted finely.
MISFIT_TOLERANCE = 1e-2
# Scales: where much is free at once, what acts only together (drag and a loop, drag and thrust)
# stays near where it began.
REACH = 10.0
# Off a gain ratio of one: decreases so close to what was predicted need no new derivatives.
GAIN_RATIO_TOLERANCE = 0.1
INITIAL_DAMPING, MIN_DAMPING, MAX_DAMPING = 1e-4, 1e-8, 1e4  # larger: shorter steps, downhill
LIGHT_DAMPING = 0.1  # a step under more is short for that reason, and says nothing of the rest
POLISHING_ROUNDS = 2  # the noise of the first is already the right one
# Times the reduction that its derivatives predict: so much more a fit may yet reach. Of 234 that
# were given up and went on all the same one gained more (5, of 1), and none what it had to reach.
REACHABLE = 4.0

Monitor = Callable[[Linearised, float], None]


class GivenUp(Exception):
    """A fit that would not end where it was wanted."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted hypothesis.

    `seen` with its errors and how they change; `noise` fitted to it; `two_log_likelihood` under
    that noise; `covariance` (k, k) of the scaled parameters.
    """

    seen: Linearised
    noise: Noise
    two_log_likelihood: float
    covariance: Array

    @property
    def is_finite(self) -> bool:
        """Whether the model stayed finite beside its filters; if not, nothing is known of it."""
        return bool(np.isfinite(self.two_log_likelihood))

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
    return judge(levenberg_marquardt(start, bank, noise, Prior.around(start.x, reach)), bank, noise)


def fit_or_give_up(
    first: Linearised, bank: FilterBank, noise: Noise, least: float, reach: float = np.inf
) -> Fit | None:
    """The same, but None as soon as nothing says that its `two_log_likelihood` reaches `least`.

    `first`: a start, and derivatives that are roughly right there.
    """

    def monitor(seen: Linearised, predicted_reduction: float) -> None:
        here = bank.fit_noise(seen.e, noise).two_log_likelihood
        if here + REACHABLE * predicted_reduction < least:
            raise GivenUp

    prior = Prior.around(first.at.x, reach)
    try:
        return judge(levenberg_marquardt(first.at, bank, noise, prior, first, monitor), bank, noise)
    except GivenUp:
        return None


def polish(
    start: Fit, runs: Sequence[ObservedRun], reach: float = np.inf
) -> tuple[Fit, FilterBank]:
    """Fitted once more to these runs under its own noise, with filters that suit it.

    As far as filters under that noise hold the model.
    """

    def again(start: Fit) -> tuple[Fit, FilterBank]:
        bank = FilterBank.design(runs, start.hypothesis.model, start.noise)
        return fit(start.hypothesis, bank, start.noise, reach), bank

    polished = again(start)
    for _ in range(1, POLISHING_ROUNDS):
        finer = again(polished[0])
        if not finer[0].is_finite:
            break
        polished = finer
    return polished


def judge(seen: Linearised, bank: FilterBank, noise: Noise, prior: Prior | None = None) -> Fit:
    """A hypothesis as it stands, the noise fitted to what it leaves, beside what was known."""
    if not seen.finite:
        unknown = np.full((len(seen.at.x), len(seen.at.x)), np.inf)
        return Fit(seen, noise, -np.inf, unknown)
    own, two_log_likelihood = bank.fit_noise(seen.e, noise)
    information = inner_products(as_rows(bank.whiten(seen.J, own)))
    if prior is not None:
        information = information + np.diag(prior.weights(seen.at.x))
    return Fit(seen, own, two_log_likelihood, solve(information, np.eye(len(information))))


def levenberg_marquardt(
    start: Hypothesis, source: ResidualSource, noise: Noise, prior: Prior | None = None,
    first: Linearised | None = None, monitor: Monitor = lambda seen, predicted_reduction: None,
) -> Linearised:  # fmt: skip
    """Damped least squares from a hypothesis, beside what is known before: where they lead.

    Levenberg (1944) and Marquardt (1963): the larger the damping, the shorter the step.

    Args:
        start: where it begins.
        source: of the errors that it is fitted to.
        noise: of that.
        prior: what is known before.
        first: the start, and derivatives that are roughly right there; it does not end with these.
        monitor: told, each time derivatives were found anew, where the fit is and by how much they
            predict that the sum of squares is lowered yet.
    """
    problem = _LeastSquares(source, noise, prior or Prior.around(start.x, np.inf))
    seen, damping, rough = first or source.linearise(start), INITIAL_DAMPING, first is not None
    if not len(start.x) or not seen.finite:
        return seen
    quadratic = problem.expand(seen)
    for _ in range(MOST_ITERATIONS):
        step, ended = _find_reducing_step(problem, quadratic, damping), False
        if step is None and seen.at is quadratic.at and not rough:
            return seen
        if step is not None:
            damping = max(step.damping / 10.0, MIN_DAMPING)
            ended = _is_small(step, quadratic)
            quadratic = problem.shift(quadratic, step)
            if step.gain_ratio_near_one and not ended:
                continue
        seen, ended, rough = source.linearise(quadratic.at), ended and not rough, False
        if ended or not seen.finite:
            return seen
        quadratic = problem.expand(seen)
        monitor(seen, quadratic.predicted_reduction)
    return source.linearise(quadratic.at)


class QuadraticModel(NamedTuple):
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
    def predicted_reduction(self) -> float:
        """The decrease of the sum of squares from here to where the slope vanishes."""
        return float(self.g @ solve(self.H, self.g))


class TrialStep(NamedTuple):
    """Where a step leads, what it costs there, and how damped it was.

    `length`, squared, in standard deviations; `residuals` (size,) the errors there. The
    gain ratio is the reduction of the cost over the predicted one: near one, the derivatives from
    where it began still hold.
    """

    to: Hypothesis
    cost: float
    damping: float
    length: float
    residuals: Array
    gain_ratio_near_one: bool


@dataclass(frozen=True, eq=False)
class _LeastSquares:
    """Whitened errors, and a prior."""

    source: ResidualSource
    noise: Noise
    prior: Prior

    def errors(self, wanted: Hypothesis) -> Array:
        """Whitened errors (size,); infinite where the model diverges."""
        e = [one[0] for one in self.source.evaluate([wanted.model])]
        if not all(np.isfinite(one).all() for one in e):
            return np.array([np.inf])
        return self.source.whiten(e, self.noise).ravel()

    def cost(self, wanted: Hypothesis, residuals: Array) -> float:
        """Sum of squares of errors, and what the prior says of the hypothesis."""
        return float(residuals @ residuals) + self.prior.cost(wanted.x)

    def expand(self, seen: Linearised) -> QuadraticModel:
        """The sum of squares to second order about a hypothesis."""
        rows = as_rows(self.source.whiten(seen.J, self.noise))
        residuals = self.source.whiten(seen.e, self.noise).ravel()
        H = inner_products(rows) + np.diag(self.prior.weights(seen.at.x))
        g = rows @ residuals + self._prior_slope(seen.at.x)
        return QuadraticModel(seen.at, H, g, self.cost(seen.at, residuals), len(residuals), rows)

    def shift(self, quadratic: QuadraticModel, step: TrialStep) -> QuadraticModel:
        """The same about where a step leads, with the derivatives from where it began."""
        g = quadratic.rows @ step.residuals + self._prior_slope(step.to.x)
        return quadratic._replace(at=step.to, g=g, cost=step.cost)

    def _prior_slope(self, x: Array) -> Array:
        return self.prior.weights(x) * (x - self.prior.about)


def _is_small(step: TrialStep, quadratic: QuadraticModel) -> bool:
    """Whether a step need not be followed by another."""
    excess = max(0.0, step.cost - quadratic.size)
    small = max(STEP_TOLERANCE**2 * len(quadratic.g), MISFIT_TOLERANCE * excess)
    return step.damping <= LIGHT_DAMPING and step.length < small


def _find_reducing_step(
    problem: _LeastSquares, quadratic: QuadraticModel, damping: float
) -> TrialStep | None:
    """A step that lowers the cost; None when none does, or only one too small to see.

    Coarse parameters, on which errors depend in jumps, have derivatives that predict what is not
    there farther off: where a step of all fails, these move by a grain at most, or not at all.
    """
    while damping < MAX_DAMPING:
        damped = quadratic.H + damping * np.diag(np.diag(quadratic.H))
        goal = quadratic.at.x - solve(damped, quadratic.g)
        if not np.isfinite(goal).all():
            break
        step = _try_step(problem, quadratic, damping, goal)
        if step.cost >= quadratic.cost:
            goals = _move_coarse_less(quadratic, goal, damping)
            careful = [_try_step(problem, quadratic, damping, x) for x in goals]
            step = min([step, *careful], key=lambda one: one.cost)
        if step.cost < quadratic.cost:
            return step
        if step.length < STEP_TOLERANCE**2:
            break
        damping *= 10.0
    return None


def _move_coarse_less(quadratic: QuadraticModel, goal: Array, damping: float) -> Iterator[Array]:
    """Goals (k,) like this one, in which coarse parameters move less, and the others as is best."""
    x, parameters = quadratic.at.x, [p for term in quadratic.at.terms for p in term.parameters]
    grains = np.array([p.resolution / p.scale for p in parameters])
    coarse = grains > 0.0
    if not coarse.any() or coarse.all():
        return
    H = quadratic.H[np.ix_(~coarse, ~coarse)]
    damped = H + damping * np.diag(np.diag(H))
    for reach in (1.0, 0.0):
        moved = x.copy()
        moved[coarse] += np.clip((goal - x)[coarse], *(reach * grains[coarse] * [[-1.0], [1.0]]))
        coupled = quadratic.H[np.ix_(~coarse, coarse)] @ (moved - x)[coarse]
        moved[~coarse] -= solve(damped, quadratic.g[~coarse] + coupled)
        if np.isfinite(moved).all():
            yield moved


def _try_step(
    problem: _LeastSquares, quadratic: QuadraticModel, damping: float, goal: Array
) -> TrialStep:
    """Where a step to a goal (k,) leads."""
    wanted = quadratic.at.at(goal)
    step = wanted.x - quadratic.at.x
    residuals = problem.errors(wanted)
    cost, length = problem.cost(wanted, residuals), float(step @ quadratic.H @ step)
    predicted = -float(2.0 * quadratic.g @ step + length)
    # gain ratio (actual over predicted reduction) within the tolerance of 1
    near_one = abs(quadratic.cost - cost - predicted) < GAIN_RATIO_TOLERANCE * predicted
    return TrialStep(wanted, cost, damping, length, residuals, near_one)
