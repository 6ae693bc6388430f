"""Find axes on which an autopilot acts by a sensor better than the cameras, and what shows there.

Where an autopilot knows how the vehicle moves before the cameras do, its thrust answers what the
filters cannot know yet. They take commands for given, so that their errors oppose the thrust on
such an axis. In closed loop a fit is biased where its model of the noise is not the true one
(Forssell and Ljung 1999, Automatica 35, 1215); here it seems that slow motion is resisted: a
heading that was held by a gyro was a dry friction of probability 1.

Durbin, Wu and Hausman's test for inputs that depend on the errors (Hausman 1978, Econometrica 46,
1251) finds these axes, as a score test beside all fitted parameters: what earlier readings do not
predict of the thrust must not be correlated with innovations. What belongs to the vehicle shows on
other axes and in other runs, too. So effects are judged without what was read of these axes.
"""

from dataclasses import replace
from typing import Callable, NamedTuple

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import least_squares
from scipy.stats import chi2

from rovsim.core import rotations
from rovsim.core.robust import robust_std
from rovsim.diagnosis.checks.by_run import group_runs
from rovsim.diagnosis.structure.residual import FALSE_ALARM_RATE, split_by_run
from rovsim.dynamics.mocap_view import NO_CHANGE
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit, refit_to_rows
from rovsim.estimation.kernels.axis import POSE
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.least_squares import as_rows, gram, solve
from rovsim.estimation.observer.observed_run import ObservedRun

PAST_READINGS = 9  # of 50 ms: half a second, from which the rate and the angle are known
PAST_INNOVATIONS = 3  # what was unexpected until then
LAGS = 2  # intervals: the thrust before a reading, and the one before that
MAX_STDS = 3.0  # robust standard deviations: what is larger is a pilot's new set-point
MIN_SHARE = 1e-6  # of the thrust: what is left of a smaller one is rounding

Weigh = Callable[[Fit, int], float]


class FeedbackOnly(NamedTuple):
    """Ids of effects that only show on axes on which an autopilot acts by a sensor of its own.

    Attributes:
        refuted: those that would show elsewhere as well, and do not; the least likely first.
        unseen: those that would show nowhere else.
    """

    refuted: tuple[str, ...] = ()
    unseen: frozenset[str] = frozenset()


def find_feedback_only(fit: Fit, bank: FilterBank, axes: Array, weigh: Weigh) -> FeedbackOnly:
    """Judge the effects of a fit without what was read of some axes, to first order.

    Args:
        fit: to all runs, at its likeliest values.
        bank: that it was fitted with.
        axes: mask (R, 6) of the axes of each run.
        weigh: how many times a term of a fit, by its number, is worth its penalty.
    """
    if not axes.any():
        return FeedbackOnly()
    refuted, unseen = {}, set[str]()
    elsewhere = _fit_elsewhere(fit, bank, axes)
    at_found = replace(elsewhere, linearised=fit.linearised)
    for i, (term, own) in enumerate(zip(fit.hypothesis.terms, fit.hypothesis.columns, strict=True)):
        if not term.vanishes or not own or weigh(fit, i) < 1.0:
            continue
        worth = weigh(elsewhere, i) if _agree(fit, elsewhere, own) else 0.0
        if worth < 1.0 and weigh(at_found, i) >= 1.0:
            refuted[term.id] = worth
        elif worth < 1.0:
            unseen.add(term.id)
    return FeedbackOnly(tuple(sorted(refuted, key=lambda name: refuted[name])), frozenset(unseen))


def _fit_elsewhere(fit: Fit, bank: FilterBank, axes: Array) -> Fit:
    """The fit to all but some axes, to first order."""
    rows = bank.whiten(fit.linearised.rows, fit.noise)
    for part, left_out in zip(split_by_run(rows, bank.runs), axes, strict=True):
        part[:, left_out] = 0.0  # a view of `rows`
    return refit_to_rows(fit, rows)


def _agree(fit: Fit, elsewhere: Fit, own: list[int]) -> bool:
    """Whether some parameters leave their absence in the same direction in both fits."""
    absence = fit.hypothesis.absence[own]
    here, there = fit.hypothesis.x[own] - absence, elsewhere.hypothesis.x[own] - absence
    return bool(there @ solve(elsewhere.covariance[own][:, own], here) > 0.0)


