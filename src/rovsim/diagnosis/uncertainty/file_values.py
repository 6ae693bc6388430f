"""Fit all values of a loose vehicle file together with the accepted effects.

The accepted effects were fitted as if the rest of the file were right. In a loose file it is not,
and values that were not fitted pull the fitted ones away: thrust, inertia and drag share a factor
that hardly anything else determines. So in the end all values of the file are fitted, with what is
known of such files as a prior (`estimation/file_effects.py`). Then values are set back to the
file's if they are not surely different, or if replays do not become worse. The other values follow,
at the gain that is kept, and their intervals stay those of the fit of all values. The gain itself
is kept if it surely differs from the file's, although replays without it are as good: all other
values would then be wrong by one factor. An accepted file effect that no longer differs surely is
set back as well, if replays do not become worse: it stood in for values that were not fitted. Where
all drag and added mass are 5 % off, that is a gain of the thrusters. And values that surely differ
are kept where others would have to take their place.

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
from typing import Collection, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.special import comb
from scipy.stats import chi2

from rovsim.diagnosis.selection.pruning import drop_parameters
from rovsim.diagnosis.selection.search_result import MIN_LR_APART
from rovsim.diagnosis.selection.vehicle_file.whole_file import make_file_prior, mark_new
from rovsim.diagnosis.structure.residual import FALSE_ALARM_RATE
from rovsim.diagnosis.uncertainty.common_scale import CommonScale, describe_scale
from rovsim.dynamics.effects.thrusters import ThrusterGain, name_gains
from rovsim.estimation.file_effects import FILE_EFFECT_IDS, mark_gain, share_of_file
from rovsim.estimation.fit import Fit, fit_noise_only
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.windows import score_windows

MAX_STD_RATIO = 0.7  # of the standard deviation before the runs: if more is left, they told nothing
# Share of the error in 2 s windows: if it grows by less, a value is not needed.
MAX_ERROR_GROWTH = 0.01
# Standard deviations by which other values may move where one is set back that surely is not the
# file's: else their intervals would not hold. A centre of buoyancy that was off by 0.3 mm moved a
# payload by six.
MAX_SHIFT = 1.0


def is_right_elsewhere(whole: Fit, selected: Hypothesis) -> bool:
    """Whether the runs show that the rest of a file is right, beside the accepted effects.

    Args:
        whole: fit of all values of the file.
        selected: the accepted effects, at their fitted values.
    """
    h, new = whole.hypothesis, mark_new(selected, whole.hypothesis)
    pairs = [(type(t.effect), p) for t in h.terms for p in t.parameters]
    share = np.array([share_of_file(h.base, *one) for one in pairs])
    tested, count = new & (share > 0.0), int(np.sum(share > 0.0))
    if not tested.any() or whole.wald_statistic(tested) > chi2.isf(FALSE_ALARM_RATE, tested.sum()):
        return False
    prior_std, spread, one = (
        make_file_prior(selected, h).std[tested],
        share[tested],
        np.eye(tested.sum()),
    )
    information = solve(whole.covariance[np.ix_(tested, tested)], one)
    pull = information @ (h.x - h.absence)[tested]
    by_runs = information - np.diag(prior_std**-2.0)  # by the runs: the fit knew the file as well
    lr = np.linalg.slogdet(one + spread[:, None] * by_runs * spread)[1]
    lr -= pull @ solve(by_runs + np.diag(spread**-2.0), pull)
    return bool(lr - 2.0 * np.log((count + 1) * comb(count, tested.sum())) > MIN_LR_APART)


def settle_whole_file(
    whole: Fit, selected: Hypothesis, bank: FilterBank
) -> tuple[Fit, CommonScale | None]:
    """Keep the accepted effects, and file effects without which replays or values are worse.

    Args:
        whole: fit of all values of the file.
        selected: the accepted effects, at their fitted values.
        bank: the filters of `whole`.

    Returns:
        The final fit, and the common scale; None where that is known.
    """
    h, new = whole.hypothesis, mark_new(selected, whole.hypothesis)
    undetermined = new & (whole.std > MAX_STD_RATIO * make_file_prior(selected, h).std)
    owner = np.array([term.id for term in h.terms for _ in term.free])
    accepted = {term.id for term in selected.terms}
    sure_gain = _name_gain(whole)
    offset = _measure_offset(whole, keeps_gain=bool(sure_gain))
    significant = {n for n in set(owner) if _is_sure(whole, offset, (owner == n) & ~undetermined)}
    ids = (accepted & significant) | (accepted - FILE_EFFECT_IDS) | sure_gain

    def drop_all_but(kept: Collection[str]) -> Array:
        return undetermined | ~np.isin(owner, list(kept))

    while candidates := sorted((significant | accepted) - ids):
        trials = [_leave_out(whole, drop_all_but({*ids, name})) for name in candidates]
        reduced = _leave_out(whole, drop_all_but(ids))
        error_all, error_reduced, *errors_extended = _measure_errors([h, reduced, *trials], bank)
        if error_reduced <= (1.0 + MAX_ERROR_GROWTH) * error_all:
            break
        ids.add(candidates[int(np.argmin(errors_extended))])
    while candidates := sorted(significant - ids):
        if _measure_shift(whole, drop_all_but(ids)) <= MAX_SHIFT:
            break
        shifts = [_measure_shift(whole, drop_all_but({*ids, name})) for name in candidates]
        ids.add(candidates[int(np.argmin(shifts))])
    dropped = drop_all_but(ids)
    final = fit_noise_only(bank.linearise(_leave_out(whole, dropped)), bank, whole.noise)
    final = replace(final, covariance=whole.covariance[np.ix_(~dropped, ~dropped)])
    gain = _share_gains(h)
    variance = float(gain @ whole.covariance @ gain)
    return final, describe_scale(final, variance, whole.covariance[~dropped] @ gain / variance)


def _name_gain(whole: Fit) -> set[str]:
    """Id of the thrusters' gain, if its common value surely is not the file's; else nothing.

    Replays cannot decide this: all other values, wrong by its inverse, would compensate.
    """
    gain = mark_gain(whole.hypothesis)
    significant = gain.any() and whole.wald_statistic(gain) > chi2.isf(FALSE_ALARM_RATE, 1)
    return {ThrusterGain.id} if significant else set()


def _share_gains(h: Hypothesis) -> Array:
    """Weight of each of k parameters in the mean gain of the thrusters (k,)."""
    count = h.base.vehicle.thruster_count
    names = [f"{ThrusterGain.id}.{name}" for name in name_gains(count)]
    gain_shares = np.isin(h.parameter_names, names) / max(1, count)
    return np.where(mark_gain(h), 1.0, gain_shares)


def _leave_out(whole: Fit, gone: Array) -> Hypothesis:
    """Set the parameters of a mask (k,) back to the file's values; the others follow.

    To first order: the others take their conditional mean. The common gain stays as it is.
    """
    h = whole.hypothesis
    step = _condition_steps(whole, gone | mark_gain(h), np.where(gone, h.absence - h.x, 0.0))
    return drop_parameters(h.at(h.x + step), gone)


def _measure_shift(whole: Fit, gone: Array) -> float:
    """By how many standard deviations the others move at most, where a mask (k,) is set back."""
    kept = ~gone
    step = _leave_out(whole, gone).x - whole.hypothesis.x[kept]
    return float(np.max(np.abs(step) / whole.std[kept], initial=0.0))


def _condition_steps(whole: Fit, led: Array, step: Array) -> Array:
    """Steps (k,) of all parameters where those of a mask (k,) take theirs: conditional means."""
    V = whole.covariance
    step = step.copy()
    step[~led] = V[np.ix_(~led, led)] @ solve(V[np.ix_(led, led)], step[led])
    return step


def _measure_offset(whole: Fit, keeps_gain: bool) -> Array:
    """How far the values (k,) are from the file's, at the gain that was found or at the file's."""
    h, gain = whole.hypothesis, mark_gain(whole.hypothesis)
    offset = h.x - h.absence
    return (
        offset
        if keeps_gain
        else offset + _condition_steps(whole, gain, np.where(gain, -offset, 0.0))
    )


def _is_sure(whole: Fit, offset: Array, own: Array) -> bool:
    """Whether the parameters of a mask (k,) surely differ from the file, at a given gain.

    Args:
        whole: fit of all values of the file.
        offset: how far they are from the file's (k,) at that gain.
        own: the mask.
    """
    V, gain = whole.covariance, mark_gain(whole.hypothesis)
    own = own & ~gain
    cross = V[np.ix_(own, gain)]
    conditional = V[np.ix_(own, own)] - cross @ cross.T / V[np.ix_(gain, gain)]
    distance = offset[own] @ solve(conditional, offset[own])
    return bool(distance > chi2.isf(FALSE_ALARM_RATE, max(1, own.sum())))


def _measure_errors(hypotheses: Sequence[Hypothesis], bank: FilterBank) -> list[float]:
    """Normalised errors of hypotheses in windows of 2 s; infinite where a model diverges."""
    errors = score_windows([h.model for h in hypotheses], bank.runs).normalised
    return [np.inf if error is None else error for error in errors]
