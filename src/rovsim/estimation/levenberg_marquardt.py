"""Damped least squares on the innovations (Levenberg 1944, Marquardt 1963)."""

from dataclasses import dataclass
from typing import Callable, Iterator, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import as_rows, gram, solve
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.residual_source import Linearised, ResidualSource
from rovsim.estimation.prior import Prior

MAX_ITERATIONS = 12  # bounds a fit that creeps along a valley; it is judged where it stands then
STEP_TOLERANCE = 0.02  # standard deviations: a smaller step changes nothing anyone could see
# Of what the model does not explain: a wrong model need not be fitted finely.
MISFIT_TOLERANCE = 1e-2
# Off a gain ratio of one: decreases so close to what was predicted need no new derivatives.
GAIN_RATIO_TOLERANCE = 0.1
INITIAL_DAMPING, MIN_DAMPING, MAX_DAMPING = 1e-4, 1e-8, 1e4  # larger: shorter steps, downhill
LIGHT_DAMPING = 0.1  # a step under more is short for that reason, and says nothing of the rest

Monitor = Callable[[Linearised, float], None]


def levenberg_marquardt(
    start: Hypothesis,
    source: ResidualSource,
    noise: Noise,
    prior: Prior | None = None,
    first: Linearised | None = None,
    monitor: Monitor = lambda linearised, predicted_reduction: None,
) -> Linearised:
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
    current, damping, rough = (first or source.linearise(start), INITIAL_DAMPING, first is not None)
    if not len(start.x) or not current.is_finite:
        return current
    quadratic = problem.expand(current)
    for _ in range(MAX_ITERATIONS):
        step, ended = _find_reducing_step(problem, quadratic, damping), False
        exact = current.hypothesis is quadratic.hypothesis and not rough
        if step is None and exact:
            return current
        if step is not None:
            damping = max(step.damping / 10.0, MIN_DAMPING)
            ended = _is_small(step, quadratic)
            if exact and ended and _is_invisible(step, quadratic):
                return Linearised(step.to, step.e, current.J)  # derivatives are the same there
            quadratic = problem.shift(quadratic, step)
            if step.gain_ratio_near_one and not ended:
                continue
        current, ended, rough = (source.linearise(quadratic.hypothesis), ended and not rough, False)
        if ended or not current.is_finite:
            return current
        quadratic = problem.expand(current)
        monitor(current, quadratic.predicted_reduction)
    return source.linearise(quadratic.hypothesis)