def find_feedback_axes(fit: Fit, bank: FilterBank) -> Array:
    """Mask (R, 6) of the axes of each run on which thrust opposes what nobody has read yet.

    All parts of a run count together. Not tested are axes that were not measured as poses, at every
    reading.

    Args:
        fit: beside whose parameters it is tested; all that may be wrong should be free.
        bank: that it was fitted with.
    """
    found = np.zeros((len(bank.runs), 6), bool)
    if not fit.is_finite:
        return found
    rows = bank.whiten(fit.linearised.rows, fit.noise)
    parts, model = split_by_run(rows, bank.runs), fit.hypothesis.model
    G = gram(as_rows(rows))
    unpredicted = [
        find_unpredicted(run, model, part[0]) for run, part in zip(bank.runs, parts, strict=True)
    ]
    runs, statistics = list(group_runs(bank.runs).values()), []
    for i in range(6):
        for own in runs:
            Z = np.concatenate([unpredicted[k][i] for k in own], axis=1)
            on_axis = np.concatenate([parts[k][:, i] for k in own], axis=1)
            statistics.append(_score(Z, on_axis, G))
    tested = max(1, sum(statistic != 0.0 for statistic in statistics))
    limit = float(chi2.isf(FALSE_ALARM_RATE / tested, LAGS))
    by_run = np.reshape(statistics, (6, len(runs))).T
    for own, of_run in zip(runs, by_run, strict=True):
        found[own] = of_run < -limit
    return found


def _score(Z: Array, rows: Array, G: Array) -> float:
    """Rao's statistic of further columns beside all parameters; negative where they oppose errors.

    Args:
        Z: the columns (LAGS, m), zero but on one axis of one run.
        rows: errors and derivatives (1 + k, m) there.
        G: Gram matrix (1 + k, 1 + k) of all of these.
    """
    products = Z @ rows.T
    beside = solve(G[1:, 1:], np.column_stack([G[1:, 0], products[:, 1:].T]))
    S = gram(Z) - products[:, 1:] @ beside[:, 1:]
    g = products[:, 0] - products[:, 1:] @ beside[:, 0]
    return float(np.sign(g.sum()) * (g @ solve(S, g)))


def find_unpredicted(run: ObservedRun, model: Model, e: Array) -> Array:
    """What earlier readings do not predict of the thrust (6, LAGS, m), in robust stds of each axis.

    Nor does the thrust on the other axes at the same time. Zero on axes that are not tested.

    Args:
        run: of which there are m settled innovations.
        model: that tells the thrust of the commands.
        e: these innovations (6, m), white.
    """
    out = np.zeros((6, LAGS, e.shape[1]))
    free = run.free_axes.astype(bool)
    posed = (run.reading_kinds == POSE) & run.innovation_mask.all(axis=0)
    if run.motion.binned or not (posed | ~free).all():
        return out
    read = run.innovation_readings[run.settled]
    thrust, poses = _mean_thrust(run, model), _poses_in_body(run)
    innovations = np.full((len(thrust), 6), np.nan)
    innovations[read] = e.T
    for i in np.flatnonzero(free):
        known = np.hstack([poses[:, :, i], np.delete(thrust, i, axis=1)])
        unpredicted = _subtract_predicted(thrust[:, i], known, innovations[:, i])
        out[i] = [_delay(unpredicted, lag, 0.0)[read] for lag in range(LAGS)]
    return out


def _subtract_predicted(thrust: Array, known: Array, innovations: Array) -> Array:
    """Thrust (r,) less what is known (r, p) and innovations (r,) predict, in robust stds.

    Zero where an innovation before it does not count.
    """
    past = [_delay(innovations, k, np.nan) for k in range(1, PAST_INNOVATIONS + 1)]
    rows = np.column_stack([np.ones(len(thrust)), known, *past])
    usable = np.isfinite(rows).all(axis=1)
    out = np.zeros(len(thrust))
    if usable.sum() > 2 * rows.shape[1]:
        out[usable] = np.clip(_regress(rows[usable], thrust[usable]), -MAX_STDS, MAX_STDS)
    return out


def _regress(rows: Array, y: Array) -> Array:
    """What rows (m, p) leave of y (m,), in robust standard deviations, by Huber's loss.

    Zero where they leave nothing but rounding.
    """
    first = np.linalg.lstsq(rows, y, rcond=None)[0]
    scale = robust_std(y - rows @ first)
    if scale <= MIN_SHARE * np.std(y):
        return np.zeros(len(y))

    def errors(weights: Array) -> Array:
        return np.asarray((rows @ weights - y) / scale)

    def slopes(weights: Array) -> Array:
        return rows / scale

    weights = least_squares(errors, first, slopes, loss="huber", x_scale="jac").x
    rest = y - rows @ weights
    return rest / max(robust_std(rest), MIN_SHARE * scale)


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
    k = min(k, len(x))
    return np.concatenate([np.full((k, *x.shape[1:]), before), x[: len(x) - k]])
