"""Find axes that something on board holds by a sensor of its own, and what shows there alone.

Where an autopilot knows how the vehicle moves before the cameras do, its thrust answers what the
filters cannot know yet. They take commands for given, so that their errors oppose the thrust on
such an axis. In closed loop a fit is biased where its model of the noise is not the true one
(Forssell and Ljung 1999, Automatica 35, 1215); here it seems that slow motion is resisted: a
heading that was held by a gyro was a dry friction of probability 1.

Durbin, Wu and Hausman's test for inputs that depend on the errors (Hausman 1978, Econometrica 46,
1251) finds these axes, as a score test beside all fitted parameters: what earlier readings do not
predict of the thrust must not be correlated with innovations. What belongs to the vehicle shows on
other axes and in other runs, too. So effects are judged without what was read of held axes.
"""

from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import least_squares
from scipy.stats import chi2

from rovsim.core import rotations
from rovsim.core.robust import STD_PER_MAD
from rovsim.diagnosis.structure.residual import FALSE_ALARM_RATE, split_by_run
from rovsim.dynamics.mocap_view import NO_CHANGE
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.kernels.axis import POSE
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.least_squares import as_rows, gram, solve
from rovsim.estimation.observer.observed_run import ObservedRun

PAST_READINGS = 9  # half a second, from which a loop's rate and angle are predicted
PAST_INNOVATIONS = 3  # what was unexpected until then
LAGS = 2  # intervals: the thrust before a reading, and the one before that
MAX_STDS = 3.0  # robust standard deviations: what is larger is a pilot's new set-point
MIN_STD = 1e-9  # N or N m: thrust that never changes surprises nobody


class HeldOnly(NamedTuple):
    """Ids of effects that show on held axes alone.

    Attributes:
        refuted: of those that would show elsewhere as well, and do not.
        unseen: of those that would show nowhere else.
    """

    refuted: frozenset[str]
    unseen: frozenset[str]


def find_held_only(fit: Fit, bank: FilterBank, penalty: float) -> HeldOnly:
    """Judge the effects of a fit without what was read of held axes.

    Args:
        fit: to all runs, at its likeliest values.
        bank: that it was fitted with.
        penalty: of a free parameter, which its evidence has to be worth.
    """
    refuted, unseen = set[str](), set[str]()
    h, white = fit.hypothesis, WhiteRuns.of(fit, bank)
    held = find_held_axes(white, h.model)
    if held.any():
        elsewhere = _fit_elsewhere(white, held)
        for term, own in zip(h.terms, h.columns, strict=True):
            found, least = (h.x - h.absence)[own], penalty * term.choices
            if own and elsewhere.evidence(own, found) < least:
                shows = elsewhere.information(own, found) >= least
                (refuted if shows else unseen).add(term.id)
    return HeldOnly(frozenset(refuted), frozenset(unseen))


class WhiteRuns(NamedTuple):
    """A fit's innovations (6, m) on each run, and their derivatives (k, 6, m), both white."""

    runs: Sequence[ObservedRun]
    e: Sequence[Array]
    J: Sequence[Array]

    @staticmethod
    def of(fit: Fit, bank: FilterBank) -> "WhiteRuns":
        """Whiten those of a fit under its noise."""
        e, J = (bank.whiten(x, fit.noise) for x in (fit.linearised.e, fit.linearised.J))
        return WhiteRuns(bank.runs, split_by_run(e, bank.runs), split_by_run(J, bank.runs))

    @property
    def products(self) -> tuple[Array, Array]:
        """Products of the derivatives with each other (k, k), and with the innovations (k,)."""
        rows = [as_rows(J) for J in self.J]
        products = [r @ e.ravel() for r, e in zip(rows, self.e, strict=True)]
        return np.sum([gram(r) for r in rows], axis=0), np.sum(products, axis=0)

    def without(self, held: Array) -> "WhiteRuns":
        """The same with nothing on the axes of each run in a mask (R, 6)."""
        left = 1.0 - held[..., None]
        e = [kept * x for kept, x in zip(left, self.e, strict=True)]
        return WhiteRuns(self.runs, e, [kept * x for kept, x in zip(left, self.J, strict=True)])


def find_held_axes(white: WhiteRuns, model: Model) -> Array:
    """Mask (R, 6) of the axes of each run on which thrust opposes what nobody has read yet.

    Args:
        white: what is left beside all fitted parameters.
        model: that tells the thrust of the commands.
    """
    H, b = white.products
    statistics, along = np.zeros((2, len(white.runs), 6))
    for k, (run, e, J) in enumerate(zip(*white, strict=True)):
        for i, Z in enumerate(find_surprise(run, model, e)):
            C = Z @ J[:, i].T
            S, g = gram(Z) - C @ solve(H, C.T), Z @ e[i] - C @ solve(H, b)
            statistics[k, i], along[k, i] = float(g @ solve(S, g)), float(g.sum())
    tested = max(1, int(np.count_nonzero(statistics)))
    limit = float(chi2.isf(FALSE_ALARM_RATE / tested, LAGS))
    return np.asarray((statistics > limit) & (along < 0.0))