class QuadraticModel(NamedTuple):
    """Sum of squares of `size` errors about a hypothesis: curvature (k, k), slope (k,), value.

    `rows` (k, size) are the derivatives of the errors.
    """

    hypothesis: Hypothesis
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

    `length`, squared, in standard deviations; `e` the errors (6, n) of each run there, and
    `residuals` (size,) the same whitened. The gain ratio is the reduction of the cost over the
    predicted one: near one, the derivatives from where it began still hold.
    """

    to: Hypothesis
    cost: float
    damping: float
    length: float
    e: list[Array]
    residuals: Array
    gain_ratio_near_one: bool


@dataclass(frozen=True, eq=False)
class _LeastSquares:
    """Whitened errors, and a prior."""

    source: ResidualSource
    noise: Noise
    prior: Prior

    def errors(self, wanted: Hypothesis) -> tuple[list[Array], Array]:
        """Errors (6, n) of each run, and whitened (size,); infinite where the model diverges."""
        e = [e_run[0] for e_run in self.source.evaluate([wanted.model])]
        if not all(np.isfinite(e_run).all() for e_run in e):
            return e, np.array([np.inf])
        return e, self.source.whiten(e, self.noise).ravel()

    def cost(self, wanted: Hypothesis, residuals: Array) -> float:
        """Sum of squares of errors, and what the prior says of the hypothesis."""
        return float(residuals @ residuals) + self.prior.cost(wanted.x)

    def expand(self, linearised: Linearised) -> QuadraticModel:
        """The sum of squares to second order about a hypothesis."""
        rows = as_rows(self.source.whiten(linearised.J, self.noise))
        residuals = self.source.whiten(linearised.e, self.noise).ravel()
        H = gram(rows) + np.diag(self.prior.weights(linearised.hypothesis.x))
        g = rows @ residuals + self._prior_slope(linearised.hypothesis.x)
        return QuadraticModel(
            linearised.hypothesis,
            H,
            g,
            self.cost(linearised.hypothesis, residuals),
            len(residuals),
            rows,
        )

    def shift(self, quadratic: QuadraticModel, step: TrialStep) -> QuadraticModel:
        """The same about where a step leads, with the derivatives from where it began."""
        g = quadratic.rows @ step.residuals + self._prior_slope(step.to.x)
        return quadratic._replace(hypothesis=step.to, g=g, cost=step.cost)

    def _prior_slope(self, x: Array) -> Array:
        return self.prior.weights(x) * (x - self.prior.about)


def _is_invisible(step: TrialStep, quadratic: QuadraticModel) -> bool:
    """Whether a step changes nothing anyone could see."""
    return step.length < STEP_TOLERANCE**2 * len(quadratic.g)


def _is_small(step: TrialStep, quadratic: QuadraticModel) -> bool:
    """Whether a step need not be followed by another."""
    excess = max(0.0, step.cost - quadratic.size)
    small = _is_invisible(step, quadratic) or step.length < MISFIT_TOLERANCE * excess
    return step.damping <= LIGHT_DAMPING and small


def _find_reducing_step(
    problem: _LeastSquares, quadratic: QuadraticModel, damping: float
) -> TrialStep | None:
    """A step that lowers the cost; None when none does, or only one too small to see.

    Coarse parameters, on which errors depend in jumps, have derivatives that predict what is not
    there farther off: where a step of all fails, these move by a grain at most, or not at all.
    """
    while damping < MAX_DAMPING:
        damped = quadratic.H + damping * np.diag(np.diag(quadratic.H))
        goal = quadratic.hypothesis.x - solve(damped, quadratic.g)
        if not np.isfinite(goal).all():
            break
        step = _try_step(problem, quadratic, damping, goal)
        if step.cost >= quadratic.cost:
            goals = _move_coarse_less(quadratic, goal, damping)
            trials = [_try_step(problem, quadratic, damping, x) for x in goals]
            step = min([step, *trials], key=lambda one: one.cost)
        if step.cost < quadratic.cost:
            return step
        if step.length < STEP_TOLERANCE**2:
            break
        damping *= 10.0
    return None


def _move_coarse_less(quadratic: QuadraticModel, goal: Array, damping: float) -> Iterator[Array]:
    """Goals (k,) like this one, in which coarse parameters move less, and the others as is best."""
    x, parameters = (
        quadratic.hypothesis.x,
        [p for term in quadratic.hypothesis.terms for p in term.parameters],
    )
    grains = np.array([p.resolution / p.scale for p in parameters])
    coarse = grains > 0.0
    if not coarse.any() or coarse.all():
        return
    H = quadratic.H[np.ix_(~coarse, ~coarse)]
    damped = H + damping * np.diag(np.diag(H))
    for reach in (1.0, 0.0):
        trial = x.copy()
        trial[coarse] += np.clip((goal - x)[coarse], *(reach * grains[coarse] * [[-1.0], [1.0]]))
        coupled = quadratic.H[np.ix_(~coarse, coarse)] @ (trial - x)[coarse]
        trial[~coarse] -= solve(damped, quadratic.g[~coarse] + coupled)
        if np.isfinite(trial).all():
            yield trial


def _try_step(
    problem: _LeastSquares, quadratic: QuadraticModel, damping: float, goal: Array
) -> TrialStep:
    """Where a step to a goal (k,) leads."""
    trial = quadratic.hypothesis.at(goal)
    step = trial.x - quadratic.hypothesis.x
    e, residuals = problem.errors(trial)
    cost, length = problem.cost(trial, residuals), float(step @ quadratic.H @ step)
    predicted = -float(2.0 * quadratic.g @ step + length)
    # gain ratio (actual over predicted reduction) within the tolerance of 1
    near_one = abs(quadratic.cost - cost - predicted) < GAIN_RATIO_TOLERANCE * predicted
    return TrialStep(trial, cost, damping, length, e, residuals, near_one)
