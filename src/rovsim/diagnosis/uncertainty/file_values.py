"""Fit all values of a loose vehicle file together with the accepted effects.

The accepted effects were fitted as if the rest of the file were right. In a loose file it is not,
and values that were not fitted pull the fitted ones away: thrust, inertia and drag share a factor
that hardly anything else determines. So in the end all values of the file are fitted, with what is
known of such files as a prior (`estimation/file_effects.py`). Then values are set back to the
file's if they are not surely different, or if replays do not become worse. The other values follow,
at the gain that was found, and their intervals stay those of the fit of all values. The gain itself
is kept if it surely differs from the file's, although replays without it are as good: all other
values would then be wrong by one factor.

A file may also be wrong in a few values alone. If the runs find all other drag and added mass to be
what the file says, far closer than such files usually are, the rest of the file is right, and the
accepted effects stay as they are. This is decided for all of these values at once by Savage and
Dickey's density ratio (Dickey 1971, Ann. Math. Stat. 42, 204): how much likelier the file's values
are after the runs than before. Values that a file states as zero, such as the place of the ballast,
are not used: they are right in most files. The more values were accepted, the less likely it is
that just the rest is right: any number of values may be wrong, each number is as likely before the
runs, and so are all sets of the same number (Scott & Berger 2010, Ann. Stat. 38, 2587).
"""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.special import comb
from scipy.stats import chi2

from rovsim.diagnosis.selection.pruning import drop_parameters
from rovsim.diagnosis.selection.search_result import MIN_LR_APART
from rovsim.diagnosis.selection.vehicle_file.whole_file import know_file, mark_new
from rovsim.diagnosis.structure.residual import FALSE_ALARM
from rovsim.diagnosis.uncertainty.common_scale import CommonScale, describe_scale
from rovsim.dynamics.effects.thrusters import ThrusterGain, name_gains
from rovsim.estimation.file_effects import mark_gain, share_of_file
from rovsim.estimation.fit import Fit, judge
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.windows import score_windows

TOLD = 0.7  # of the standard deviation before the runs: if more is left, they told nothing
MISSED = 0.01  # share of the error in 2 s windows: if it grows by less, a value is not needed


def is_right_elsewhere(whole: Fit, selected: Hypothesis) -> bool:
    """Whether the runs show that the rest of a file is right, beside the accepted effects.

    Args:
        whole: fit of all values of the file.
        selected: the accepted effects, at their fitted values.
    """
    h, new = whole.hypothesis, mark_new(selected, whole.hypothesis)
    each = [(type(t.effect), p) for t in h.terms for p in t.parameters]
    share = np.array([share_of_file(h.base, *one) for one in each])
    asked, of = new & (share > 0.0), int(np.sum(share > 0.0))
    if not asked.any() or whole.distance(asked) > chi2.isf(FALSE_ALARM, asked.sum()):
        return False
    known, usual, one = know_file(selected, h).std[asked], share[asked], np.eye(asked.sum())
    in_all = solve(whole.covariance[np.ix_(asked, asked)], one)
    pull = in_all @ (h.x - h.absence)[asked]
    told = in_all - np.diag(known**-2.0)  # by the runs: the fit knew the file as well
    likelier = np.linalg.slogdet(one + usual[:, None] * told * usual)[1]
    likelier -= pull @ solve(told + np.diag(usual**-2.0), pull)
    return bool(likelier - 2.0 * np.log((of + 1) * comb(of, asked.sum())) > MIN_LR_APART)


def settle_whole_file(
    whole: Fit, selected: Hypothesis, bank: FilterBank
) -> tuple[Fit, CommonScale | None]:
    """Keep the accepted effects, and file effects without which replays are worse.

    Args:
        whole: fit of all values of the file.
        selected: the accepted effects, at their fitted values.
        bank: the filters of `whole`.

    Returns:
        The final fit, and the common scale; None where that is known.
    """
    h, new = whole.hypothesis, mark_new(selected, whole.hypothesis)
    untold = new & (whole.std > TOLD * know_file(selected, h).std)
    owner = np.array([term.id for term in h.terms for _ in term.free])
    named = {term.id for term in selected.terms} | _name_gain(whole)
    sure = {one for one in set(owner) - named if _is_sure(whole, (owner == one) & ~untold)}
    gone = untold | ~np.isin(owner, list(named))
    while left := sorted(sure - named):
        tried = [_leave_out(whole, gone & ((owner != one) | untold)) for one in left]
        all_of_it, without, *more = _measure([h, _leave_out(whole, gone), *tried], bank)
        if without <= (1.0 + MISSED) * all_of_it:
            break
        named.add(left[int(np.argmin(more))])
        gone = untold | ~np.isin(owner, list(named))
    final = judge(bank.linearise(_leave_out(whole, gone)), bank, whole.noise)
    final = replace(final, covariance=whole.covariance[np.ix_(~gone, ~gone)])
    gain = _share_gains(h)
    variance = float(gain @ whole.covariance @ gain)
    return final, describe_scale(final, variance, whole.covariance[~gone] @ gain / variance)


def _name_gain(whole: Fit) -> set[str]:
    """Id of the thrusters' gain, if its common value surely is not the file's; else nothing.

    Replays cannot decide this: all other values, wrong by its inverse, would compensate.
    """
    gain = mark_gain(whole.hypothesis)
    sure = gain.any() and whole.distance(gain) > chi2.isf(FALSE_ALARM, 1)
    return {ThrusterGain.id} if sure else set()


def _share_gains(h: Hypothesis) -> Array:
    """Weight of each of k parameters in the mean gain of the thrusters (k,)."""
    count = h.base.vehicle.thruster_count
    own = [f"{ThrusterGain.id}.{name}" for name in name_gains(count)]
    single = np.isin(h.parameter_names, own) / max(1, count)
    return np.where(mark_gain(h), 1.0, single)


def _leave_out(whole: Fit, gone: Array) -> Hypothesis:
    """Set the parameters of a mask (k,) back to the file's values; the others follow.

    To first order: the others take their conditional mean. The common gain stays as it is.
    """
    h, V = whole.hypothesis, whole.covariance
    step = np.where(gone, h.absence - h.x, 0.0)
    given = gone | mark_gain(h)
    follow = V[np.ix_(~given, given)] @ solve(V[np.ix_(given, given)], step[given])
    step[~given] = follow
    return drop_parameters(h.at(h.x + step), gone)


def _is_sure(whole: Fit, own: Array) -> bool:
    """Whether the parameters of a mask (k,) surely differ from the file, at the gain found."""
    h, V = whole.hypothesis, whole.covariance
    own = own & ~mark_gain(h)
    across = V[np.ix_(own, mark_gain(h))]
    beside = V[np.ix_(own, own)] - across @ across.T / V[np.ix_(mark_gain(h), mark_gain(h))]
    off = (h.x - h.absence)[own]
    return bool(off @ solve(beside, off) > chi2.isf(FALSE_ALARM, max(1, own.sum())))


def _measure(hypotheses: Sequence[Hypothesis], bank: FilterBank) -> list[float]:
    """Normalised errors of hypotheses in windows of 2 s; infinite where a model diverges."""
    errors = score_windows([one.model for one in hypotheses], bank.runs).normalised
    return [np.inf if error is None else error for error in errors]