def find_surprise(run: ObservedRun, model: Model, e: Array) -> Array:
    """What earlier readings do not predict of the thrust (6, LAGS, m), scaled on each axis.

    Zero where not all poses are in every reading.

    Args:
        run: of which there are m settled innovations.
        model: that tells the thrust of the commands.
        e: these innovations (6, m), white.
    """
    posed = (run.reading_kinds == POSE) & run.innovation_mask.all(axis=0)
    surprise = np.zeros((6, LAGS, e.shape[1]))
    if run.motion.binned or not posed.all():
        return surprise
    read = np.concatenate([np.arange(a + 1, b + 1) for a, b in run.segments])[run.settled]
    thrust, poses = _mean_thrust(run, model), _poses_in_body(run)
    innovations = np.full((len(thrust), 6), np.nan)
    innovations[read] = e.T
    for i in range(6):
        known = np.hstack([poses[:, :, i], np.delete(thrust, i, axis=1)])
        unpredicted = _subtract_predicted(thrust[:, i], known, innovations[:, i])
        surprise[i] = [_delay(unpredicted, lag, 0.0)[read] for lag in range(LAGS)]
    return surprise


def _subtract_predicted(thrust: Array, poses: Array, innovations: Array) -> Array:
    """Thrust (r,) less what poses (r, p) and innovations (r,) before it predict, in robust stds.

    Zero where an innovation before it does not count.
    """
    past = [_delay(innovations, k, np.nan) for k in range(1, PAST_INNOVATIONS + 1)]
    rows = np.column_stack([np.ones(len(thrust)), poses, *past])
    known = np.isfinite(rows).all(axis=1)
    out = np.zeros(len(thrust))
    if known.sum() > 2 * rows.shape[1]:
        out[known] = np.clip(_regress(rows[known], thrust[known]), -MAX_STDS, MAX_STDS)
    return out


def _regress(rows: Array, y: Array) -> Array:
    """What rows (m, p) leave of y (m,), in robust standard deviations, by Huber's loss."""
    first = np.linalg.lstsq(rows, y, rcond=None)[0]
    scale = _robust_std(y - rows @ first)

    def errors(weights: Array) -> Array:
        return np.asarray((rows @ weights - y) / scale)

    def slopes(weights: Array) -> Array:
        return rows / scale

    weights = least_squares(errors, first, slopes, loss="huber", x_scale="jac").x
    rest = y - rows @ weights
    return rest / _robust_std(rest)


def _robust_std(x: Array) -> float:
    return max(MIN_STD, float(STD_PER_MAD * np.median(np.abs(x))))


def _mean_thrust(run: ObservedRun, model: Model) -> Array:
    """Mean wrench (r, 6) of the thrusters over the time before each reading, N and N m."""
    steps = np.diff(run.edges)[:, None]
    impulse = np.vstack([np.zeros(6), np.cumsum(run.drives.of([model])[0].wrench * steps, axis=0)])
    before = np.diff(impulse[run.reading_steps], axis=0)
    return np.vstack([np.zeros(6), before / np.diff(run.reading_times)[:, None]])


def _poses_in_body(run: ObservedRun) -> Array:
    """Poses (r, PAST_READINGS, 6) read before each reading: m in body axes of the last one, rad.

    The last one, from a fixed place and as angles, then how far the others are from it. NaN where
    there is none.
    """
    states = run.read(NO_CHANGE)
    place, q = states[:, :3] - states[:, :3].mean(axis=0), states[:, 3:7]
    angles = np.unwrap(rotations.to_euler(q), axis=0)
    last = [_delay(x, 1, np.nan) for x in (place, q, angles)]
    poses = [np.hstack([rotations.unrotate(last[1], last[0]), last[2]])]
    for k in range(2, PAST_READINGS + 1):
        moved = rotations.unrotate(last[1], _delay(place, k, np.nan) - last[0])
        poses.append(np.hstack([moved, _delay(angles, k, np.nan) - last[2]]))
    return np.stack(poses, axis=1)


def _delay(x: Array, k: int, before: float) -> Array:
    """The values (r, ...) k readings earlier."""
    return np.concatenate([np.full((k, *x.shape[1:]), before), x[: len(x) - k]])


class _Elsewhere(NamedTuple):
    """A fit to first order without held axes: its step (k,) from the fit, and its covariance."""

    step: Array
    covariance: Array

    def evidence(self, own: Sequence[int], found: Array) -> float:
        """Wald's statistic of some parameters, which the fit found so far from their absence."""
        return self.information(own, found + self.step[own])

    def information(self, own: Sequence[int], offset: Array) -> float:
        """Wald's statistic that these parameters would have so far from their absence."""
        return float(offset @ solve(self.covariance[own][:, own], offset))


def _fit_elsewhere(white: WhiteRuns, held: Array) -> _Elsewhere:
    H, b = white.without(held).products
    return _Elsewhere(-solve(H, b), solve(H, np.eye(len(H))))
